//! Watersheds: the cells that drain to one outlet.

use super::accumulation::Accumulation;
use super::outlets::Outlets;
use super::receivers::Receivers;
use crate::checks::{checks, never, now_and_then, steps};
use crate::error;
use crate::grid::Grid;
use crate::progress::Progress;

/// The watershed of every cell, numbered from 1 in row order of the outlets. Outlets that drain only themselves, such
/// as the sea, have 0. The time is O(cells).
#[must_use]
pub fn watersheds(receivers: &Receivers, outlets: &Outlets, accumulation: &Accumulation) -> Grid<u32> {
    let Ok(labels) = labeled(receivers, outlets, accumulation, &never);
    labels
}

/// [`watersheds`] with progress and cancellation.
///
/// # Errors
/// If the work is cancelled.
pub fn watersheds_with(
    receivers: &Receivers,
    outlets: &Outlets,
    accumulation: &Accumulation,
    progress: &Progress,
) -> error::Result<Grid<u32>> {
    labeled(receivers, outlets, accumulation, &steps(progress, 2 * checks(receivers.window().len())))
}

fn labeled<E>(
    receivers: &Receivers,
    outlets: &Outlets,
    accumulation: &Accumulation,
    check: &impl Fn() -> Result<(), E>,
) -> Result<Grid<u32>, E> {
    let mut labels = Grid::filled(*receivers.window(), 0u32);
    let mut count = 0;
    for (cell, area) in accumulation.area.data().iter().enumerate() {
        now_and_then(cell, check)?;
        if outlets.at(cell) && *area > 1 {
            count += 1;
            labels.data_mut()[cell] = count;
        }
    }
    for (k, cell) in accumulation.downstream_first().enumerate() {
        now_and_then(k, check)?;
        let receiver = receivers.of(cell);
        if receiver != cell {
            labels.data_mut()[cell] = labels.data()[receiver];
        }
    }
    Ok(labels)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::hydrology::accumulation::accumulate;
    use crate::hydrology::steepest::Descent;
    use crate::hydrology::{drainage, samples};

    #[test]
    fn a_label_is_one_outlet_and_its_area() {
        for heights in samples::grids() {
            let outlets = Outlets::new(&heights, None);
            let receivers = drainage::route_carving(&heights, &outlets, Descent::Steepest).receivers;
            let accumulation = accumulate(&receivers);
            let labels = watersheds(&receivers, &outlets, &accumulation);
            let count = labels.data().iter().copied().max().unwrap_or(0);
            let mut cells = vec![0u32; count as usize + 1];
            labels.data().iter().for_each(|label| cells[*label as usize] += 1);
            let mut ends = vec![0u32; count as usize + 1];
            for c in (0..labels.data().len()).filter(|c| outlets.at(*c)) {
                let (label, area) = (labels.data()[c] as usize, accumulation.area.data()[c]);
                ends[label] += 1;
                assert_eq!(label == 0, area == 1);
                assert!(label == 0 || cells[label] == area);
            }
            assert!(ends[1..].iter().all(|n| *n == 1));
            for c in 0..labels.data().len() {
                assert_eq!(labels.data()[c], labels.data()[receivers.of(c)]);
            }
        }
    }
}
