//! The position of a GeoTIFF's samples.

use super::entries::Tiff;
use crate::format::affine::Affine;
use crate::format::crs::keys::{self, GeoKeys, short};
use crate::format::crs::rebuilt::rebuilt;
use crate::format::crs::unit::Unit;
use crate::format::crs::vertical;
use crate::format::dem::Placement;

/// The position of the samples, whether the first row is the southernmost, and metres per unit of height, if the
/// coordinate system states it. A raster without position tags has no position. Without GeoKeys, coordinates are in
/// metres.
pub struct Found {
    pub place: Option<Placement>,
    pub from_south: bool,
    pub vertical: Option<f64>,
    /// Whether the vertical system counts depths.
    pub is_depth: bool,
}

/// Reads the position tags.
pub fn find(tiff: &mut Tiff, height: usize) -> Result<Found, String> {
    let stored = keys(tiff)?;
    let vertical = match &stored {
        Some(keys) => vertical::metres_of_keys(keys)?.or_else(|| vertical::metres_of_text(keys::esri_text(keys)?)),
        None => None,
    };
    let is_depth = stored.as_ref().is_some_and(vertical::is_depth);
    let (scale, tie, matrix) = (tiff.doubles(33550)?, tiff.doubles(33922)?, tiff.doubles(34264)?);
    // East = a column + b row + c, north = d column + e row + f.
    let [a, b, c, d, e, f] = match (matrix.as_deref(), scale.as_deref(), tie.as_deref()) {
        (Some(m), _, _) if m.len() >= 16 => [m[0], m[1], m[3], m[4], m[5], m[7]],
        (_, Some([sx, sy, ..]), Some([i, j, _, x, y, ..])) => [*sx, 0.0, x - i * sx, 0.0, -sy, y + j * sy],
        _ => return Ok(Found { place: None, from_south: false, vertical, is_depth }),
    };
    // The tags refer to pixel corners, unless key 1025 declares pixel-is-point; then they refer to samples.
    let half = match stored.as_ref().and_then(|keys| short(keys, 1025)) {
        Some(2) => 0.0,
        _ => 0.5,
    };
    let lattice = Affine([a, b, c + half * (a + b), d, e, f + half * (d + e)]).lattice(height)?;
    let keys = stored.as_ref().map(rebuilt).transpose()?;
    let unit = keys.as_ref().map_or(Ok(Unit::Metres(1.0)), keys::unit)?;
    let place = Placement { origin: lattice.origin, step: lattice.step, unit, cell: None, keys };
    Ok(Found { place: Some(place), from_south: lattice.from_south, vertical, is_depth })
}

/// The keys as the file stores them.
fn keys(tiff: &mut Tiff) -> Result<Option<GeoKeys>, String> {
    let Some(directory) = tiff.wholes(34735)? else { return Ok(None) };
    let directory = directory.iter().map(|number| *number as u16).collect();
    let (doubles, text) = (tiff.doubles(34736)?.unwrap_or_default(), tiff.text(34737)?.unwrap_or_default());
    Ok(Some(GeoKeys { directory, doubles, text }))
}
