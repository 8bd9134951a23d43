//! Breaching: draining depressions with channels.

use super::accumulation::{Accumulation, accumulate, accumulate_with};
use super::drainage::Drainage;
use super::fill::filled;
use super::outlets::Outlets;
use crate::checks::{checks, never, now_and_then, steps};
use crate::error;
use crate::grid::Grid;
use crate::progress::Progress;

/// The heights without depressions. A channel along the path of `drainage` drains each depression. The channel is at
/// most `deepest` metres deep; the part of a depression below it is filled first (after Lindsay 2016, "Efficient hybrid
/// breaching-filling sink removal methods for flow path enforcement in digital elevation models"). `deepest` = 0 only
/// fills, infinity only cuts.
///
/// In the result no receiver of `drainage` is higher than its donor. Outlets keep their heights. Costs O(cells).
#[must_use]
pub fn breach(heights: &Grid, outlets: &Outlets, drainage: &Drainage, deepest: f32) -> Grid {
    let mut out = drained(heights, drainage, deepest);
    let Ok(()) = cut(&mut out, outlets, drainage, &accumulate(&drainage.receivers), &never);
    out
}

/// [`breach`] with progress and cancellation.
///
/// # Errors
/// If the work is cancelled.
pub fn breach_with(
    heights: &Grid,
    outlets: &Outlets,
    drainage: &Drainage,
    deepest: f32,
    progress: &Progress,
) -> error::Result<Grid> {
    let [filling, counting, cutting] = progress.parts([1.0, 2.0, 2.0]);
    let mut out = drained(heights, drainage, deepest);
    filling.finish();
    let accumulation = accumulate_with(&drainage.receivers, &counting)?;
    counting.finish();
    let check = steps(&cutting, checks(heights.window().len()));
    cut(&mut out, outlets, drainage, &accumulation, &check)?;
    cutting.finish();
    Ok(out)
}

/// The heights with depressions filled up to the level to which the cuts drain them.
fn drained(heights: &Grid, drainage: &Drainage, deepest: f32) -> Grid {
    let mut out = filled(heights, &drainage.basins);
    for ((level, h), label) in out.data_mut().iter_mut().zip(heights.data()).zip(&drainage.basins.labels) {
        // The level down to which a cut of the maximum depth through the pass drains the basin.
        let drained = drainage.basins.spills[*label as usize].level - deepest;
        *level = if drained > *h { drained.min(*level) } else { *h };
    }
    out
}

/// Lowers each receiver to the height of its donors.
fn cut<E>(
    heights: &mut Grid,
    outlets: &Outlets,
    drainage: &Drainage,
    accumulation: &Accumulation,
    check: &impl Fn() -> Result<(), E>,
) -> Result<(), E> {
    let receivers = &drainage.receivers;
    let h = heights.data_mut();
    for (k, cell) in accumulation.upstream_first().enumerate() {
        now_and_then(k, check)?;
        let receiver = receivers.of(cell);
        if h[cell] < h[receiver] && !outlets.at(receiver) {
            h[receiver] = h[cell];
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::grid::Window;
    use crate::hydrology::steepest::Descent;
    use crate::hydrology::{drainage, samples};

    #[test]
    fn no_depression_is_left_and_no_cut_is_too_deep() {
        for heights in samples::grids() {
            for deepest in [0.0, 20.0, 150.0, f32::INFINITY] {
                let outlets = Outlets::new(&heights, None);
                let drainage = drainage::route_carving(&heights, &outlets, Descent::Steepest);
                let filled = filled(&heights, &drainage.basins);
                let out = breach(&heights, &outlets, &drainage, deepest);
                for c in (0..out.data().len()).filter(|c| !outlets.at(*c)) {
                    let (new, old, full) = (out.data()[c], heights.data()[c], filled.data()[c]);
                    assert!(new <= full && old - new <= deepest + 1e-3, "{old} to {new}, filled {full}");
                    assert!(deepest > 0.0 || new == full);
                    assert!(deepest < f32::INFINITY || new <= old, "only cut");
                    let receiver = drainage.receivers.of(c);
                    // An outlet is not lowered, so a pond remains where a channel ends below it.
                    assert!(outlets.at(receiver) || out.data()[receiver] <= new);
                }
            }
        }
    }

    #[test]
    fn a_dam_is_cut_through() {
        let mut heights = Grid::filled(Window::new(9, 5, 1.0), 9.0);
        heights.row_mut(2).copy_from_slice(&[9.0, 3.0, 2.0, 3.0, 6.0, 4.0, 1.0, 0.5, 0.0]);
        let outlets = Outlets::new(&heights, None);
        let drainage = drainage::route_carving(&heights, &outlets, Descent::Steepest);
        let cut = breach(&heights, &outlets, &drainage, f32::INFINITY);
        assert_eq!(cut.row(2), [9.0, 3.0, 2.0, 2.0, 2.0, 2.0, 1.0, 0.5, 0.0]);
        let both = breach(&heights, &outlets, &drainage, 1.5);
        assert_eq!(both.row(2), [9.0, 4.5, 4.5, 4.5, 4.5, 4.0, 1.0, 0.5, 0.0]);
    }
}
