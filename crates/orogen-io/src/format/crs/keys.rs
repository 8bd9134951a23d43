//! Conversion of GeoTIFF keys (OGC 19-008r4) from and to well-known text.

use super::system::{Geographic, Method, System};
use super::unit::{Unit, code_of_length, length_of_code};
use super::wkt::Node;
use super::{arc_info, epsg};
use serde::{Deserialize, Serialize};

/// The GeoKey directory (OGC 19-008r4, 7.1.2), which describes the coordinate system.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct GeoKeys {
    /// Tag 34735, including its header of four numbers.
    pub directory: Vec<u16>,
    /// Tag 34736.
    pub doubles: Vec<f64>,
    /// Tag 34737.
    pub text: String,
}

/// The prefix that ESRI's programs and GDAL use for well-known text that no other key can express.
pub(crate) const ESRI_TEXT: &str = "ESRI PE String = ";

pub(crate) const MODEL: u16 = 1024;
const CITATION: u16 = 1026;
pub(crate) const GEOGRAPHIC: u16 = 2048;
pub(crate) const PROJECTED: u16 = 3072;
const ANGULAR_UNIT: u16 = 2054;
const ANGULAR_UNIT_SIZE: u16 = 2055;
const DATUM: u16 = 2050;
const SEMI_MAJOR: u16 = 2057;
const SEMI_MINOR: u16 = 2058;
const FLATTENING: u16 = 2059;
const PROJECTED_CITATION: u16 = 3073;
const LINEAR_UNIT: u16 = 3076;
const LINEAR_UNIT_SIZE: u16 = 3077;
/// GeoTIFF's code for values without a code.
pub const USER_DEFINED: u16 = 32767;
pub(crate) const TEXTS: u16 = 34737;
pub(crate) const DOUBLES: u16 = 34736;

/// The entries of the directory: as many as its header declares, because some programs pad it.
pub(crate) fn entries(keys: &GeoKeys) -> impl Iterator<Item = [u16; 4]> + '_ {
    let count = keys.directory.get(3).copied().unwrap_or_default();
    let entry = |key: &[u16]| [key[0], key[1], key[2], key[3]];
    keys.directory.chunks_exact(4).skip(1).take(usize::from(count)).map(entry)
}

/// The value of a key with a single short.
#[must_use]
pub fn short(keys: &GeoKeys, wanted: u16) -> Option<u16> {
    entries(keys).find(|key| key[0] == wanted && key[1] == 0).map(|key| key[3])
}

/// The value of a text key.
pub(crate) fn text(keys: &GeoKeys, wanted: u16) -> Option<&str> {
    let key = entries(keys).find(|key| key[0] == wanted && key[1] == TEXTS)?;
    let (from, length) = (usize::from(key[3]), usize::from(key[2]));
    Some(keys.text.get(from..(from + length).min(keys.text.len()))?.trim_end_matches(['|', '\0']))
}

/// The value of a numeric key.
fn double(keys: &GeoKeys, wanted: u16) -> Option<f64> {
    let key = entries(keys).find(|key| key[0] == wanted && key[1] == DOUBLES)?;
    keys.doubles.get(usize::from(key[3])).copied()
}

/// Whether coordinates are longitude and latitude, in degrees or another unit of angles.
#[must_use]
pub fn is_degrees(keys: &GeoKeys) -> bool {
    match short(keys, MODEL) {
        Some(2) => true,
        Some(USER_DEFINED) => esri_text(keys).is_some_and(|text| text.starts_with("GEO")),
        _ => false,
    }
}

/// Whether the keys describe a coordinate system on Earth: not local metres, and not degrees of an unknown datum.
#[must_use]
pub fn is_named(keys: &GeoKeys) -> bool {
    match short(keys, MODEL) {
        Some(1) => true,
        Some(2) => epsg(keys).is_some() || !keys.text.is_empty() || !keys.doubles.is_empty(),
        Some(USER_DEFINED) => esri_text(keys).is_some(),
        _ => false,
    }
}

/// The unit of the coordinates.
///
/// # Errors
/// A message if the keys state a unit that is not supported.
pub fn unit(keys: &GeoKeys) -> Result<Unit, String> {
    if is_degrees(keys) { angle(keys) } else { metres(keys).map(Unit::Metres) }
}

/// Metres per unit of projected coordinates: as the keys state it, otherwise from the EPSG code; 1 if neither is known.
///
/// # Errors
/// A message if the keys state a unit that is not a known length.
pub fn metres(keys: &GeoKeys) -> Result<f64, String> {
    let of_text = || Some(Node::parse(esri_text(keys)?).ok()?.metres());
    let of_code = || Some(Node::parse(crs_definitions::from_code(epsg(keys)?)?.wkt).ok()?.metres());
    match short(keys, LINEAR_UNIT) {
        None | Some(0) => Ok(of_text().or_else(of_code).unwrap_or(1.0)),
        Some(USER_DEFINED) => match double(keys, LINEAR_UNIT_SIZE) {
            Some(metres) if metres.is_finite() && metres > 0.0 => Ok(metres),
            Some(metres) => Err(format!("the unit of its coordinates has {metres} metres (GeoKey 3077)")),
            None => Ok(of_text().or_else(of_code).unwrap_or(1.0)),
        },
        Some(code) => length_of_code(code).ok_or_else(|| {
            format!("the unit of its coordinates, EPSG:{code} (GeoKey 3076), is not a known length; reproject it, for example with gdalwarp")
        }),
    }
}

/// The unit of longitude and latitude: as the keys state it, otherwise from the EPSG code or the text; degrees if none
/// is known.
fn angle(keys: &GeoKeys) -> Result<Unit, String> {
    let of_radians = |radians: f64| {
        let is = |degrees: f64| (radians - degrees.to_radians()).abs() < 1e-9;
        match (is(1.0), is(0.9)) {
            (true, _) => Ok(Unit::Degrees),
            (_, true) => Ok(Unit::Grads),
            _ => Err(format!(
                "its longitudes and latitudes are in units of {radians} radians; only degrees and grads are supported; reproject it, for example with gdalwarp -t_srs EPSG:4326"
            )),
        }
    };
    let stated = match short(keys, ANGULAR_UNIT) {
        Some(9102 | 9122) => return Ok(Unit::Degrees),
        Some(9105 | 9106) => return Ok(Unit::Grads),
        Some(9101) => Some(1.0),
        Some(9103) => Some((1.0f64 / 60.0).to_radians()),
        Some(9104) => Some((1.0f64 / 3600.0).to_radians()),
        Some(USER_DEFINED) => double(keys, ANGULAR_UNIT_SIZE),
        None | Some(0) => None,
        Some(code) => {
            return Err(format!(
                "the unit of its longitudes and latitudes, EPSG:{code} (GeoKey 2054), is not supported; reproject it, for example with gdalwarp -t_srs EPSG:4326"
            ));
        }
    };
    let of_code = || Node::parse(crs_definitions::from_code(epsg(keys)?)?.wkt).ok()?.radians();
    let of_text = || Node::parse(esri_text(keys)?).ok()?.radians();
    stated.or_else(of_code).or_else(of_text).map_or(Ok(Unit::Degrees), of_radians)
}

/// The EPSG code of the system, if the keys have one.
#[must_use]
pub fn epsg(keys: &GeoKeys) -> Option<u16> {
    let key = |wanted: u16| short(keys, wanted).filter(|code| !matches!(*code, 0 | USER_DEFINED));
    // Model 2 is a geographic system, 1 a projected one.
    if is_degrees(keys) { key(GEOGRAPHIC) } else { key(PROJECTED) }
}

/// The keys for an EPSG code.
#[must_use]
pub fn of_epsg(code: u16, geographic: bool) -> GeoKeys {
    let directory = match geographic {
        true => vec![1, 1, 0, 2, MODEL, 0, 1, 2, GEOGRAPHIC, 0, 1, code],
        false => vec![1, 1, 0, 2, MODEL, 0, 1, 1, PROJECTED, 0, 1, code],
    };
    GeoKeys { directory, ..GeoKeys::default() }
}

/// The keys for the text of a `.prj`: the EPSG code if it states one or is a known system, otherwise the text itself.
///
/// # Errors
/// A message if it is not the text of a coordinate system on Earth.
pub fn of_wkt(wkt: &str) -> Result<GeoKeys, String> {
    let wkt = wkt.trim_start_matches('\u{feff}').trim();
    if let Some(code) = arc_info::epsg(wkt) {
        return Ok(of_epsg(code, epsg::geographic(code).is_some()));
    }
    let node = Node::parse(wkt)?;
    let geographic = node.is_geographic();
    if !geographic && !node.is_projected() {
        return Err(format!("its {} is neither a projected nor a geographic coordinate system", node.keyword));
    }
    let metres = node.metres();
    if let Some(code) = node.epsg() {
        let mut keys = of_epsg(code, geographic);
        if !geographic && metres != 1.0 {
            push_unit(&mut keys, metres);
        }
        return Ok(keys);
    }
    // Heights are converted to metres, so the vertical part is omitted.
    let wkt = wkt.get(node.horizontal().span.clone()).unwrap_or(wkt);
    let text = format!("{ESRI_TEXT}{wkt}|");
    // A bar would end the text, and GeoTIFF texts must be ASCII.
    if wkt.contains('|') || !wkt.is_ascii() {
        return Err("its well-known text contains invalid characters".into());
    }
    // GDAL writes a text that no other key expresses in this way, and reads the text only if the model is user-defined.
    let directory = vec![1, 1, 0, 2, MODEL, 0, 1, USER_DEFINED, PROJECTED_CITATION, TEXTS, text.len() as u16, 0];
    let mut keys = GeoKeys { directory, doubles: Vec::new(), text };
    if !geographic {
        push_unit(&mut keys, metres);
    }
    Ok(keys)
}

/// The keys for a well-known text, or for a code such as `EPSG:32632`, also in a URL or URN that ends with it.
///
/// # Errors
/// A message if it is neither.
pub fn of_text(text: &str) -> Result<GeoKeys, String> {
    let text = text.trim();
    let code = text.rsplit([':', '/']).next().and_then(|code| code.parse().ok());
    match code.filter(|_| text.len() < 100 && text.to_ascii_uppercase().contains("EPSG")) {
        Some(code) => match crs_definitions::from_code(code) {
            Some(definition) => of_wkt(definition.wkt),
            None => Err(format!("the registry has no EPSG:{code}")),
        },
        None => of_wkt(text),
    }
}

/// Adds the unit of length. Keys must be sorted, and this one is the last.
fn push_unit(keys: &mut GeoKeys, metres: f64) {
    let code = code_of_length(metres);
    if let Some(code) = code {
        keys.directory.extend([LINEAR_UNIT, 0, 1, code]);
        keys.directory[3] += 1;
    }
}

/// The well-known text that these keys contain in ESRI's form.
pub(crate) fn esri_text(keys: &GeoKeys) -> Option<&str> {
    let mut texts = [PROJECTED_CITATION, CITATION, 2049].into_iter().filter_map(|key| text(keys, key));
    texts.find_map(|text| Some(text.split_once(ESRI_TEXT)?.1))
}

/// The well-known text of keys, for a `.prj` file.
///
/// # Errors
/// A message that names the part that cannot be expressed.
pub fn to_wkt(keys: &GeoKeys) -> Result<String, String> {
    if let Some(code) = epsg(keys) {
        return match epsg::find(code) {
            Some(system) => Ok(system.to_wkt()),
            // In OGC's form, which all programs except ESRI's read equally well.
            None => match crs_definitions::from_code(code) {
                Some(definition) => Ok(definition.wkt.to_string()),
                None => Err(format!("the registry has no EPSG:{code}")),
            },
        };
    }
    if let Some(text) = esri_text(keys) {
        return Ok(text.to_string());
    }
    match user_defined(keys) {
        Some(system) => Ok(system.to_wkt()),
        None if short(keys, MODEL) == Some(USER_DEFINED) => {
            Err("it is in local metres, not on a map of the Earth".into())
        }
        None if is_degrees(keys) => Err("the input has no datum".into()),
        None => Err(match text(keys, PROJECTED_CITATION).or_else(|| text(keys, CITATION)) {
            Some(name) => format!("\"{}\" is defined by keys that are not understood", name.escape_debug()),
            None => "it is defined by keys that are not understood".into(),
        }),
    }
}

/// The geographic system of the keys: by its code, by the code of its datum, or by its ellipsoid only.
fn geographic(keys: &GeoKeys) -> Option<Geographic> {
    let coded = |key: u16| short(keys, key).filter(|code| *code != USER_DEFINED);
    if let Some(code) = coded(GEOGRAPHIC) {
        return epsg::geographic(code);
    }
    if let Some(datum) = coded(DATUM) {
        // The EPSG code of the datum of these systems is the system's code plus 2000.
        return epsg::geographic(datum.checked_sub(2000)?);
    }
    let radius = double(keys, SEMI_MAJOR)?;
    let flattening = match (double(keys, FLATTENING), double(keys, SEMI_MINOR)) {
        (Some(flattening), _) => flattening,
        (None, Some(minor)) if minor < radius => radius / (radius - minor),
        (None, minor) => minor.map(|_| 0.0)?,
    };
    let unknown = "Unknown";
    Some(Geographic {
        code: 0,
        name: "GCS_Unknown",
        datum: "D_Unknown",
        datum_ogc: unknown,
        spheroid: unknown,
        radius,
        flattening,
    })
}

/// A projection that the keys define by parameters.
fn user_defined(keys: &GeoKeys) -> Option<System> {
    if short(keys, MODEL) != Some(1) || short(keys, ANGULAR_UNIT).is_some_and(|unit| !matches!(unit, 9102 | 9122)) {
        return None;
    }
    // Longitudes that count from a meridian other than Greenwich.
    if short(keys, 2051).is_some_and(|code| !matches!(code, 0 | 8901 | USER_DEFINED))
        || double(keys, 2061).is_some_and(|degrees| degrees != 0.0)
    {
        return None;
    }
    let geographic = geographic(keys)?;
    let first = |wanted: &[u16]| wanted.iter().find_map(|key| double(keys, *key));
    let (east, north) = (first(&[3082, 3086, 3090]).unwrap_or(0.0), first(&[3083, 3087, 3091]).unwrap_or(0.0));
    let (longitude, latitude) =
        (first(&[3080, 3084, 3088, 3095]).unwrap_or(0.0), first(&[3081, 3085, 3089]).unwrap_or(0.0));
    let scale = first(&[3092, 3093]).unwrap_or(1.0);
    let (method, rest) = match short(keys, 3075)? {
        1 => (Method::TransverseMercator, vec![scale, latitude]),
        7 if scale == 1.0 || double(keys, 3078).is_some() => {
            (Method::Mercator, vec![double(keys, 3078).unwrap_or(0.0)])
        }
        8 => (Method::Lambert, vec![double(keys, 3078)?, double(keys, 3079)?, latitude]),
        9 => (Method::LambertOne, vec![latitude, scale, latitude]),
        10 => (Method::AzimuthalEqualArea, vec![latitude]),
        11 => (Method::Albers, vec![double(keys, 3078)?, double(keys, 3079)?, latitude]),
        // The latitude is the latitude of true scale, unless it is the pole.
        15 if latitude.abs() == 90.0 => (Method::Stereographic, vec![scale, latitude]),
        15 if latitude > 0.0 && scale == 1.0 => (Method::NorthPole, vec![latitude]),
        15 if latitude < 0.0 && scale == 1.0 => (Method::SouthPole, vec![latitude]),
        14 => (Method::Stereographic, vec![scale, latitude]),
        16 => (Method::DoubleStereographic, vec![scale, latitude]),
        17 => (Method::EquidistantCylindrical, vec![double(keys, 3078).unwrap_or(latitude)]),
        24 => (Method::Sinusoidal, Vec::new()),
        _ => return None,
    };
    // ESRI's name would not match; the citation is the name in the file.
    let name = text(keys, PROJECTED_CITATION).or_else(|| text(keys, CITATION)).unwrap_or("Unknown");
    let name: String = name.chars().filter(|c| c.is_ascii_graphic() && !"\"[]|".contains(*c) || *c == ' ').collect();
    let unit = metres(keys).ok()?;
    let parameters = [vec![east, north, longitude], rest].concat();
    Some(System { name: name.trim().replace(' ', "_"), geographic, projection: Some((method, parameters)), unit })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn codes_become_texts_and_texts_codes() {
        for (code, geographic) in [(32632, false), (4326, true), (3857, false), (2154, false), (3031, false)] {
            let keys = of_epsg(code, geographic);
            let text = to_wkt(&keys).unwrap();
            assert_eq!(of_wkt(&text), Ok(keys.clone()), "{text}");
            assert_eq!((epsg(&keys), is_degrees(&keys)), (Some(code), geographic));
        }
        // A system that is not predefined comes from the registry, in feet.
        let feet = of_text("EPSG:2927").unwrap();
        assert_eq!((epsg(&feet), short(&feet, LINEAR_UNIT)), (Some(2927), Some(9003)));
        let text = to_wkt(&feet).unwrap();
        assert!(
            text.starts_with("PROJCS[\"NAD83(HARN) / Washington South (ftUS)\"") && of_wkt(&text) == Ok(feet),
            "{text}"
        );
        assert!(to_wkt(&of_epsg(1, false)).unwrap_err().contains("EPSG:1"));
    }

    #[test]
    fn unknown_texts_are_kept_as_they_are() {
        let text = "PROJCS[\"Mine\",GEOGCS[\"GCS_WGS_1984\",DATUM[\"D_WGS_1984\",SPHEROID[\"WGS_1984\",6378137.0,298.257223563]],\
                    PRIMEM[\"Greenwich\",0.0],UNIT[\"Degree\",0.0174532925199433]],PROJECTION[\"Sinusoidal\"],\
                    PARAMETER[\"False_Easting\",1.5],UNIT[\"Foot\",0.3048]]";
        let keys = of_wkt(&format!("\u{feff}{text}\r\n")).unwrap();
        assert_eq!((to_wkt(&keys).as_deref(), epsg(&keys), metres(&keys)), (Ok(text), None, Ok(0.3048)));
        assert_eq!(usize::from(keys.directory[3]) * 4 + 4, keys.directory.len());
        assert!(of_wkt("LOCAL_CS[\"here\"]").unwrap_err().contains("LOCAL_CS"));
    }

    #[test]
    fn projections_that_keys_define_are_written() {
        // Albers on NAD83, each parameter a double.
        let parameters = [(3078u16, 29.5), (3079, 45.5), (3080, -96.0), (3081, 23.0), (3082, 10.0), (3083, 20.0)];
        let mut directory =
            vec![1, 1, 0, 0, MODEL, 0, 1, 1, GEOGRAPHIC, 0, 1, 4269, PROJECTED, 0, 1, USER_DEFINED, 3075, 0, 1, 11];
        parameters.iter().enumerate().for_each(|(k, (key, _))| directory.extend([*key, DOUBLES, 1, k as u16]));
        directory[3] = (directory.len() / 4 - 1) as u16;
        let keys =
            GeoKeys { directory, doubles: parameters.iter().map(|(_, value)| *value).collect(), text: String::new() };
        // The same with a datum given by its code, and with an ellipsoid only.
        let with = |more: &[u16], doubles: &[f64]| {
            let mut keys = keys.clone();
            keys.directory[4 * 2 + 3] = USER_DEFINED;
            keys.directory.extend(more);
            keys.directory[3] = (keys.directory.len() / 4 - 1) as u16;
            keys.doubles.extend(doubles);
            to_wkt(&keys)
        };
        assert!(
            with(&[DATUM, 0, 1, 6326], &[]).unwrap().contains("DATUM[\"D_WGS_1984\",SPHEROID[\"WGS_1984\",6378137.0,")
        );
        let ball = with(&[SEMI_MAJOR, DOUBLES, 1, 6, SEMI_MINOR, DOUBLES, 1, 7], &[6_370_000.0; 2]).unwrap();
        assert!(ball.contains("DATUM[\"D_Unknown\",SPHEROID[\"Unknown\",6370000.0,0.0]]"), "{ball}");
        assert!(with(&[], &[]).is_err());
        let text = to_wkt(&keys).unwrap();
        assert!(
            text.starts_with("PROJCS[\"Unknown\",GEOGCS[\"GCS_North_American_1983\"")
                && text.contains("PROJECTION[\"Albers\"]")
        );
        assert!(text.contains("\"False_Easting\",10.0]") && text.contains("\"Standard_Parallel_2\",45.5]"), "{text}");
    }
}
