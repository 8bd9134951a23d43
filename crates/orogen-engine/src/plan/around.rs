//! The samples of one lattice around the samples of another.

use orogen_grid::grid::{FARTHEST, Window};
use orogen_grid::resample::split;

/// Samples that the interpolating cubic reads around a position.
const MARGIN: i64 = 2;

/// The samples at cell `cell` from which a window is read: the window itself if the cells are equal, otherwise the
/// samples around it, which are interpolated.
#[must_use]
pub fn samples_around(window: &Window, cell: f64) -> Window {
    if cell == window.cell || window.is_empty() {
        return Window { cell, ..*window };
    }
    let span = |first: f64, last: f64| {
        // A window beyond any lattice is refused later; here it must only not overflow.
        let [start, end] = [first, last].map(|at| split(at, cell).0.clamp(-FARTHEST, FARTHEST));
        let (start, end) = (start - MARGIN, end + 1 + MARGIN);
        (start, (end - start + 1).max(0) as usize)
    };
    let (x, width) = span(window.east(0), window.east(window.width - 1));
    let (y, height) = span(window.south(0), window.south(window.height - 1));
    Window { x, y, width, height, cell }
}
