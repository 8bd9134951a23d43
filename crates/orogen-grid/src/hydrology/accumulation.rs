//! Flow accumulation: the area that drains through each cell.

use super::direction::{neighbor, strides};
use super::receivers::Receivers;
use crate::checks::{checks, never, now_and_then, steps};
use crate::grid::Grid;
use crate::progress::Progress;
use crate::{error, parallel};
use std::ops::Range;

/// The weight of a cell where the rain factor is 1. Weights are integers, so that their sums do not depend on the order
/// of addition.
pub const UNIT_WEIGHT: u32 = 1 << 16;

/// The weight of a cell for a rain factor, which is clamped to 0.01 ..= 100; NaN counts as 1.
#[must_use]
pub fn weight(rain: f32) -> u32 {
    let rain = if rain.is_nan() { 1.0 } else { rain.clamp(0.01, 100.0) };
    (f64::from(rain) * f64::from(UNIT_WEIGHT) + 0.5) as u32
}

/// The drainage area of each cell, and orders for walking the cells.
#[derive(Debug, Clone)]
pub struct Accumulation {
    /// Number of cells that drain through each cell, including the cell itself. The numbers are integers, so the result
    /// does not depend on the order of addition.
    pub area: Grid<u32>,
    /// The area with every cell weighted by its rain factor, in units of 1 / [`UNIT_WEIGHT`] of a cell; `None` if the
    /// rain is the same everywhere.
    pub discharge: Option<Grid<u64>>,
    /// The cells that receive water from other bands and everything downstream of them, each after its receiver.
    trunk: Vec<u32>,
    bands: Vec<Band>,
}

/// A band of rows. Its cells, except those of the trunk, can be processed without reading other bands.
#[derive(Debug, Clone)]
struct Band {
    /// The range of cells, row-major.
    cells: Range<usize>,
    /// Cells outside the trunk, each after its receiver.
    order: Vec<u32>,
}

impl Band {
    /// Orders and counts the cells of a band. `donors` has an entry for each cell of the band; `area` is all ones.
    ///
    /// Each walk starts at a cell without inflow and continues downstream until it reaches a cell that still waits for
    /// another inflow. Every cell is visited once, and nearby cells are close to each other in the order.
    fn new<E>(
        receivers: &Receivers,
        trunk: &[u32],
        start: usize,
        donors: &[u8],
        area: &mut [u32],
        check: &impl Fn() -> Result<(), E>,
    ) -> Result<Band, E> {
        let cells = start..start + area.len();
        let mut waiting: Vec<u8> = donors.iter().map(|set| set.count_ones() as u8).collect();
        // A finished cell never becomes ready again, and neither does the trunk, so no walk starts or continues there.
        const DONE: u8 = 255;
        for cell in trunk.iter().map(|cell| *cell as usize).filter(|cell| cells.contains(cell)) {
            waiting[cell - start] = DONE;
        }
        let mut order = Vec::with_capacity(area.len());
        for first in 0..area.len() {
            now_and_then(first, check)?;
            let mut cell = first;
            while waiting[cell] == 0 {
                waiting[cell] = DONE;
                order.push((start + cell) as u32);
                // A receiver above the band wraps around to an index beyond the band's end.
                let receiver = receivers.of(start + cell).wrapping_sub(start);
                if receiver == cell || waiting.get(receiver).is_none_or(|waits| *waits == DONE) {
                    break;
                }
                area[receiver] += area[cell];
                waiting[receiver] -= 1;
                cell = receiver;
            }
        }
        order.reverse();
        Ok(Band { cells, order })
    }
}

impl Accumulation {
    /// The drainage area of each cell in square metres, of cells of the window's size; weighted by the rain if it is
    /// known.
    #[must_use]
    pub fn areas(&self) -> Grid {
        let window = *self.area.window();
        let cell_area = window.cell * window.cell;
        let mut out = Grid::filled(window, 0.0f32);
        match &self.discharge {
            Some(discharge) => {
                let unit_area = cell_area / f64::from(UNIT_WEIGHT);
                let pairs = out.data_mut().iter_mut().zip(discharge.data());
                pairs.for_each(|(area, weight)| *area = (*weight as f64 * unit_area) as f32);
            }
            None => {
                let pairs = out.data_mut().iter_mut().zip(self.area.data());
                pairs.for_each(|(area, cells)| *area = (f64::from(*cells) * cell_area) as f32);
            }
        }
        out
    }

    /// Iterates over every cell once, each after its receiver.
    #[must_use]
    pub fn downstream_first(&self) -> impl DoubleEndedIterator<Item = usize> {
        let bands = self.bands.iter().flat_map(|band| &band.order);
        self.trunk.iter().chain(bands).map(|cell| *cell as usize)
    }

    /// Iterates over every cell once, each before its receiver.
    #[must_use]
    pub fn upstream_first(&self) -> impl DoubleEndedIterator<Item = usize> {
        self.downstream_first().rev()
    }

    /// Replaces the height of every cell with a receiver, each after its receiver: `height` has the cell, its height
    /// and the new height of the receiver. The bands are computed in parallel.
    pub(super) fn downstream<E: Send>(
        &self,
        receivers: &Receivers,
        heights: &mut Grid,
        check: &(impl Fn() -> Result<(), E> + Sync),
        height: impl Fn(usize, f32, f32) -> f32 + Sync,
    ) -> Result<(), E> {
        let width = heights.width();
        let h = heights.data_mut();
        for c in self.trunk.iter().map(|c| *c as usize) {
            let receiver = receivers.of(c);
            if receiver != c {
                h[c] = height(c, h[c], h[receiver]);
            }
        }
        let mut rest = h;
        let mut shares = Vec::with_capacity(self.bands.len());
        let mut above = Vec::new();
        for band in &self.bands {
            let cells = band.cells.len().min(rest.len());
            let (own, after) = std::mem::take(&mut rest).split_at_mut(cells);
            // Cells beyond the band's ends are read only if they belong to the trunk, whose heights are already known.
            let below = after[..width.min(after.len())].to_vec();
            let last = own[own.len().saturating_sub(width)..].to_vec();
            shares.push((band, own, std::mem::replace(&mut above, last), below));
            rest = after;
        }
        parallel::try_for_each(shares, |(band, own, above, below)| {
            let Range { start, end } = band.cells;
            for (k, c) in band.order.iter().map(|c| *c as usize).enumerate() {
                now_and_then(k, check)?;
                let receiver = receivers.of(c);
                if receiver != c {
                    let beneath = match receiver {
                        r if r < start => above[r + above.len() - start],
                        r if r >= end => below[r - end],
                        r => own[r - start],
                    };
                    own[c - start] = height(c, own[c - start], beneath);
                }
            }
            Ok(())
        })
    }

    /// Computes a value for every cell, each before its receiver: `value` has the cell and the sum of the values of its
    /// donors, which are added in the order of the directions, so that the bits do not depend on the bands. The bands
    /// are computed in parallel.
    pub(super) fn upstream<T: Copy + Default + Send + Sync, E: Send>(
        &self,
        donors: &[u8],
        width: usize,
        values: &mut [T],
        check: &(impl Fn() -> Result<(), E> + Sync),
        add: impl Fn(T, T) -> T + Sync,
        value: impl Fn(usize, T) -> T + Sync,
    ) -> Result<(), E> {
        let strides = strides(width);
        let sum = |values: &[T], c: usize, start: usize| {
            let (mut set, mut sum) = (donors[c], T::default());
            while set != 0 {
                let code = set.trailing_zeros() as usize;
                sum = add(sum, values[neighbor(c, strides[code]) - start]);
                set &= set - 1;
            }
            sum
        };
        let mut rest = &mut *values;
        let mut shares = Vec::with_capacity(self.bands.len());
        for band in &self.bands {
            let cells = band.cells.len().min(rest.len());
            let (own, after) = std::mem::take(&mut rest).split_at_mut(cells);
            shares.push((band, own));
            rest = after;
        }
        parallel::try_for_each(shares, |(band, own)| {
            let start = band.cells.start;
            for (k, c) in band.order.iter().rev().map(|c| *c as usize).enumerate() {
                now_and_then(k, check)?;
                own[c - start] = value(c, sum(own, c, start));
            }
            Ok(())
        })?;
        for c in self.trunk.iter().rev().map(|c| *c as usize) {
            values[c] = value(c, sum(values, c, 0));
        }
        Ok(())
    }
}

/// Counts the cells that drain through each cell. The time is O(cells); all threads of the pool are used.
///
/// Each thread takes bands of rows. The trunk consists of the cells that receive water from another band, a few
/// percent. All other cells are ordered and counted band by band. `receivers` must have no cycles, because cells on a
/// cycle are never visited. The functions of this module create none.
#[must_use]
pub fn accumulate(receivers: &Receivers) -> Accumulation {
    let Ok(accumulation) = accumulate_in(receivers, band_rows(receivers), &never);
    accumulation
}

/// [`accumulate`] with progress and cancellation.
///
/// # Errors
/// If the work is cancelled.
pub fn accumulate_with(receivers: &Receivers, progress: &Progress) -> error::Result<Accumulation> {
    accumulate_in(receivers, band_rows(receivers), &steps(progress, checks(receivers.window().len())))
}

/// [`accumulate_with`], and also the [discharge](Accumulation::discharge) if `rain` is given: the sum of the weights of
/// the cells that drain through each cell. `rain` holds the rain factors on the grid of the receivers.
///
/// # Errors
/// If the work is cancelled.
pub fn accumulate_rain_with(
    receivers: &Receivers,
    rain: Option<&Grid>,
    progress: &Progress,
) -> error::Result<Accumulation> {
    let accumulation = accumulate_with(receivers, progress)?;
    let Some(rain) = rain else { return Ok(accumulation) };
    progress.check()?;
    let discharge = discharge(receivers, &accumulation, rain);
    Ok(Accumulation { discharge: Some(discharge), ..accumulation })
}

/// The sum of the weights of the cells that drain through each cell.
fn discharge(receivers: &Receivers, accumulation: &Accumulation, rain: &Grid) -> Grid<u64> {
    let weights = |cell: usize| u64::from(weight(rain.data().get(cell).copied().unwrap_or(1.0)));
    let mut sums = Grid::filled(*receivers.window(), 0u64);
    let mut rest = sums.data_mut();
    let mut shares = Vec::with_capacity(accumulation.bands.len());
    for band in &accumulation.bands {
        let (own, after) = std::mem::take(&mut rest).split_at_mut(band.cells.len());
        shares.push((band, own));
        rest = after;
    }
    parallel::for_each(shares, |(band, own)| {
        let start = band.cells.start;
        own.iter_mut().enumerate().for_each(|(cell, sum)| *sum = weights(start + cell));
        for cell in band.order.iter().rev().map(|cell| *cell as usize - start) {
            // A receiver above the band wraps around to an index beyond the band's end.
            let receiver = receivers.of(start + cell).wrapping_sub(start);
            if receiver != cell && receiver < own.len() {
                own[receiver] += own[cell];
            }
        }
    });
    if accumulation.trunk.is_empty() {
        return sums;
    }
    let (donors, strides) = (receivers.donors(), strides(receivers.window().width));
    let sums_of = sums.data_mut();
    for cell in accumulation.trunk.iter().rev().map(|cell| *cell as usize) {
        let flows_in = |k: &usize| donors[cell] & 1 << k != 0;
        sums_of[cell] =
            weights(cell) + (0..8).filter(flows_in).map(|k| sums_of[neighbor(cell, strides[k])]).sum::<u64>();
    }
    sums
}

/// Number of rows of a band.
fn band_rows(receivers: &Receivers) -> usize {
    let threads = parallel::threads();
    // One band with one thread; otherwise three bands per thread, to balance the load.
    let bands = if threads == 1 { 1 } else { 3 * threads };
    receivers.window().height.div_ceil(bands).max(FEWEST_ROWS)
}

/// Minimum number of rows of a band, because the trunk grows with the number of bands.
const FEWEST_ROWS: usize = 128;

/// [`accumulate`] with bands of `rows` rows.
fn accumulate_in<E: Send>(
    receivers: &Receivers,
    rows: usize,
    check: &(impl Fn() -> Result<(), E> + Sync),
) -> Result<Accumulation, E> {
    let window = *receivers.window();
    let mut area = vec![1u32; window.len()];
    if window.is_empty() {
        return Ok(Accumulation {
            area: Grid::filled(window, 1),
            discharge: None,
            trunk: Vec::new(),
            bands: Vec::new(),
        });
    }
    let size = rows * window.width;
    let donors = receivers.donors();
    check()?;
    let trunk = Trunk::new(receivers, rows);
    let bands = area.chunks_mut(size).zip(donors.chunks(size)).enumerate();
    let bands = parallel::try_map(bands, |(k, (area, donors))| {
        Band::new(receivers, &trunk.order, k * size, donors, area, check)
    })?;
    let strides = strides(window.width);
    for cell in trunk.order.iter().rev().map(|cell| *cell as usize) {
        let flows_in = |k: &usize| donors[cell] & 1 << k != 0;
        area[cell] = 1 + (0..8).filter(flows_in).map(|k| area[neighbor(cell, strides[k])]).sum::<u32>();
    }
    let area = Grid::from_data(window, area).unwrap_or_else(|| Grid::filled(window, 0));
    Ok(Accumulation { area, discharge: None, trunk: trunk.order, bands })
}

/// The cells that receive water from other bands, and everything downstream of them.
struct Trunk {
    /// The cells, each after its receiver.
    order: Vec<u32>,
    /// Whether each cell belongs to the trunk; empty if there is only one band.
    marks: Vec<bool>,
}

impl Trunk {
    fn new(receivers: &Receivers, rows: usize) -> Trunk {
        let (width, height) = (receivers.window().width, receivers.window().height);
        let mut trunk = Trunk { order: Vec::new(), marks: Vec::new() };
        for first in (rows..height).step_by(rows) {
            trunk.marks.resize(width * height, false);
            let (above, below) = ((first - 1) * width, first * width);
            for cell in above..below + width {
                let receiver = receivers.of(cell);
                if (cell < below) != (receiver < below) {
                    trunk.follow(receivers, receiver);
                }
            }
        }
        trunk
    }

    /// Adds `from` and the cells downstream of it, up to the first one that is already included.
    fn follow(&mut self, receivers: &Receivers, from: usize) {
        let (start, mut cell) = (self.order.len(), from);
        while !self.marks[cell] {
            self.marks[cell] = true;
            self.order.push(cell as u32);
            cell = receivers.of(cell);
        }
        self.order[start..].reverse();
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::hydrology::outlets::Outlets;
    use crate::hydrology::steepest::Descent;
    use crate::hydrology::{flats, samples, steepest};

    /// The sum of the weights by walking from every cell.
    fn discharges(receivers: &Receivers, rain: &Grid) -> Vec<u64> {
        let mut sums = vec![0u64; rain.data().len()];
        for start in 0..sums.len() {
            let (own, mut at) = (u64::from(weight(rain.data()[start])), start);
            loop {
                sums[at] += own;
                let next = receivers.of(at);
                if next == at {
                    break;
                }
                at = next;
            }
        }
        sums
    }

    #[test]
    fn weights_are_whole_and_limited() {
        let factors = [1.0, 0.5, 0.0, -3.0, 0.01, 100.0, 1e9, f32::NAN, f32::INFINITY];
        let weights = [65_536, 32_768, 655, 655, 655, 6_553_600, 6_553_600, 65_536, 6_553_600];
        assert_eq!(factors.map(weight), weights);
    }

    #[test]
    fn areas_are_those_of_walking_from_every_cell() {
        for heights in samples::grids() {
            let outlets = Outlets::new(&heights, None);
            let mut receivers = steepest::receivers(&heights, &outlets, Descent::Steepest);
            flats::resolve(&heights, &outlets, &mut receivers);
            let mut expect = vec![0u32; heights.data().len()];
            for start in 0..expect.len() {
                let mut at = start;
                loop {
                    expect[at] += 1;
                    let next = receivers.of(at);
                    if next == at {
                        break;
                    }
                    at = next;
                }
            }
            for rows in [1, 2, 7, 1000] {
                let Ok(got) = accumulate_in(&receivers, rows, &never);
                assert_eq!(got.area.data(), expect);
                let even = discharge(&receivers, &got, &Grid::filled(*heights.window(), 1.0));
                assert!(even.data().iter().zip(&expect).all(|(sum, cells)| *sum == u64::from(cells * UNIT_WEIGHT)));
                assert_eq!(discharge(&receivers, &got, &heights).data(), discharges(&receivers, &heights));
                let mut place = vec![usize::MAX; expect.len()];
                for (k, c) in got.upstream_first().enumerate() {
                    place[c] = k;
                }
                assert_eq!(got.downstream_first().count(), expect.len());
                for c in 0..expect.len() {
                    assert!(place[c] < usize::MAX && (receivers.of(c) == c || place[c] < place[receivers.of(c)]));
                }
            }
        }
    }
}
