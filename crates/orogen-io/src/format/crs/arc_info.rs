//! `.prj` files of ARC/INFO, older than well-known text: lines of a keyword and a value. The USGS provided them with
//! its grids.

use super::epsg;
use super::unit::US_FOOT;

/// Maximum number of lines.
const MAX_LINES: usize = 64;

/// The EPSG code of such a text, if it is supported: UTM or degrees, in metres, on North American datums or WGS 84.
pub fn epsg(text: &str) -> Option<u16> {
    let value = |wanted: &str| value(text, wanted);
    let plain = |text: String| text.replace(['_', '-', ' '], "");
    let degrees = match plain(value("Datum")?).as_str() {
        "WGS84" | "WGS1984" => 4326,
        "NAD83" | "NAR" | "NORTHAMERICAN1983" => 4269,
        "NAD27" | "NAS" | "NORTHAMERICAN1927" => 4267,
        _ => return None,
    };
    match value("Projection")?.as_str() {
        "GEOGRAPHIC" => Some(degrees),
        "UTM" => {
            if value("Units").is_some_and(|units| !units.starts_with("METER") && !units.starts_with("METRE")) {
                return None;
            }
            // A southern zone has a false northing or is a negative number.
            let zone: i32 = value("Zone")?.parse().ok()?;
            let shifted = value("Yshift").and_then(|shift| shift.parse::<f64>().ok()).is_some_and(|shift| shift != 0.0);
            let first = match (degrees, zone < 0) {
                _ if shifted => return None,
                (4326, false) => 32600,
                (4326, true) => 32700,
                (4269, false) => 26900,
                (4267, false) => 26700,
                _ => return None,
            };
            let code = u16::try_from(first + zone.abs()).ok()?;
            epsg::find(code).filter(|system| system.projection.is_some()).map(|_| code)
        }
        _ => None,
    }
}

/// The value of a keyword, in capital letters.
fn value(text: &str, wanted: &str) -> Option<String> {
    text.lines().take(MAX_LINES).find_map(|line| {
        let (keyword, value) = line.trim().split_once(char::is_whitespace)?;
        keyword.eq_ignore_ascii_case(wanted).then(|| value.trim().to_ascii_uppercase())
    })
}

/// Metres per unit of height, if the text states the unit; a number is the number of units per metre.
pub fn vertical_metres(text: &str) -> Option<f64> {
    value(text, "Projection")?;
    match value(text, "Zunits")?.as_str() {
        "FEET" => Some(US_FOOT),
        "METERS" | "METRES" => Some(1.0),
        number => number.parse().ok().filter(|units: &f64| units.is_finite() && *units > 0.0).map(|units| 1.0 / units),
    }
}

/// Whether coordinates are seconds of arc.
pub fn is_in_seconds(text: &str) -> bool {
    value(text, "Projection").as_deref() == Some("GEOGRAPHIC") && value(text, "Units").as_deref() == Some("DS")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_the_usgs_wrote_is_read() {
        let text = |projection: &str, datum: &str, rest: &str| {
            format!("Projection    {projection}\r\nDatum         {datum}\r\n{rest}\r\nParameters\r\n")
        };
        assert_eq!(epsg(&text("UTM", "NAD83", "Units METERS\nZone 11\nYshift 0.0")), Some(26911));
        assert_eq!(epsg(&text("GEOGRAPHIC", "NAD27", "Units DD")), Some(4267));
        assert_eq!(epsg(&text("UTM", "WGS84", "Zone -19")), Some(32719));
        assert_eq!(epsg(&text("UTM", "WGS84", "Zone 61")), None);
        assert_eq!(epsg(&text("UTM", "NAD27", "Units FEET\nZone 11")), None);
        assert_eq!(epsg("PROJCS[\"a\"]"), None);
    }

    #[test]
    fn units_of_heights_and_seconds_are_known() {
        let text = |rest: &str| format!("Projection GEOGRAPHIC\r\nDatum WGS84\r\n{rest}\r\nParameters\r\n");
        for (rest, expect) in [
            ("Zunits FEET", Some(US_FOOT)),
            ("ZUNITS Meters", Some(1.0)),
            ("Zunits 100", Some(0.01)),
            ("Zunits NO", None),
            ("Zunits 0", None),
            ("Units DD", None),
        ] {
            assert_eq!(vertical_metres(&text(rest)), expect, "{rest}");
        }
        assert_eq!([text("Units DS"), text("Units DD")].map(|text| is_in_seconds(&text)), [true, false]);
    }
}
