//! Strahler order of streams.

use super::accumulation::{Accumulation, UNIT_WEIGHT};
use super::receivers::Receivers;
use crate::checks::{checks, never, now_and_then, steps};
use crate::error;
use crate::grid::Grid;
use crate::progress::Progress;

/// The order of the stream through each cell (Strahler 1957). A source has order 1. The order increases by 1 where at
/// least two inflows have the highest order. A cell that drains fewer than `threshold` cells is not a stream and has
/// order 0; cells are weighted by the rain if the accumulation has a discharge.
///
/// Costs O(cells).
#[must_use]
pub fn strahler_orders(receivers: &Receivers, accumulation: &Accumulation, threshold: u32) -> Grid<u8> {
    let Ok(orders) = ordered(receivers, accumulation, threshold, &never);
    orders
}

/// [`strahler_orders`] with progress and cancellation.
///
/// # Errors
/// If the work is cancelled.
pub fn strahler_orders_with(
    receivers: &Receivers,
    accumulation: &Accumulation,
    threshold: u32,
    progress: &Progress,
) -> error::Result<Grid<u8>> {
    ordered(receivers, accumulation, threshold, &steps(progress, checks(receivers.window().len())))
}

fn ordered<E>(
    receivers: &Receivers,
    accumulation: &Accumulation,
    threshold: u32,
    check: &impl Fn() -> Result<(), E>,
) -> Result<Grid<u8>, E> {
    let area = accumulation.area.data();
    let discharge = accumulation.discharge.as_ref().map(Grid::data);
    let least_discharge = u64::from(threshold) * u64::from(UNIT_WEIGHT);
    let is_stream = |cell: usize| match discharge {
        Some(discharge) => discharge[cell] >= least_discharge,
        None => area[cell] >= threshold,
    };
    let mut orders = Grid::filled(*receivers.window(), 0u8);
    // Whether at least two inflows have the highest order so far.
    let mut met = vec![false; area.len()];
    for (k, cell) in accumulation.upstream_first().enumerate() {
        now_and_then(k, check)?;
        if !is_stream(cell) {
            continue;
        }
        let out = orders.data_mut();
        out[cell] = (out[cell] + u8::from(met[cell])).max(1);
        let (order, receiver) = (out[cell], receivers.of(cell));
        if receiver != cell {
            met[receiver] = (met[receiver] && out[receiver] >= order) || out[receiver] == order;
            out[receiver] = out[receiver].max(order);
        }
    }
    Ok(orders)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::hydrology::accumulation::accumulate;
    use crate::hydrology::outlets::Outlets;
    use crate::hydrology::steepest::Descent;
    use crate::hydrology::{drainage, samples};

    #[test]
    fn orders_follow_from_the_inflows() {
        for heights in samples::grids() {
            let receivers =
                drainage::route_carving(&heights, &Outlets::new(&heights, None), Descent::Steepest).receivers;
            let accumulation = accumulate(&receivers);
            for threshold in [1, 4, 20] {
                let orders = strahler_orders(&receivers, &accumulation, threshold);
                for c in 0..orders.data().len() {
                    let mut inflows: Vec<u8> = (0..orders.data().len())
                        .filter(|d| *d != c && receivers.of(*d) == c && orders.data()[*d] > 0)
                        .map(|d| orders.data()[d])
                        .collect();
                    inflows.sort_unstable();
                    let expect = match inflows[..] {
                        _ if accumulation.area.data()[c] < threshold => 0,
                        [.., a, b] if a == b => b + 1,
                        [.., b] => b,
                        [] => 1,
                    };
                    assert_eq!(orders.data()[c], expect, "cell {c}, flowing in: {inflows:?}");
                }
            }
        }
    }
}
