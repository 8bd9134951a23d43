//! Height and distance of a cell above the stream that it drains to.

use super::accumulation::Accumulation;
use super::direction::DISTANCES;
use super::receivers::Receivers;
use crate::checks::{checks, never, now_and_then, steps};
use crate::error;
use crate::grid::Grid;
use crate::progress::Progress;

/// Position of each cell relative to the stream that it drains to.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct AboveDrainage {
    /// Height above nearest drainage, in the unit of the surface.
    pub height: Grid,
    /// Length of the flow path to the stream, in the unit of the cell size.
    pub distance: Grid,
}

/// Height above nearest drainage (Rennó and others, "HAND, a new terrain descriptor using SRTM-DEM", 2008; Nobre and
/// others 2011), and the length of the flow path. `surface` must fall along `receivers`. The path follows the receivers
/// to the first cell that drains at least `threshold` cells, or to the outlet if there is no such cell. Both layers are
/// 0 in streams and at outlets.
///
/// Holds 12 bytes per cell. Costs O(cells).
#[must_use]
pub fn above_drainage(surface: Grid, receivers: &Receivers, drained: &Accumulation, threshold: u32) -> AboveDrainage {
    let Ok(found) = walked(surface, receivers, drained, threshold, &never);
    found
}

/// [`above_drainage`] with progress and cancellation.
///
/// # Errors
/// If the work is cancelled.
pub fn above_drainage_with(
    surface: Grid,
    receivers: &Receivers,
    drained: &Accumulation,
    threshold: u32,
    progress: &Progress,
) -> error::Result<AboveDrainage> {
    walked(surface, receivers, drained, threshold, &steps(progress, checks(receivers.window().len())))
}

fn walked<E>(
    surface: Grid,
    receivers: &Receivers,
    drained: &Accumulation,
    threshold: u32,
    check: &impl Fn() -> Result<(), E>,
) -> Result<AboveDrainage, E> {
    let window = *surface.window();
    let mut distance = vec![0.0f64; window.len()];
    // First the heights of the streams, then the differences.
    let mut base = surface.data().to_vec();
    for (k, cell) in drained.downstream_first().enumerate() {
        now_and_then(k, check)?;
        let receiver = receivers.of(cell);
        if receiver != cell && drained.area.data()[cell] < threshold {
            base[cell] = base[receiver];
            distance[cell] = distance[receiver] + DISTANCES[usize::from(receivers.code(cell) & 7)] * window.cell;
        }
    }
    check()?;
    let mut height = surface;
    height.data_mut().iter_mut().zip(&base).for_each(|(height, base)| *height -= base);
    let metres = distance.into_iter().map(|metres| metres as f32).collect();
    let distance = Grid::from_data(window, metres).unwrap_or_else(|| Grid::filled(window, 0.0));
    Ok(AboveDrainage { height, distance })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::hydrology::accumulation::accumulate;
    use crate::hydrology::outlets::Outlets;
    use crate::hydrology::steepest::Descent;
    use crate::hydrology::{drainage, fill, samples};

    #[test]
    fn it_is_what_walking_downstream_finds() {
        for heights in samples::grids() {
            let outlets = Outlets::new(&heights, None);
            let drained = drainage::route_carving(&heights, &outlets, Descent::Steepest);
            let filled = fill::filled(&heights, &drained.basins);
            let areas = accumulate(&drained.receivers);
            for threshold in [1, 5, 40, u32::MAX] {
                let got = above_drainage(filled.clone(), &drained.receivers, &areas, threshold);
                for cell in 0..filled.data().len() {
                    let (mut at, mut way) = (cell, 0.0);
                    while areas.area.data()[at] < threshold && drained.receivers.of(at) != at {
                        way += DISTANCES[usize::from(drained.receivers.code(at) & 7)];
                        at = drained.receivers.of(at);
                    }
                    let above = filled.data()[cell] - filled.data()[at];
                    let (height, distance) = (got.height.data()[cell], got.distance.data()[cell]);
                    assert!(height == above || height.is_nan() && above.is_nan(), "{height} {above}");
                    assert!(height.is_nan() || height >= 0.0, "the filled surface never rises downstream");
                    assert!((f64::from(distance) - way).abs() <= 1e-5 * way, "{distance} {way}");
                }
            }
        }
    }
}
