//! Units of vertical coordinate systems.

use super::arc_info;
use super::keys::{GeoKeys, USER_DEFINED, short};
use super::unit::{length_of_code, metres_of_vertical};
use super::wkt::Node;

/// GeoTIFF keys of the vertical system and its unit.
const SYSTEM: u16 = 4096;
const UNIT: u16 = 4099;

/// Metres per unit of height that GeoTIFF keys state: by the unit's code, otherwise by the code of the vertical system;
/// `None` if they state neither.
///
/// # Errors
/// A message if the unit is not a known length.
pub fn metres_of_keys(keys: &GeoKeys) -> Result<Option<f64>, String> {
    let coded = |key: u16| short(keys, key).filter(|code| !matches!(*code, 0 | USER_DEFINED));
    match (coded(UNIT), coded(SYSTEM)) {
        (Some(unit), _) => match length_of_code(unit) {
            Some(metres) => Ok(Some(metres)),
            None => Err(format!(
                "the unit of its heights, EPSG:{unit} (GeoKey 4099), is not a known length; convert them to metres first, for example with gdal_calc.py"
            )),
        },
        (None, Some(system)) => Ok(Some(metres_of_vertical(system))),
        (None, None) => Ok(None),
    }
}

/// The vertical systems of the EPSG registry whose axis points down.
const DEPTHS: &[u16] = &[
    5336, 5612, 5614, 5706, 5715, 5789, 5831, 5861, 5862, 5863, 5864, 5865, 5866, 5867, 5868, 5869, 5870, 5871, 5872,
    5873, 5874, 6357, 6358, 6359, 8051, 8053,
];

/// Whether GeoTIFF keys state a vertical system of depths.
#[must_use]
pub fn is_depth(keys: &GeoKeys) -> bool {
    short(keys, SYSTEM).is_some_and(|code| DEPTHS.contains(&code))
}

/// Metres per unit of height that a coordinate system in any form of [`keys::of_text`](super::keys::of_text) states;
/// `None` if it has no vertical part.
#[must_use]
pub fn metres_of_text(text: &str) -> Option<f64> {
    let text = text.trim_start_matches('\u{feff}').trim();
    match Node::parse(text) {
        Ok(node) => node.vertical_metres(),
        Err(_) => arc_info::vertical_metres(text),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::format::crs::unit::US_FOOT;

    fn keys(more: &[u16]) -> GeoKeys {
        let count = 1 + more.len() as u16 / 4;
        let directory = [&[1, 1, 0, count, 1024, 0, 1, 1], more].concat();
        GeoKeys { directory, ..GeoKeys::default() }
    }

    #[test]
    fn units_of_heights_are_known_by_code() {
        for (more, expect) in [
            (&[][..], Ok(None)),
            (&[4096, 0, 1, 5703], Ok(Some(1.0))),
            (&[4096, 0, 1, 6360], Ok(Some(US_FOOT))),
            (&[4096, 0, 1, 8228], Ok(Some(0.3048))),
            (&[4099, 0, 1, 9002], Ok(Some(0.3048))),
            // The stated unit takes precedence over the unit of the system.
            (&[4096, 0, 1, 5703, 4099, 0, 1, 9003], Ok(Some(US_FOOT))),
            (&[4096, 0, 1, 32767, 4099, 0, 1, 9001], Ok(Some(1.0))),
        ] {
            assert_eq!(metres_of_keys(&keys(more)), expect, "{more:?}");
        }
        assert!(metres_of_keys(&keys(&[4099, 0, 1, 9102])).unwrap_err().contains("EPSG:9102"));
    }

    #[test]
    fn depths_are_known_by_code() {
        for (code, expect) in [(5715, true), (6358, true), (5714, false), (6360, false)] {
            assert_eq!(is_depth(&keys(&[4096, 0, 1, code])), expect, "{code}");
        }
    }

    #[test]
    fn units_of_heights_are_known_by_text() {
        for (text, expect) in [
            (
                r#"COMPD_CS["a",PROJCS["b",UNIT["metre",1]],VERT_CS["c",VERT_DATUM["d",2005],UNIT["foot",0.3048]]]"#,
                Some(0.3048),
            ),
            (r#"COMPD_CS["a",PROJCS["b"],VERT_CS["c",AUTHORITY["EPSG","6360"]]]"#, Some(US_FOOT)),
            (
                r#"COMPOUNDCRS["a",PROJCRS["b"],VERTCRS["c",CS[vertical,1],AXIS["h",up],LENGTHUNIT["foot",0.3048]]]"#,
                Some(0.3048),
            ),
            // ESRI writes the vertical system after the horizontal one.
            (
                r#"PROJCS["b",UNIT["Meter",1.0]],VERTCS["c",UNIT["Foot_US",0.3048006096012192]]"#,
                Some(0.304_800_609_601_219_2),
            ),
            (r#"PROJCS["b",UNIT["Foot",0.3048]]"#, None),
            ("EPSG:32632", None),
        ] {
            assert_eq!(metres_of_text(text), expect, "{text}");
        }
    }
}
