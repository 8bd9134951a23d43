//! GDAL's virtual rasters, `.vrt`: a raster composed of parts of other rasters. Only simple sources without resampling
//! are supported.

use roxmltree::Node;

use super::affine::Affine;
use super::aux_xml::numbers;
use super::band::BandMetadata;
use super::xml;

/// Maximum length of a file, in bytes.
pub const MAX_LENGTH: u64 = 64 << 20;

/// A virtual raster.
#[derive(Debug, Clone, PartialEq)]
pub struct Virtual {
    /// Columns and rows.
    pub size: [u64; 2],
    /// The transform from columns and rows to coordinates.
    pub affine: Option<Affine>,
    /// The coordinate system as well-known text.
    pub system: Option<String>,
    /// The bands.
    pub bands: Vec<Band>,
    /// Whether it has a mask, so that samples without a source are missing.
    pub has_mask: bool,
}

/// A band of a virtual raster.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Band {
    /// The sources; later ones cover earlier ones.
    pub sources: Vec<Source>,
    /// The nodata value, scale, offset and unit.
    pub metadata: BandMetadata,
}

/// A part of a file, placed without resampling.
#[derive(Debug, Clone, PartialEq)]
pub struct Source {
    /// The file.
    pub path: String,
    /// Whether the path is relative to the folder of the `.vrt`.
    pub relative: bool,
    /// The band, from 1.
    pub band: u32,
    /// The first column and row of the part.
    pub from: [u64; 2],
    /// The column and row of the part in the virtual raster.
    pub to: [u64; 2],
    /// The number of columns and rows; `None` means all.
    pub size: Option<[u64; 2]>,
    /// The value of missing samples.
    pub nodata: Option<f64>,
}

/// Parses a virtual raster.
///
/// # Errors
/// A message if it is not a virtual raster, or changes the samples of its sources.
pub fn parse(text: &str) -> Result<Virtual, String> {
    let document = xml::parse(text, false)?;
    let root = document.root_element();
    if !root.has_tag_name("VRTDataset") {
        return Err("it is not a virtual raster: its root is not VRTDataset".into());
    }
    if let Some(kind) = root.attribute("subClass") {
        return Err(format!("it is a {kind}, which is not supported; convert it to GeoTIFF with gdal_translate"));
    }
    let side =
        |name: &str| root.attribute(name).and_then(|text| text.trim().parse().ok()).ok_or(format!("it has no {name}"));
    let child = |name: &str| root.children().find(|node| node.has_tag_name(name)).and_then(|node| node.text());
    let bands = root.children().filter(|node| node.has_tag_name("VRTRasterBand")).map(band);
    Ok(Virtual {
        size: [side("rasterXSize")?, side("rasterYSize")?],
        affine: child("GeoTransform").and_then(numbers).map(Affine::of_geotransform),
        system: child("SRS").map(str::trim).filter(|text| !text.is_empty()).map(String::from),
        bands: bands.collect::<Result<_, _>>()?,
        has_mask: root.children().any(|node| node.has_tag_name("MaskBand")),
    })
}

fn band(band: Node) -> Result<Band, String> {
    if let Some(kind) = band.attribute("subClass") {
        return Err(format!("it has a {kind}, which is not supported; convert it to GeoTIFF with gdal_translate"));
    }
    let all = band.children().filter(|node| node.is_element() && node.tag_name().name().ends_with("Source"));
    let sources = all.map(source).collect::<Result<_, _>>()?;
    let whole = match band.attribute("dataType") {
        Some("Byte") => Some([0.0, 255.0]),
        Some("Int8") => Some([-128.0, 127.0]),
        Some("UInt16") => Some([0.0, 65_535.0]),
        Some("Int16") => Some([-32_768.0, 32_767.0]),
        Some("UInt32") => Some([0.0, 4_294_967_295.0]),
        Some("Int32") => Some([-2_147_483_648.0, 2_147_483_647.0]),
        _ => None,
    };
    Ok(Band { sources, metadata: BandMetadata { whole, ..BandMetadata::of_xml(band) } })
}

fn source(node: Node) -> Result<Source, String> {
    let name = node.tag_name().name();
    if !matches!(name, "SimpleSource" | "ComplexSource") {
        return Err(format!(
            "a source is of the kind {name}, which is not supported; convert it to GeoTIFF with gdal_translate"
        ));
    }
    let child = |name: &str| node.children().find(|node| node.has_tag_name(name));
    if let Some(other) = ["ScaleOffset", "ScaleRatio", "LUT", "Exponent", "ColorTableComponent", "UseMaskBand"]
        .into_iter()
        .find(|name| child(name).is_some())
    {
        return Err(format!(
            "a source has a {other}, which is not supported; convert it to GeoTIFF with gdal_translate"
        ));
    }
    let file = child("SourceFilename").ok_or("a source has no file name")?;
    let path =
        file.text().map(str::trim).filter(|path| !path.is_empty()).ok_or("a source has no file name")?.to_string();
    let relative = matches!(file.attribute("relativeToVRT"), Some("1" | "true" | "TRUE"));
    let band = match child("SourceBand").and_then(|node| node.text()) {
        Some(text) => text.trim().parse().map_err(|_| {
            let band = text.escape_debug();
            format!(
                "a source uses the band `{band}`, which is not supported; convert it to GeoTIFF with gdal_translate"
            )
        })?,
        None => 1,
    };
    let (from, to) = (rectangle(child("SrcRect"))?, rectangle(child("DstRect"))?);
    let (from, to, size) = match (from, to) {
        (Some((from, size)), Some((to, laid))) if size == laid => (from, to, Some(size)),
        (None, None) => ([0; 2], [0; 2], None),
        (Some((from, size)), None) => (from, [0; 2], Some(size)),
        (None, Some((to, size))) => ([0; 2], to, Some(size)),
        _ => {
            return Err(format!(
                "it resamples `{path}`, which is not supported; convert it to GeoTIFF with gdalwarp or gdal_translate"
            ));
        }
    };
    let nodata = child("NODATA").and_then(|node| node.text()).and_then(|text| text.trim().parse().ok());
    Ok(Source { path, relative, band, from, to, size, nodata })
}

/// The first column and row of a rectangle, and its size.
type Rectangle = ([u64; 2], [u64; 2]);

/// A rectangle of whole columns and rows.
fn rectangle(node: Option<Node>) -> Result<Option<Rectangle>, String> {
    let Some(node) = node else { return Ok(None) };
    let number = |name: &str| {
        let number: f64 = node.attribute(name)?.trim().parse().ok()?;
        let whole = number.round();
        ((number - whole).abs() < 1e-2 && (0.0..1e15).contains(&whole)).then_some(whole as u64)
    };
    match (number("xOff"), number("yOff"), number("xSize"), number("ySize")) {
        (Some(x), Some(y), Some(width), Some(height)) if width > 0 && height > 0 => Ok(Some(([x, y], [width, height]))),
        _ => Err("a source is not aligned with its samples; convert it to GeoTIFF with gdalwarp".into()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn with(source: &str) -> Result<Virtual, String> {
        parse(&format!(
            "<VRTDataset rasterXSize=\"20\" rasterYSize=\"10\"><SRS>EPSG:32632</SRS><GeoTransform>0, 30, 0, 300, 0, -30</GeoTransform>\
             <VRTRasterBand dataType=\"Float32\" band=\"1\"><NoDataValue>-1</NoDataValue>{source}</VRTRasterBand></VRTDataset>"
        ))
    }

    #[test]
    fn sources_are_found() {
        let source = "<ComplexSource><SourceFilename relativeToVRT=\"1\">a.tif</SourceFilename><SourceBand>2</SourceBand>\
                      <SrcRect xOff=\"1\" yOff=\"0\" xSize=\"5\" ySize=\"4\"/><DstRect xOff=\"7\" yOff=\"3.000001\" xSize=\"5\" ySize=\"4\"/>\
                      <NODATA>-1</NODATA></ComplexSource>";
        let read = with(source).unwrap();
        assert_eq!((read.size, read.affine.unwrap().0), ([20, 10], [30.0, 0.0, 15.0, 0.0, -30.0, 285.0]));
        let expect = Source {
            path: "a.tif".into(),
            relative: true,
            band: 2,
            from: [1, 0],
            to: [7, 3],
            size: Some([5, 4]),
            nodata: Some(-1.0),
        };
        assert_eq!(read.bands[0].sources, [expect]);
        assert_eq!((read.bands[0].metadata.nodata.as_slice(), read.has_mask), (&[-1.0][..], false));
    }

    #[test]
    fn what_changes_samples_is_a_sentence() {
        let rect = |source: &str, to: &str| {
            with(&format!(
                "<SimpleSource><SourceFilename>a</SourceFilename><SrcRect {source}/><DstRect {to}/></SimpleSource>"
            ))
        };
        let (five, ten) =
            ("xOff=\"0\" yOff=\"0\" xSize=\"5\" ySize=\"5\"", "xOff=\"0\" yOff=\"0\" xSize=\"10\" ySize=\"10\"");
        assert!(rect(five, ten).unwrap_err().contains("it resamples"));
        assert!(
            rect(five, "xOff=\"0.5\" yOff=\"0\" xSize=\"5\" ySize=\"5\"")
                .unwrap_err()
                .contains("not aligned with its samples")
        );
        assert!(with("<KernelFilteredSource/>").unwrap_err().contains("KernelFilteredSource"));
        assert!(with("<SimpleSource/>").unwrap_err().contains("has no file name"));
        assert!(parse("<a/>").unwrap_err().contains("not a virtual raster"));
        assert!(parse("II*").unwrap_err().contains("not valid XML"));
    }
}
