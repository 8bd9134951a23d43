//! Fetch: the distance over water to the next land, or to a maximum, for each direction of the wind.

use crate::grid::Window;

/// Directions whose fetch is in memory at a time.
pub(super) const TOGETHER: usize = 4;

/// Share of the fetch that comes from beside the line along the wind, for each step.
const SPREAD: f32 = 0.2;

/// Fetch of all cells along one direction, by one sweep from the side that the wind comes from.
///
/// The fetch of a water cell is one step more than that upwind of it, between two cells of the row before. So fetches
/// are mixed across the wind over long ways, as waves are by spreading and diffraction. The sea outside the window is
/// open.
pub(super) fn sweep(water: &[bool], window: &Window, from: [f64; 2], longest: f32) -> Vec<f32> {
    let (width, height) = (window.width, window.height);
    let by_rows = from[1].abs() >= from[0].abs();
    // The sweep advances along the axis that is closer to the wind.
    let (lines, along, line_stride, stride) =
        if by_rows { (height, width, width, 1) } else { (width, height, 1, width) };
    let [major, minor] = if by_rows { [from[1], from[0]] } else { from };
    let step = (window.cell / major.abs()) as f32;
    let shift = minor / major.abs();
    let offset = shift.floor() as isize;
    let part = (shift - shift.floor()) as f32;
    let mut fetch = vec![0.0; water.len()];
    let mut before = vec![longest; along];
    let mut now = vec![0.0; along];
    for k in 0..lines {
        let line = if major > 0.0 { lines - 1 - k } else { k };
        let upwind = |at: isize| usize::try_from(at).ok().and_then(|at| before.get(at)).copied().unwrap_or(longest);
        for (i, value) in now.iter_mut().enumerate() {
            let cell = line * line_stride + i * stride;
            if water[cell] {
                let at = i as isize + offset;
                let [w, a, b, e] = [-1, 0, 1, 2].map(|by| upwind(at + by));
                let ahead = a + part * (b - a);
                let beside = 0.5 * (w + part * (a - w) + b + part * (e - b));
                *value = (ahead + SPREAD * (beside - ahead) + step).min(longest);
                fetch[cell] = *value;
            } else {
                *value = 0.0;
            }
        }
        std::mem::swap(&mut before, &mut now);
    }
    fetch
}
