//! GeoKeys written again from their known parts.

use super::keys::{
    DOUBLES, ESRI_TEXT, GEOGRAPHIC, GeoKeys, MODEL, PROJECTED, TEXTS, entries, epsg, is_degrees, metres, short,
};
use super::wkt::Node;

/// The key of a projection by its EPSG code, without its geographic system.
const PROJECTION: u16 = 3074;

/// Maximum number of numbers, and length of all texts: keys refer to them with 16 bits.
const MAX_LENGTH: usize = 1 << 16;

/// The keys of the horizontal system, as a new directory: sorted, each once, without padding, with the texts and
/// numbers that they refer to. The raster type belongs to the samples, and the vertical system to heights in its unit,
/// so both are omitted. A UTM zone that is stated only by its projection gets its EPSG code.
///
/// # Errors
/// A message if a number is not finite.
pub fn rebuilt(found: &GeoKeys) -> Result<GeoKeys, String> {
    let mut own: Vec<[u16; 4]> = entries(found).filter(|key| is_horizontal(key[0])).collect();
    own.sort_by_key(|key| key[0]);
    own.dedup_by_key(|key| key[0]);
    let mut keys = GeoKeys { directory: vec![1, 1, 0, 0], ..GeoKeys::default() };
    for [key, tag, count, at] in own {
        let (from, count) = (usize::from(at), usize::from(count));
        let entry = match tag {
            0 => Some([key, 0, 1, at]),
            DOUBLES => {
                let numbers = found.doubles.get(from..from + count.max(1)).unwrap_or_default();
                if let Some(number) = numbers.iter().find(|number| !number.is_finite()) {
                    return Err(format!("its coordinate system is invalid: its GeoKey {key} is {number}"));
                }
                let entry = [key, DOUBLES, numbers.len() as u16, keys.doubles.len() as u16];
                let fits = !numbers.is_empty() && keys.doubles.len() + numbers.len() < MAX_LENGTH;
                keys.doubles.extend(numbers.iter().filter(|_| fits));
                fits.then_some(entry)
            }
            TEXTS => {
                let end = (from + count).min(found.text.len());
                let text = found.text.get(from..end).unwrap_or_default().trim_end_matches(['|', '\0']);
                let text = text_of(text) + "|";
                let entry = [key, TEXTS, text.len() as u16, keys.text.len() as u16];
                let fits = keys.text.len() + text.len() < MAX_LENGTH;
                keys.text.push_str(if fits { &text } else { "" });
                fits.then_some(entry)
            }
            _ => None,
        };
        keys.directory.extend(entry.into_iter().flatten());
        keys.directory[3] += u16::from(entry.is_some());
    }
    if let Some(code) = utm(&keys) {
        keys.directory = with_short(&keys, PROJECTED, code);
    }
    Ok(keys)
}

/// Whether a key describes the horizontal system.
fn is_horizontal(key: u16) -> bool {
    matches!(key, MODEL | 1026 | GEOGRAPHIC..=2062 | PROJECTED..=3096)
}

/// A text, in ASCII as GeoTIFF requires. Of well-known text only the horizontal system is kept. A key states the length
/// of its text, so bars within it are kept: GDAL separates the names of a datum, ellipsoid and meridian by them.
fn text_of(text: &str) -> String {
    let (before, wkt) = text.split_once(ESRI_TEXT).map_or((text, None), |(before, wkt)| (before, Some(wkt)));
    let horizontal = wkt.map(|wkt| {
        let node = Node::parse(wkt).ok();
        let span = node.map(|node| node.horizontal().span.clone());
        let own = span.and_then(|span| wkt.get(span)).unwrap_or(wkt);
        format!("{ESRI_TEXT}{own}")
    });
    let text = format!("{before}{}", horizontal.unwrap_or_default());
    text.chars().map(|c| if c.is_ascii() { c } else { '?' }).collect()
}

/// The EPSG code of a UTM zone that has only a projection and a geographic system.
fn utm(keys: &GeoKeys) -> Option<u16> {
    if is_degrees(keys) || epsg(keys).is_some() || metres(keys) != Ok(1.0) {
        return None;
    }
    let (zone, is_north) = match short(keys, PROJECTION)? {
        code @ 16001..=16060 => (code - 16000, true),
        code @ 16101..=16160 => (code - 16100, false),
        _ => return None,
    };
    match (short(keys, GEOGRAPHIC)?, is_north) {
        (4326, true) => Some(32600 + zone),
        (4326, false) => Some(32700 + zone),
        (4322, true) => Some(32200 + zone),
        (4322, false) => Some(32300 + zone),
        (4269, true) if zone <= 23 => Some(26900 + zone),
        (4267, true) if zone <= 22 => Some(26700 + zone),
        (4258, true) if (28..=38).contains(&zone) => Some(25800 + zone),
        (4230, true) if (28..=38).contains(&zone) => Some(23000 + zone),
        _ => None,
    }
}

/// A directory with an additional key, in order; an existing key with this number is replaced. Writers add the raster
/// type this way.
#[must_use]
pub fn with_short(keys: &GeoKeys, key: u16, value: u16) -> Vec<u16> {
    let mut own: Vec<[u16; 4]> = entries(keys).filter(|other| other[0] != key).collect();
    own.push([key, 0, 1, value]);
    own.sort_by_key(|key| key[0]);
    [[1, 1, 0, own.len() as u16]].iter().chain(&own).flatten().copied().collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::format::crs::keys::{USER_DEFINED, of_epsg, to_wkt, unit};
    use crate::format::crs::unit::Unit;

    fn keys(list: &[[u16; 4]]) -> GeoKeys {
        let directory = [[1, 1, 0, list.len() as u16]].iter().chain(list).flatten().copied().collect();
        GeoKeys { directory, ..GeoKeys::default() }
    }

    #[test]
    fn padding_and_the_vertical_system_are_left_out() {
        let mut found = keys(&[
            [1024, 0, 1, 1],
            [1025, 0, 1, 1],
            [1026, TEXTS, 4, 2],
            [3072, 0, 1, 32632],
            [4096, 0, 1, 6360],
            [4097, TEXTS, 3, 6],
            [4099, 0, 1, 9003],
        ]);
        found.text = "x|abc|de|".into();
        found.directory.extend([0; 8]);
        let own = rebuilt(&found).unwrap();
        assert_eq!(own.directory, [1, 1, 0, 3, 1024, 0, 1, 1, 1026, TEXTS, 4, 0, 3072, 0, 1, 32632]);
        assert_eq!((own.text.as_str(), own.doubles.len()), ("abc|", 0));
        assert_eq!(rebuilt(&own).as_ref(), Ok(&own));
        assert_eq!(
            with_short(&own, 1025, 2),
            [1, 1, 0, 4, 1024, 0, 1, 1, 1025, 0, 1, 2, 1026, TEXTS, 4, 0, 3072, 0, 1, 32632]
        );
        // Keys beyond the declared count, references beyond the numbers, and no directory at all.
        assert_eq!(rebuilt(&GeoKeys { directory: vec![1, 1, 0, 9], ..GeoKeys::default() }).unwrap().directory[3], 0);
        assert_eq!(rebuilt(&keys(&[[3080, DOUBLES, 1, 7]])).unwrap().directory, [1, 1, 0, 0]);
        assert_eq!(rebuilt(&GeoKeys::default()).unwrap().directory, [1, 1, 0, 0]);
        // A text that is longer than keys can refer to.
        let long =
            GeoKeys { text: "a".repeat(1 << 17), ..keys(&[[1026, TEXTS, u16::MAX, 0], [3073, TEXTS, u16::MAX, 9]]) };
        assert_eq!(rebuilt(&long).unwrap().directory, [1, 1, 0, 0]);
        let nan = GeoKeys { doubles: vec![f64::NAN], ..keys(&[[3080, DOUBLES, 1, 0]]) };
        assert!(rebuilt(&nan).unwrap_err().contains("GeoKey 3080 is NaN"));
    }

    #[test]
    fn a_utm_zone_is_known_by_its_projection() {
        for (projection, degrees, expect) in
            [(16032, 4326, 32632), (16119, 4326, 32719), (16011, 4269, 26911), (16033, 4258, 25833)]
        {
            let found =
                keys(&[[1024, 0, 1, 1], [2048, 0, 1, degrees], [3072, 0, 1, USER_DEFINED], [3074, 0, 1, projection]]);
            assert_eq!(epsg(&rebuilt(&found).unwrap()), Some(expect));
            let found = keys(&[[1024, 0, 1, 1], [2048, 0, 1, degrees], [3074, 0, 1, projection]]);
            assert_eq!(epsg(&rebuilt(&found).unwrap()), Some(expect));
        }
        let in_feet = keys(&[[1024, 0, 1, 1], [2048, 0, 1, 4326], [3074, 0, 1, 16032], [3076, 0, 1, 9002]]);
        assert_eq!(epsg(&rebuilt(&in_feet).unwrap()), None);
    }

    #[test]
    fn bars_within_texts_and_the_angle_of_oblique_systems_are_kept() {
        // A datum without a code, and an oblique Mercator projection, as written by GDAL.
        let text = "GCS Name = a|Datum = b|Primem = Paris||";
        let mut found = keys(&[[1024, 0, 1, 1], [2049, TEXTS, text.len() as u16, 0], [3096, DOUBLES, 1, 0]]);
        (found.text, found.doubles) = (text.into(), vec![30.0]);
        let own = rebuilt(&found).unwrap();
        assert_eq!(
            (own.text.as_str(), own.doubles.as_slice()),
            ("GCS Name = a|Datum = b|Primem = Paris|", &[30.0][..])
        );
        assert_eq!(own.directory[3], 3);
        assert_eq!(rebuilt(&own).as_ref(), Ok(&own));
    }

    #[test]
    fn compound_texts_keep_their_horizontal_part() {
        let text = "ESRI PE String = COMPD_CS[\"a\",PROJCS[\"b\",UNIT[\"Foot\",0.3048]],VERT_CS[\"c\",UNIT[\"foot\",0.3048]]]|";
        let mut found = keys(&[[1024, 0, 1, 1], [3073, TEXTS, text.len() as u16, 0]]);
        found.text = text.into();
        let own = rebuilt(&found).unwrap();
        assert_eq!(to_wkt(&own).as_deref(), Ok("PROJCS[\"b\",UNIT[\"Foot\",0.3048]]"));
        assert_eq!(unit(&own), Ok(Unit::Metres(0.3048)));
    }

    #[test]
    fn units_of_coordinates_are_known() {
        for (found, expect) in [
            (of_epsg(4326, true), Unit::Degrees),
            (of_epsg(4807, true), Unit::Grads),
            (keys(&[[1024, 0, 1, 2], [2048, 0, 1, USER_DEFINED], [2054, 0, 1, 9105]]), Unit::Grads),
            (of_epsg(32632, false), Unit::Metres(1.0)),
            (keys(&[[1024, 0, 1, 1], [3072, 0, 1, 32632], [3076, 0, 1, 9096]]), Unit::Metres(0.9144)),
        ] {
            assert_eq!(unit(&found), Ok(expect), "{found:?}");
        }
        // In feet, which follows from its code alone.
        let Ok(Unit::Metres(feet)) = unit(&of_epsg(2264, false)) else { panic!() };
        assert!((feet - 1200.0 / 3937.0).abs() < 1e-12);
        for (key, unit_code) in [(2054, 9104), (2054, 9001)] {
            assert!(unit(&keys(&[[1024, 0, 1, 2], [key, 0, 1, unit_code]])).is_err());
        }
        assert!(unit(&keys(&[[1024, 0, 1, 1], [3076, 0, 1, 9102]])).unwrap_err().contains("EPSG:9102"));
    }
}
