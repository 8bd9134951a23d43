//! Coordinate reference systems by EPSG code.

use std::str::FromStr;

use super::keys::GeoKeys;
use super::unit::Unit;

/// A coordinate reference system of the EPSG registry: a projected one, or a geographic one in degrees.
///
/// ```
/// use orogen_io::format::crs::registry::Crs;
///
/// let crs: Crs = "EPSG:32632".parse()?;
/// assert_eq!((crs.code(), crs.name()), (32632, "WGS 84 / UTM zone 32N"));
/// # Ok::<(), String>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Crs {
    code: u16,
    wkt: &'static str,
    /// The unit, and its EPSG code.
    unit: (Unit, u16),
}

impl FromStr for Crs {
    type Err = String;

    /// Parses `EPSG:32632`, `urn:ogc:def:crs:EPSG::32632` or only a code.
    fn from_str(text: &str) -> Result<Crs, String> {
        let text = text.trim();
        let lower = text.to_ascii_lowercase();
        let prefixes = ["urn:ogc:def:crs:epsg::", "epsg::", "epsg:"];
        let code = prefixes.into_iter().find_map(|prefix| lower.strip_prefix(prefix)).unwrap_or(&lower);
        match code.parse::<u16>() {
            Ok(code) => Crs::from_epsg(code),
            Err(_) => Err(format!("`{text}` is not a CRS; write its EPSG code, such as EPSG:32632")),
        }
    }
}

impl Crs {
    /// The system with this EPSG code.
    ///
    /// # Errors
    /// If the registry does not have the code, or it is neither a projected system nor a geographic one in degrees.
    pub fn from_epsg(code: u16) -> Result<Crs, String> {
        let wkt = match crs_definitions::from_code(code) {
            Some(definition) => definition.wkt,
            None => return Err(format!("unknown coordinate reference system EPSG:{code}")),
        };
        let kind = wkt.split('[').next().unwrap_or_default();
        let unit = match kind {
            "PROJCS" => linear_unit(wkt).map(|(metres, unit)| (Unit::Metres(metres), unit)),
            "GEOGCS" => wkt.contains("0.01745329251994").then_some((Unit::Degrees, DEGREE)),
            _ => None,
        };
        match unit {
            Some(unit) => Ok(Crs { code, wkt, unit }),
            None => {
                Err(format!("EPSG:{code} ({}) is neither a projected CRS nor a geographic one in degrees", name(wkt)))
            }
        }
    }

    /// The EPSG code.
    #[must_use]
    pub fn code(&self) -> u16 {
        self.code
    }

    /// The name in the registry.
    #[must_use]
    pub fn name(&self) -> &'static str {
        name(self.wkt)
    }

    /// The definition as OGC well-known text, version 1.
    #[must_use]
    pub fn wkt(&self) -> &'static str {
        self.wkt
    }

    /// The unit of the coordinates.
    #[must_use]
    pub fn unit(&self) -> Unit {
        self.unit.0
    }

    /// GeoTIFF keys of the system, with pixel-is-point.
    #[must_use]
    pub fn keys(&self) -> GeoKeys {
        let text = format!("{}|", self.name());
        let citation = [1026, 34737, text.len() as u16, 0];
        let keys = match self.unit {
            (Unit::Degrees, unit) => {
                [[1024, 0, 1, 2], [1025, 0, 1, 2], citation, [2048, 0, 1, self.code], [2054, 0, 1, unit]]
            }
            (_, unit) => [[1024, 0, 1, 1], [1025, 0, 1, 2], citation, [3072, 0, 1, self.code], [3076, 0, 1, unit]],
        };
        let directory = [[1, 1, 0, keys.len() as u16]].iter().chain(&keys).flatten().copied().collect();
        GeoKeys { directory, doubles: Vec::new(), text }
    }
}

const METRE: u16 = 9001;
const DEGREE: u16 = 9102;

fn name(wkt: &'static str) -> &'static str {
    wkt.split('"').nth(1).unwrap_or_default()
}

/// Metres per unit of a projected system, and the unit's EPSG code: from the `UNIT` outside of all other parts.
fn linear_unit(wkt: &str) -> Option<(f64, u16)> {
    let (mut depth, mut quoted, mut at) = (0, false, None);
    for (k, byte) in wkt.bytes().enumerate() {
        match byte {
            b'"' => quoted = !quoted,
            b'[' if !quoted => {
                depth += 1;
                if depth == 2 && wkt[..k].ends_with("UNIT") {
                    at = Some(k);
                }
            }
            b']' if !quoted => depth -= 1,
            _ => {}
        }
    }
    let unit = &wkt[at?..];
    let metres: f64 = unit.split([',', ']']).nth(1)?.parse().ok()?;
    let code = unit.split("AUTHORITY[\"EPSG\",\"").nth(1).and_then(|rest| rest.split('"').next()?.parse().ok());
    // The metre is recognised without a code.
    code.filter(|_| unit.find("AUTHORITY") < unit.find(']'))
        .or((metres == 1.0).then_some(METRE))
        .map(|code| (metres, code))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::format::dem::Georeference;

    #[test]
    fn codes_are_read_and_named() {
        for (text, code, name, unit, unit_code) in [
            ("EPSG:32632", 32632, "WGS 84 / UTM zone 32N", Unit::Metres(1.0), 9001),
            ("epsg:4326", 4326, "WGS 84", Unit::Degrees, 9102),
            (" 2056 ", 2056, "CH1903+ / LV95", Unit::Metres(1.0), 9001),
            ("urn:ogc:def:crs:EPSG::3857", 3857, "WGS 84 / Pseudo-Mercator", Unit::Metres(1.0), 9001),
            ("EPSG:2264", 2264, "NAD83 / North Carolina (ftUS)", Unit::Metres(0.304_800_609_601_219), 9003),
            ("EPSG:3405", 3405, "VN-2000 / UTM zone 48N", Unit::Metres(1.0), 9001),
        ] {
            let crs: Crs = text.parse().unwrap();
            assert_eq!((crs.code(), crs.name()), (code, name));
            let (Unit::Metres(found), Unit::Metres(expect)) = (crs.unit(), unit) else {
                assert_eq!(crs.unit(), unit);
                continue;
            };
            assert!((found - expect).abs() < 1e-12, "{text}: {found}");
            assert_eq!(crs.keys().directory.last(), Some(&unit_code), "{text}");
        }
    }

    #[test]
    fn keys_tell_the_code_again() {
        for code in [32632, 4326, 2264] {
            let keys = Crs::from_epsg(code).unwrap().keys();
            let map = Georeference { origin: [0.0; 2], per_metre: [1.0; 2], keys: Some(keys) };
            assert_eq!((map.epsg(), map.is_degrees()), (Some(code), code == 4326));
        }
    }

    #[test]
    fn every_projected_system_has_a_unit() {
        let all = (1..=u16::MAX).filter_map(crs_definitions::from_code);
        let projected: Vec<&str> =
            all.map(|definition| definition.wkt).filter(|wkt| wkt.starts_with("PROJCS")).collect();
        let without = projected.iter().filter(|wkt| linear_unit(wkt).is_none()).count();
        assert!(projected.len() > 4000 && without == 0, "{without} of {}", projected.len());
    }

    #[test]
    fn others_are_refused_by_name() {
        for (text, expect) in [
            ("EPSG:1", "unknown coordinate reference system EPSG:1"),
            ("EPSG:4978", "neither a projected CRS nor a geographic one"),
            ("EPSG:4807", "NTF (Paris)"),
            ("utm32", "`utm32` is not a CRS"),
            ("EPSG:99999", "is not a CRS"),
        ] {
            let why = text.parse::<Crs>().unwrap_err();
            assert!(why.contains(expect), "{text}: {why}");
        }
    }
}
