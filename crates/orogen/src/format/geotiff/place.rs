//! Where a GeoTIFF's samples stand.

use super::entries::Tiff;
use crate::format::dem::{GeoKeys, Place, Unit};

/// Where the samples stand, whether rows come from the south, and how many metres a unit of height is. A raster without tags of
/// place has none; one without GeoKeys, or projected in a unit that they do not tell, counts in metres.
pub struct Found {
    pub place: Option<Place>,
    pub from_south: bool,
    pub metres_high: f64,
}

/// Reads the tags of place.
pub fn find(tiff: &mut Tiff, height: usize) -> Result<Found, String> {
    let keys = keys(tiff)?;
    let metres_high = match keys.as_ref().and_then(|keys| short(keys, 4099)) {
        Some(unit) => length_unit(unit).unwrap_or(1.0),
        None => 1.0,
    };
    let (scale, tie, matrix) = (tiff.doubles(33550)?, tiff.doubles(33922)?, tiff.doubles(34264)?);
    // East = a column + b row + c, north = d column + e row + f.
    let [a, b, c, d, e, f] = match (matrix.as_deref(), scale.as_deref(), tie.as_deref()) {
        (Some(m), _, _) if m.len() >= 16 => [m[0], m[1], m[3], m[4], m[5], m[7]],
        (_, Some([sx, sy, ..]), Some([i, j, _, x, y, ..])) => [*sx, 0.0, x - i * sx, 0.0, -sy, y + j * sy],
        _ => return Ok(Found { place: None, from_south: false, metres_high }),
    };
    if ![a, b, c, d, e, f].iter().all(|number| number.is_finite()) || a <= 0.0 || e == 0.0 {
        return Err("its tags of place are no numbers that a map can have".into());
    }
    if b.abs() > 1e-9 * a.abs() || d.abs() > 1e-9 * e.abs() {
        return Err("its rows are turned against east; lay it north up first, such as by gdalwarp".into());
    }
    // The tags speak of pixels' corners, unless key 1025 says that pixels are points: then of the samples themselves.
    let half = match keys.as_ref().and_then(|keys| short(keys, 1025)) {
        Some(2) => 0.0,
        _ => 0.5,
    };
    let from_south = e > 0.0;
    let first = if from_south { height as f64 - 1.0 + half } else { half };
    let unit = unit(keys.as_ref());
    let place = Place { origin: [c + a * half, f + e * first], step: [a, e.abs()], unit, keys };
    Ok(Found { place: Some(place), from_south, metres_high })
}

fn keys(tiff: &mut Tiff) -> Result<Option<GeoKeys>, String> {
    let Some(directory) = tiff.wholes(34735)? else { return Ok(None) };
    let directory = directory.iter().map(|number| *number as u16).collect();
    let (doubles, text) = (tiff.doubles(34736)?.unwrap_or_default(), tiff.text(34737)?.unwrap_or_default());
    Ok(Some(GeoKeys { directory, doubles, text }))
}

/// A key whose value is one short number.
pub fn short(keys: &GeoKeys, wanted: u16) -> Option<u16> {
    keys.directory.chunks_exact(4).skip(1).find(|key| key[0] == wanted && key[1] == 0).map(|key| key[3])
}

fn unit(keys: Option<&GeoKeys>) -> Unit {
    let Some(keys) = keys else { return Unit::Metres(1.0) };
    match short(keys, 1024) {
        Some(2) => Unit::Degrees,
        _ => Unit::Metres(short(keys, 3076).and_then(length_unit).unwrap_or(1.0)),
    }
}

/// Metres in a unit of length, by its EPSG code.
fn length_unit(code: u16) -> Option<f64> {
    match code {
        9001 => Some(1.0),
        9002 => Some(0.3048),
        9003 => Some(1200.0 / 3937.0),
        9036 => Some(1000.0),
        _ => None,
    }
}
