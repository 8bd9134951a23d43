//! GDAL's sidecar files `NAME.EXT.aux.xml` (PAM): coordinate system, geotransform, and nodata, scale, offset
//! and unit of the bands. GDAL reads the coordinate system of a picture from them.

use std::io::{self, Write};

use super::affine::Affine;
use super::band::BandMetadata;
use super::xml;

/// Maximum length of a file, in bytes.
pub const MAX_LENGTH: u64 = 1 << 20;

/// The supported content of a sidecar.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Notes {
    /// The transform from columns and rows to coordinates.
    pub affine: Option<Affine>,
    /// The coordinate system as well-known text, or as a code such as EPSG:32632.
    pub system: Option<String>,
    /// Nodata, scale, offset and unit of each band, in the order of the bands.
    pub bands: Vec<BandMetadata>,
}

/// Maximum number of bands.
const MAX_BANDS: usize = 4096;

/// Writes a transform and its coordinate system as well-known text.
///
/// Fails if `out` fails.
pub fn write(out: &mut dyn Write, affine: &Affine, wkt: &str) -> io::Result<()> {
    let numbers = affine.geotransform().map(|number| format!("{number:?}")).join(", ");
    let wkt = wkt.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;");
    writeln!(out, "<PAMDataset>\n  <SRS>{wkt}</SRS>\n  <GeoTransform>{numbers}</GeoTransform>\n</PAMDataset>")
}

/// Parses a sidecar.
///
/// # Errors
/// A message if it is not XML.
pub fn parse(text: &str) -> Result<Notes, String> {
    let document = xml::parse(text, false)?;
    let root = document.root_element();
    let child = |name: &str| root.children().find(|node| node.has_tag_name(name)).and_then(|node| node.text());
    let affine = child("GeoTransform").and_then(numbers).map(Affine::of_geotransform);
    let system = child("SRS").map(str::trim).filter(|text| !text.is_empty()).map(String::from);
    let mut bands = Vec::new();
    for band in root.children().filter(|node| node.has_tag_name("PAMRasterBand")) {
        let number = band.attribute("band").and_then(|text| text.trim().parse().ok()).unwrap_or(1);
        if (1..=MAX_BANDS).contains(&number) {
            bands.resize(bands.len().max(number), BandMetadata::default());
            bands[number - 1] = BandMetadata::of_xml(band);
        }
    }
    Ok(Notes { affine, system, bands })
}

/// Six numbers separated by commas.
#[must_use]
pub fn numbers(text: &str) -> Option<[f64; 6]> {
    let numbers: Option<Vec<f64>> = text.split(',').map(|word| word.trim().parse().ok()).collect();
    numbers?.try_into().ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn place_and_system_are_found() {
        let text = "<PAMDataset>\n <SRS dataAxisToSRSAxisMapping=\"1,2\">PROJCS[&quot;a&quot;]</SRS>\n\
                    <GeoTransform>  5.0e+05, 3.0e+01, 0, 5.2e+06, 0, -3.0e+01</GeoTransform><Metadata/></PAMDataset>";
        let notes = parse(text).unwrap();
        assert_eq!(notes.system.as_deref(), Some("PROJCS[\"a\"]"));
        assert_eq!(notes.affine.unwrap().0, [30.0, 0.0, 500_015.0, 0.0, -30.0, 5_199_985.0]);
        let mut bytes = Vec::new();
        write(&mut bytes, &notes.affine.unwrap(), "PROJCS[\"<a&b>\"]").unwrap();
        let again = parse(&String::from_utf8(bytes).unwrap()).unwrap();
        assert_eq!((again.affine, again.system.as_deref()), (notes.affine, Some("PROJCS[\"<a&b>\"]")));
        assert_eq!(parse("<PAMDataset/>"), Ok(Notes::default()));
        let bands = "<PAMDataset><PAMRasterBand band=\"2\"><NoDataValue>-9.99900E+03</NoDataValue><UnitType>ft</UnitType>\
                     </PAMRasterBand></PAMDataset>";
        let bands = parse(bands).unwrap().bands;
        assert!(bands[0].is_empty() && bands[1].nodata == [-9999.0] && bands[1].unit.as_deref() == Some("ft"));
        assert!(parse("<PAMDataset>").unwrap_err().contains("not valid XML"));
    }
}
