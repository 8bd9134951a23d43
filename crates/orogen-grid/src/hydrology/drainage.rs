//! Drainage of every cell, including cells in depressions.

use super::basins::{Basins, Spill, find_basins};
use super::direction::{neighbor, opposite, strides};
use super::flats;
use super::outlets::Outlets;
use super::receivers::Receivers;
use super::steepest::{self, Descent};
use crate::error::Result;
use crate::grid::Grid;
use crate::progress::Progress;
use std::convert::Infallible;

/// Receivers that lead from every cell to an outlet.
#[derive(Debug, Clone)]
pub struct Drainage {
    /// Free of cycles. Only outlets have [`NONE`](super::direction::NONE).
    pub receivers: Receivers,
    /// The basins before the drainage was routed out of them.
    pub basins: Basins,
}

/// Drainage along the terrain, also below the water of lakes. Each cell drains to its steepest lower neighbor. In a
/// depression this leads to the pit. The path from the pass down to the pit is then reversed, so that water flows from
/// the pit to the pass and out (carving; Cordonnier, Bovy and Braun 2019).
///
/// The drainage of a lake's bed therefore follows its valleys. On a filled surface the directions on level water would
/// be arbitrary.
#[must_use]
pub fn route_carving(heights: &Grid, outlets: &Outlets, descent: Descent) -> Drainage {
    let Ok(drainage) = route_bed(heights, outlets, descent, || Ok::<(), Infallible>(()));
    drainage
}

/// [`route_carving`] with progress and cancellation.
///
/// # Errors
/// If the work is cancelled.
pub fn route_carving_with(
    heights: &Grid,
    outlets: &Outlets,
    descent: Descent,
    progress: &Progress,
) -> Result<Drainage> {
    progress.expect(PHASES);
    route_bed(heights, outlets, descent, || {
        progress.advance(1.0);
        progress.check()
    })
}

/// [`route_carving_with`], but depressions that are deeper than `depth` below their pass keep their water: their pits
/// have no receiver.
///
/// # Errors
/// If the work is cancelled.
pub(super) fn route_shallow_with(
    heights: &Grid,
    outlets: &Outlets,
    depth: f32,
    progress: &Progress,
) -> Result<Receivers> {
    progress.expect(PHASES);
    let mut phase = || {
        progress.advance(1.0);
        progress.check()
    };
    let mut receivers = over_surface(heights, outlets, Descent::Steepest);
    phase()?;
    let basins = find_basins(heights, outlets, &receivers, &mut phase)?;
    let (h, strides) = (heights.data(), strides(heights.width()));
    for spill in basins.order.iter().map(|basin| &basins.spills[*basin as usize]) {
        let next = neighbor(spill.last as usize, strides[usize::from(spill.code)]);
        if h[spill.last as usize].max(h[next]) - h[spill.pit as usize] <= depth {
            lead_out(spill, &mut receivers);
        }
    }
    Ok(receivers)
}

/// Number of phases that [`route_bed`] reports.
const PHASES: f64 = 6.0;

/// [`route_carving`]; `phase` is called after each phase, and its error ends the work.
fn route_bed<E>(
    heights: &Grid,
    outlets: &Outlets,
    descent: Descent,
    mut phase: impl FnMut() -> std::result::Result<(), E>,
) -> std::result::Result<Drainage, E> {
    let mut receivers = steepest::receivers(heights, outlets, descent);
    phase()?;
    flats::resolve(heights, outlets, &mut receivers);
    phase()?;
    let basins = find_basins(heights, outlets, &receivers, &mut phase)?;
    for basin in &basins.order {
        lead_out(&basins.spills[*basin as usize], &mut receivers);
    }
    phase()?;
    Ok(Drainage { receivers, basins })
}

/// Reverses the path from the pass to the pit.
fn lead_out(way: &Spill, receivers: &mut Receivers) {
    let (mut cell, mut code) = (way.last as usize, way.code);
    loop {
        let next = receivers.of(cell);
        let was = std::mem::replace(&mut receivers.codes_mut()[cell], code);
        if next == cell {
            return;
        }
        (cell, code) = (next, opposite(was));
    }
}

/// Drainage of a surface without depressions, such as [`filled`](super::fill::filled) heights: steepest descent on
/// slopes, and [`flats::resolve`] on level ground.
#[must_use]
pub fn over_surface(filled: &Grid, outlets: &Outlets, descent: Descent) -> Receivers {
    let mut receivers = steepest::receivers(filled, outlets, descent);
    flats::resolve(filled, outlets, &mut receivers);
    receivers
}

/// [`over_surface`] with progress and cancellation.
///
/// # Errors
/// If the work is cancelled.
pub fn over_surface_with(filled: &Grid, outlets: &Outlets, descent: Descent, progress: &Progress) -> Result<Receivers> {
    let [falling, resolving] = progress.parts([1.0, 1.0]);
    let mut receivers = steepest::receivers(filled, outlets, descent);
    falling.finish();
    progress.check()?;
    flats::resolve(filled, outlets, &mut receivers);
    resolving.finish();
    progress.check()?;
    Ok(receivers)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::hydrology::direction::NONE;
    use crate::hydrology::{fill, samples};

    /// Returns the outlet of each cell.
    fn ends(receivers: &Receivers, outlets: &Outlets) -> Vec<usize> {
        let end = |start: usize| {
            let mut at = start;
            for _ in 0..receivers.codes().len() {
                at = receivers.of(at);
            }
            assert!(outlets.at(at) && receivers.code(at) == NONE, "from {start} to {at}");
            at
        };
        (0..receivers.codes().len()).map(end).collect()
    }

    #[test]
    fn every_cell_leads_to_an_outlet() {
        for (k, heights) in samples::grids().into_iter().enumerate() {
            let outlets = Outlets::new(&heights, Some(2.0));
            let descent = if k % 2 == 0 { Descent::Steepest } else { Descent::Scattered(k as u32) };
            ends(&route_carving(&heights, &outlets, descent).receivers, &outlets);
            let filled = fill(&heights, &outlets);
            ends(&over_surface(&filled, &outlets, descent), &outlets);
        }
    }

    #[test]
    fn nothing_on_the_way_is_higher_than_the_water() {
        for heights in samples::grids() {
            let outlets = Outlets::new(&heights, None);
            let drainage = route_carving(&heights, &outlets, Descent::Steepest);
            let filled = fill::filled(&heights, &drainage.basins);
            for c in 0..heights.data().len() {
                let receiver = drainage.receivers.of(c);
                assert!(outlets.at(c) || filled.data()[receiver] <= filled.data()[c]);
            }
        }
    }

    #[test]
    fn without_depressions_both_are_the_steepest_descent() {
        let mut cone = Grid::filled(crate::grid::Window::new(31, 31, 1.0), 0.0);
        for j in 0..31 {
            for i in 0..31 {
                let (x, y) = (i as f32 - 14.3, j as f32 - 15.8);
                cone.row_mut(j)[i] = -(x * x + y * y).sqrt();
            }
        }
        let outlets = Outlets::new(&cone, None);
        let steepest = steepest::receivers(&cone, &outlets, Descent::Steepest);
        assert_eq!(route_carving(&cone, &outlets, Descent::Steepest).receivers, steepest);
        assert_eq!(over_surface(&cone, &outlets, Descent::Steepest), steepest);
    }
}
