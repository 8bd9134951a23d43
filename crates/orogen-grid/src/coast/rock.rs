//! Cliffs and shore platforms: profiles across a shore that has retreated.

use super::Coast;
use super::march::{Front, march, neighbors};
use super::retreat::{Shore, starts};
use crate::grid::Window;

/// Depth of the platform's inner edge, and height of a cliff's foot: about half of the range of tides, in metres.
const TIDE: f64 = 1.5;
/// Depth to which the waves of an open coast wear rock, in metres.
const WORN: f64 = 8.0;
/// Platforms end within this distance of the shore, in metres.
const OUT: f64 = 1200.0;
/// Slope of debris that the sea does not take away: 33 degrees.
const TALUS: f64 = 0.65;

/// Distances from the shore on land and in the sea. Fronts carry the retreat of the shore, in metres, and its exposure.
pub(super) struct Profile {
    pub(super) land: Front,
    pub(super) sea: Front,
}

impl Profile {
    pub(super) fn new(law: &Coast, window: &Window, height: &[f32], shore: &Shore) -> Profile {
        let exposed = |cell: usize| super::retreat::mean_around(window, |at| shore.is_sea(at), &shore.exposure, cell);
        let worn = |cell: usize, d: f64| (f64::from(shore.origin[cell]) - d).max(0.0) as f32;
        let on_land = starts(&shore.beside, true, |cell, d| (d, [worn(cell, d), exposed(cell)]));
        let highest = height.iter().copied().filter(|height| height.is_finite()).fold(0.0, f32::max);
        let reach = window.cell + f64::from(highest) / TALUS.min(tangent(law));
        let land = march(window, on_land, |cell| !shore.is_sea(cell), |_, _| 1.0, reach);
        let mut in_sea = starts(&shore.beside, false, |cell, d| (d, [0.0, exposed(cell)]));
        for start in &mut in_sea {
            // The land beside a water cell knows how far the shore has moved.
            let around = neighbors(window, start.cell).into_iter().flatten().filter(|at| !shore.is_sea(*at));
            let (sum, count) = around.fold((0.0, 0.0), |(sum, count), at| (sum + land.carried[at][0], count + 1.0));
            start.carried[0] = if count > 0.0 { sum / count } else { 0.0 };
        }
        let sea = march(window, in_sea, |cell| shore.is_sea(cell), |_, _| 1.0, OUT);
        Profile { land, sea }
    }

    /// Height of a cell over the sea, worn by waves.
    pub(super) fn worn(&self, law: &Coast, cell_size: f64, shore: &Shore, height: &[f32], cell: usize) -> f32 {
        let old = height[cell];
        let (front, is_sea) = if shore.is_sea(cell) { (&self.sea, true) } else { (&self.land, false) };
        let [retreat, exposure] = front.carried[cell].map(f64::from);
        let distance = f64::from(front.time[cell]);
        // A shore that moved by less than a cell has a part of a platform.
        let part = (retreat / cell_size).min(1.0);
        if !distance.is_finite() || part < 1e-3 {
            return if is_sea { old.min(0.0) } else { old };
        }
        // Within a cell of the shore the profile is one plane, so that the shore lies where it should between samples.
        let (beside, beyond) = (distance.min(cell_size) / cell_size, (distance - cell_size).max(0.0));
        if is_sea {
            let fade = (1.0 - distance / OUT).max(0.0);
            let depth = (TIDE * beside + law.platform_slope * beyond).min(TIDE + WORN * exposure.min(1.0).sqrt());
            old.min((-depth * part * fade) as f32)
        } else {
            let steep = TALUS + (tangent(law) - TALUS) * (2.0 * exposure).clamp(0.0, 1.0);
            old.min(((TIDE * beside + steep * beyond) / part) as f32)
        }
    }
}

/// Slope of cliffs.
fn tangent(law: &Coast) -> f64 {
    libm::tan(law.cliff_angle.to_radians())
}
