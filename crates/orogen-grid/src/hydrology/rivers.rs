//! Rivers as lines, with discharge and width.

use super::accumulation::Accumulation;
use super::receivers::Receivers;
use crate::checks::{checks, never, now_and_then, steps};
use crate::error;
use crate::grid::Grid;
use crate::progress::Progress;
use serde::{Deserialize, Serialize};

/// A stretch of a river between confluences.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct Reach {
    /// The cells of the reach, downstream. The last one is the first cell of the next reach, or the outlet.
    pub cells: Vec<u32>,
    /// Strahler order.
    pub order: u8,
    /// The index of the reach that it flows into; `None` at an outlet.
    pub next: Option<u32>,
}

/// Converts drainage area to discharge, and discharge to the width and depth of a channel (Leopold and Maddock 1953: w
/// = a Q^0.5, d = c Q^0.4, with Q in m^3/s).
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Channel {
    /// Runoff, in metres per year.
    pub runoff: f64,
    /// a: the width of a river with 1 m^3/s, in metres.
    pub width: f64,
    /// c: the depth of a river with 1 m^3/s, in metres.
    pub depth: f64,
}

impl Default for Channel {
    /// The defaults of the op `rivers`: runoff 0.5 m per year, width 5 m, depth 0.3 m.
    fn default() -> Channel {
        Channel { runoff: 0.5, width: 5.0, depth: 0.3 }
    }
}

orogen_noise::builder!(Channel: with_runoff(runoff: f64), with_width(width: f64), with_depth(depth: f64));

/// Seconds in a year of 365.25 days.
const YEAR: f64 = 31_557_600.0;

impl Channel {
    /// The discharge, in m^3/s, of a drainage area in m^2.
    #[must_use]
    pub fn discharge(&self, area: f64) -> f64 {
        area * self.runoff / YEAR
    }

    /// Width between the banks in metres, for a discharge in m^3/s.
    #[must_use]
    pub fn width_of(&self, discharge: f64) -> f64 {
        self.width * discharge.max(0.0).sqrt()
    }

    /// Depth from bank to bed in metres, for a discharge in m^3/s.
    #[must_use]
    pub fn depth_of(&self, discharge: f64) -> f64 {
        self.depth * libm::pow(discharge.max(0.0), 0.4)
    }
}

/// The network of all cells with an order above 0 (see [`strahler_orders`](super::strahler::strahler_orders)). Reaches
/// run from a source or confluence to the next confluence or outlet, in row order of their first cells. The time is
/// O(cells).
#[must_use]
pub fn network(receivers: &Receivers, orders: &Grid<u8>) -> Vec<Reach> {
    let mut streams = Streams::default();
    for (cell, order) in orders.data().iter().enumerate().filter(|(_, order)| **order > 0) {
        streams.push(cell as u32, receivers.of(cell) as u32, *order);
    }
    streams.network()
}

/// The river cells of a map, in row order.
#[derive(Debug, Clone, Default)]
pub struct Streams {
    cells: Vec<u32>,
    receivers: Vec<u32>,
    orders: Vec<u8>,
}

/// Memory per river cell, in bytes, while [`Streams`] and its reaches are computed.
pub const STREAM_CELL: u64 = 40;

impl Streams {
    /// Adds the next cell in row order, its receiver (itself if there is none) and its order.
    pub fn push(&mut self, cell: u32, receiver: u32, order: u8) {
        self.cells.push(cell);
        self.receivers.push(receiver);
        self.orders.push(order);
    }

    /// The reaches, in row order of their first cells.
    #[must_use]
    pub fn network(mut self) -> Vec<Reach> {
        // Receivers as indices into the list. A cell whose receiver is not in the list is its own receiver.
        for k in 0..self.cells.len() {
            self.receivers[k] = self.cells.binary_search(&self.receivers[k]).unwrap_or(k) as u32;
        }
        let mut inflows = vec![0u8; self.cells.len()];
        for (_, receiver) in self.receivers.iter().enumerate().filter(|(k, receiver)| **receiver as usize != *k) {
            inflows[*receiver as usize] += 1;
        }
        // A reach starts at a source or a confluence.
        let starts: Vec<usize> = (0..self.cells.len()).filter(|k| inflows[*k] != 1).collect();
        let mut reaches = Vec::with_capacity(starts.len());
        for start in &starts {
            let mut cells = vec![self.cells[*start]];
            let mut at = *start;
            let end = loop {
                let receiver = self.receivers[at] as usize;
                if receiver == at {
                    break None;
                }
                cells.push(self.cells[receiver]);
                if inflows[receiver] != 1 {
                    break Some(receiver);
                }
                at = receiver;
            };
            cells.shrink_to_fit();
            let next = end.and_then(|end| starts.binary_search(&end).ok()).map(|k| k as u32);
            reaches.push(Reach { cells, order: self.orders[*start], next });
        }
        reaches
    }
}

/// Cuts river beds to the depth of their discharge into ground on which no receiver is higher than its donor. The
/// drainage area never decreases downstream, so beds never rise downstream. Cells of order 0 and outlets keep their
/// heights.
pub fn carve(heights: &mut Grid, receivers: &Receivers, drained: &Accumulation, orders: &Grid<u8>, channel: &Channel) {
    let Ok(()) = cut(heights, receivers, drained, orders, channel, &never);
}

/// [`carve`] with progress and cancellation.
///
/// # Errors
/// If the work is cancelled.
pub fn carve_with(
    heights: &mut Grid,
    receivers: &Receivers,
    drained: &Accumulation,
    orders: &Grid<u8>,
    channel: &Channel,
    progress: &Progress,
) -> error::Result<()> {
    let check = steps(progress, checks(heights.window().len()));
    cut(heights, receivers, drained, orders, channel, &check)
}

fn cut<E>(
    heights: &mut Grid,
    receivers: &Receivers,
    drained: &Accumulation,
    orders: &Grid<u8>,
    channel: &Channel,
    check: &impl Fn() -> Result<(), E>,
) -> Result<(), E> {
    let cell_area = heights.window().cell * heights.window().cell;
    for (c, h) in heights.data_mut().iter_mut().enumerate() {
        now_and_then(c, check)?;
        if orders.data()[c] > 0 && receivers.of(c) != c {
            let discharge = channel.discharge(f64::from(drained.area.data()[c]) * cell_area);
            *h = (f64::from(*h) - channel.depth_of(discharge)) as f32;
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::hydrology::accumulation::accumulate;
    use crate::hydrology::outlets::Outlets;
    use crate::hydrology::steepest::Descent;
    use crate::hydrology::{breach, drainage, samples, strahler};

    const CHANNEL: Channel = Channel { runoff: 0.5, width: 5.0, depth: 0.3 };

    #[test]
    fn reaches_cover_the_rivers_once_and_join() {
        for heights in samples::grids() {
            let receivers =
                drainage::route_carving(&heights, &Outlets::new(&heights, None), Descent::Steepest).receivers;
            let drained = accumulate(&receivers);
            let orders = strahler::strahler_orders(&receivers, &drained, 5);
            let reaches = network(&receivers, &orders);
            let mut covered = vec![0u32; orders.data().len()];
            for reach in &reaches {
                for pair in reach.cells.windows(2) {
                    assert_eq!(receivers.of(pair[0] as usize), pair[1] as usize);
                }
                let last = reach.cells[reach.cells.len() - 1];
                match reach.next {
                    Some(next) => {
                        assert_eq!(reaches[next as usize].cells[0], last);
                        assert!(reaches[next as usize].order >= reach.order);
                        reach.cells[..reach.cells.len() - 1].iter().for_each(|c| covered[*c as usize] += 1);
                    }
                    None => {
                        assert_eq!(receivers.of(last as usize), last as usize);
                        reach.cells.iter().for_each(|c| covered[*c as usize] += 1);
                    }
                }
            }
            for (c, count) in covered.iter().enumerate() {
                assert_eq!(*count, u32::from(orders.data()[c] > 0), "cell {c}");
            }
        }
    }

    #[test]
    fn beds_never_rise_downstream() {
        for heights in samples::grids() {
            let outlets = Outlets::new(&heights, None);
            let drainage = drainage::route_carving(&heights, &outlets, Descent::Steepest);
            let mut ground = breach(&heights, &outlets, &drainage, 30.0);
            let drained = accumulate(&drainage.receivers);
            let orders = strahler::strahler_orders(&drainage.receivers, &drained, 5);
            let before = ground.clone();
            carve(&mut ground, &drainage.receivers, &drained, &orders, &CHANNEL);
            for c in (0..ground.data().len()).filter(|c| !outlets.at(*c)) {
                let receiver = drainage.receivers.of(c);
                assert!(outlets.at(receiver) || ground.data()[receiver] <= ground.data()[c]);
                assert_eq!(ground.data()[c] < before.data()[c], orders.data()[c] > 0);
            }
        }
    }

    #[test]
    fn a_large_river_has_the_measures_of_one() {
        // The Rhine at Basel: 36 000 km^2, about 1000 m^3/s, about 200 m wide.
        let discharge = Channel { runoff: 0.9, width: 5.0, depth: 0.3 }.discharge(36e9);
        assert!((discharge - 1000.0).abs() < 50.0, "{discharge}");
        assert!((CHANNEL.width_of(discharge) - 160.0).abs() < 10.0);
        assert!((CHANNEL.depth_of(discharge) - 4.8).abs() < 0.3);
        assert_eq!(CHANNEL.width_of(0.0), 0.0);
    }
}
