//! Lakes: water in depressions.

use super::direction::{DISTANCES, neighbor, strides};
use super::drainage::Drainage;
use super::outlets::Outlets;
use crate::checks::{checks, never, now_and_then, steps};
use crate::error;
use crate::grid::Grid;
use crate::hydrology::accumulation::{Accumulation, accumulate, accumulate_with};
use crate::progress::Progress;

/// One lake.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Lake {
    /// Height of the water surface, in metres.
    pub level: f32,
    /// The deepest cell; the first in row order if there are several.
    pub deepest: u32,
    /// The dry cell over which the lake spills.
    pub outlet: u32,
    /// Number of cells.
    pub cells: u32,
}

impl Lake {
    /// A lake with this level, before its cells are counted.
    pub(crate) fn at(level: f32, deepest: u32) -> Lake {
        Lake { level, deepest, outlet: deepest, cells: 0 }
    }
}

/// The lakes of a map.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct Lakes {
    /// The lake of each cell, numbered from 1 in row order; 0 on land.
    pub labels: Grid<u32>,
    /// The lakes; the lake with label k is at index k - 1.
    pub lakes: Vec<Lake>,
    /// The ground, with depressions too small for a lake raised until they drain.
    pub bed: Grid,
    /// The water surface in lakes, and the bed elsewhere.
    pub surface: Grid,
}

/// Minimum slope of raised ground, rise over run, which is typical of sediment.
#[doc(hidden)]
pub const MIN_SLOPE: f64 = 1e-4;

/// Fills every depression of at least `fewest` cells with water up to its spill level, and fills smaller ones with
/// sediment.
///
/// `drainage` must come from [`route_carving`](super::drainage::route_carving) on the same heights. In the result every
/// land cell is higher than its receiver up to a lake's shore, the sea or the border, and every lake's outlet drains.
/// Costs O(cells).
#[must_use]
pub fn lakes(heights: &Grid, outlets: &Outlets, drainage: &Drainage, fewest: u32) -> Lakes {
    let Ok(mut found) = find(heights, drainage, fewest, &never);
    let Ok(()) = raise(&mut found, outlets, drainage, &accumulate(&drainage.receivers), &never);
    found
}

/// [`lakes`] with progress and cancellation.
///
/// # Errors
/// If the work is cancelled.
pub fn lakes_with(
    heights: &Grid,
    outlets: &Outlets,
    drainage: &Drainage,
    fewest: u32,
    progress: &Progress,
) -> error::Result<Lakes> {
    let pieces = checks(heights.window().len());
    let [finding, counting, raising] = progress.parts([1.0, 1.0, 1.0]);
    let mut found = find(heights, drainage, fewest, &steps(&finding, pieces))?;
    finding.finish();
    progress.check()?;
    let drained = accumulate_with(&drainage.receivers, &counting)?;
    counting.finish();
    progress.check()?;
    raise(&mut found, outlets, drainage, &drained, &steps(&raising, pieces))?;
    raising.finish();
    Ok(found)
}

/// Finds the connected cells under water. Adjacent cells under water have the same level, because otherwise the higher
/// water would drain.
fn find<E>(heights: &Grid, drainage: &Drainage, fewest: u32, check: &impl Fn() -> Result<(), E>) -> Result<Lakes, E> {
    let (h, basins) = (heights.data(), &drainage.basins);
    let under = |c: usize| h[c] < basins.spills[basins.labels[c] as usize].level;
    let strides = strides(heights.width());
    let mut labels = Grid::filled(*heights.window(), 0u32);
    let mut lakes = Vec::new();
    let mut seen = vec![false; h.len()];
    let mut cells = Vec::new();
    for start in 0..h.len() {
        now_and_then(start, check)?;
        if seen[start] || !under(start) {
            continue;
        }
        cells.clear();
        cells.push(start);
        seen[start] = true;
        let mut next = 0;
        while let Some(c) = cells.get(next).copied() {
            next += 1;
            // Cells under water are not outlets, so all their neighbors exist.
            for n in strides.map(|stride| neighbor(c, stride)) {
                if !seen[n] && under(n) {
                    seen[n] = true;
                    cells.push(n);
                }
            }
        }
        if (cells.len() as u64) < u64::from(fewest.max(1)) {
            continue;
        }
        let label = lakes.len() as u32 + 1;
        cells.iter().for_each(|c| labels.data_mut()[*c] = label);
        let deepest =
            cells.iter().copied().fold(start, |best, c| match h[c] < h[best] || h[c] == h[best] && c < best {
                true => c,
                false => best,
            });
        let mut outlet = deepest;
        while labels.data()[outlet] == label {
            outlet = drainage.receivers.of(outlet);
        }
        let level = basins.spills[basins.labels[start] as usize].level;
        lakes.push(Lake { level, deepest: deepest as u32, outlet: outlet as u32, cells: cells.len() as u32 });
    }
    Ok(Lakes { labels, lakes, bed: heights.clone(), surface: heights.clone() })
}

/// Raises land above its receiver and lakes to the level of their outlet, from the outlets upstream.
fn raise<E>(
    found: &mut Lakes,
    outlets: &Outlets,
    drainage: &Drainage,
    drained: &Accumulation,
    check: &impl Fn() -> Result<(), E>,
) -> Result<(), E> {
    let cell = found.bed.window().cell;
    let (bed, surface) = (found.bed.data_mut(), found.surface.data_mut());
    for (k, c) in drained.downstream_first().enumerate() {
        now_and_then(k, check)?;
        let label = found.labels.data()[c];
        if let Some(lake) = label.checked_sub(1).and_then(|k| found.lakes.get_mut(k as usize)) {
            lake.level = surface[lake.outlet as usize].max(lake.level);
            surface[c] = lake.level;
        } else if !outlets.at(c) {
            let below = surface[drainage.receivers.of(c)];
            let rise = DISTANCES[usize::from(drainage.receivers.code(c) & 7)] * cell * MIN_SLOPE;
            let least = (f64::from(below) + rise) as f32;
            // In f32 the minimum rise may be rounded away, but the cell must drain. Dry ground that is higher than its
            // receiver is unchanged.
            if bed[c] <= below {
                bed[c] = if least > below { least } else { below.next_up() };
            }
            surface[c] = bed[c];
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::grid::Window;
    use crate::hydrology::direction::NONE;
    use crate::hydrology::steepest::{self, Descent};
    use crate::hydrology::{drainage, samples};

    fn made(heights: &Grid, fewest: u32) -> (Outlets, Lakes) {
        let outlets = Outlets::new(heights, Some(100.0));
        let drainage = drainage::route_carving(heights, &outlets, Descent::Steepest);
        let lakes = lakes(heights, &outlets, &drainage, fewest);
        (outlets, lakes)
    }

    #[test]
    fn land_drains_to_the_sea_the_border_or_a_lake() {
        for heights in samples::grids() {
            for fewest in [1, 4, 25, u32::MAX] {
                let (outlets, lakes) = made(&heights, fewest);
                let receivers = steepest::receivers(&lakes.surface, &outlets, Descent::Steepest);
                for c in 0..heights.data().len() {
                    let lake = lakes.labels.data()[c];
                    assert!(outlets.at(c) || lake > 0 || receivers.code(c) != NONE, "cell {c}");
                    if lake == 0 && !outlets.at(c) {
                        assert!(lakes.bed.data()[c] >= heights.data()[c]);
                    } else {
                        assert_eq!(lakes.bed.data()[c].to_bits(), heights.data()[c].to_bits());
                    }
                }
                let mut cells = vec![0u32; lakes.lakes.len() + 1];
                lakes.labels.data().iter().for_each(|label| cells[*label as usize] += 1);
                for (k, lake) in lakes.lakes.iter().enumerate() {
                    assert!(lake.cells >= fewest && lake.cells == cells[k + 1]);
                    let outlet = lake.outlet as usize;
                    assert_eq!(lakes.surface.data()[lake.deepest as usize], lake.level);
                    assert!(lakes.surface.data()[outlet] <= lake.level, "water can leave");
                    assert_ne!(lakes.labels.data()[outlet], k as u32 + 1);
                }
            }
        }
    }

    #[test]
    fn two_bowls_one_too_small() {
        let mut heights = Grid::filled(Window::new(14, 8, 10.0), 200.0);
        for j in 2..5 {
            heights.row_mut(j)[2..6].fill(150.0);
        }
        heights.row_mut(3)[3] = 140.0;
        heights.row_mut(3)[1] = 170.0;
        heights.row_mut(3)[0] = 160.0;
        heights.row_mut(5)[10] = 190.0;
        let (_, lakes) = made(&heights, 4);
        let expect = Lake { level: 170.0, deepest: 3 * 14 + 3, outlet: 3 * 14 + 1, cells: 12 };
        assert_eq!(lakes.lakes, [expect]);
        assert_eq!(lakes.surface[(4, 4)], 170.0);
        assert_eq!(lakes.bed[(3, 3)], 140.0);
        assert!(lakes.bed[(10, 5)] > 200.0 && lakes.bed[(10, 5)] < 201.0);
    }
}
