//! The land between rivers, made new by a network that keeps the rivers.

use super::network::{Draw, Layers, Network, nodes_of};
use super::rivers::{Drained, GAP, Rivers};
use crate::error::{Error, ErrorKind, Result};
use crate::grid::{Grid, Window};
use crate::hydrology::direction::{NONE, opposite, strides};
use crate::hydrology::receivers::Receivers;
use crate::progress::Progress;

/// Minimum fall from a sample to its receiver, as a share of the cell.
const FALL: f64 = 3e-4;
impl Network {
    /// Number of samples that [`Network::hillslopes`] reads on each side.
    #[must_use]
    pub fn halo_of_hillslopes(&self, rivers: u32) -> usize {
        rivers as usize + 2 * (self.halo() + 1) + GAP
    }

    /// Memory that [`Network::hillslopes`] needs beside its result, for a window, in bytes.
    #[must_use]
    pub fn scratch_of_hillslopes(&self, window: &Window, rivers: u32) -> u64 {
        let grown = window.grown(self.halo_of_hillslopes(rivers));
        let samples = (grown.width as u64).saturating_mul(grown.height as u64);
        // The land and areas of rivers with marks, new heights, directions with donors, lists of samples.
        self.scratch(grown.width / 2, grown.height / 2)
            .saturating_add(samples.saturating_mul(4 * 5 + 1 + 4 + 2 + 8 + 8))
    }

    /// The heights of `window`: those of `land` where the drainage area is at least `rivers` samples, in lakes and
    /// without a receiver; elsewhere a draw that fits them and the means of 3 x 3 heights. No sample is lower than its
    /// receiver: chains of receivers are followed for `rivers` samples, where they have met a river.
    ///
    /// # Errors
    /// If the network does not read rivers, the land covers too little, or the work is cancelled.
    pub fn hillslopes(
        &self,
        land: &Drained<'_>,
        window: &Window,
        rivers: u32,
        draw: &Draw,
        progress: &Progress,
    ) -> Result<Grid> {
        if window.is_empty() {
            return Ok(Grid::filled(*window, 0.0));
        }
        let made = window.grown(rivers as usize);
        let nodes = nodes_of(&made, 2.0 * window.cell);
        let read = nodes.grown(self.halo());
        let [width, height] = [read.width, read.height].map(|nodes| 2 * nodes);
        let fine = Window { x: 2 * read.x, y: 2 * read.y, width, height, cell: window.cell }.grown(GAP);
        let cropped = |grid: &Grid, window: &Window| {
            grid.crop(window).ok_or_else(|| {
                Error::new(ErrorKind::Internal, format!("hillslopes read {window:?}, and have {:?}", grid.window()))
            })
        };
        let heights = cropped(land.height, &fine)?;
        let coarse = means(&heights, read);
        let [flow, receiver] = [cropped(land.flow, &fine)?, cropped(land.receiver, &fine)?];
        let lake = land.lake.map(|lake| cropped(lake, &fine)).transpose()?;
        let drained = Drained { height: &heights, flow: &flow, receiver: &receiver, lake: lake.as_ref() };
        let known = Rivers::of(&drained, rivers);
        progress.expect(nodes.height as f64);
        let mut out = Grid::filled(made, 0.0);
        let mut layers = Layers::new(self, &coarse, draw, Some(&known))?;
        for j in 0..nodes.height {
            layers.rows(j, &nodes, &mut out);
            progress.step(1.0)?;
        }
        let mut receivers = Receivers::none(made);
        for (j, codes) in receivers.codes_mut().chunks_mut(made.width).enumerate() {
            for (i, code) in codes.iter_mut().enumerate() {
                let at = known.index(made.x + i as i64, made.y + j as i64);
                let height = &mut out.row_mut(j)[i];
                match known.bed(at) {
                    Some(bed) => *height = bed,
                    None if 0 < i && i + 1 < made.width && 0 < j && j + 1 < made.height => {
                        *code = receiver.data()[at] as u8;
                    }
                    None => {}
                }
            }
        }
        raise(&mut out, &receivers, rivers);
        cropped(&out, window)
    }
}

/// Means of 3 x 3 heights around every second sample, weighted 1, 2, 1 along rows and columns. The first mean is
/// [`GAP`] samples south-east of the first height.
fn means(heights: &Grid, window: Window) -> Grid {
    let mut out = Grid::filled(window, 0.0);
    for j in 0..window.height {
        let rows: [&[f32]; 3] = std::array::from_fn(|row| heights.row(2 * j + GAP - 1 + row));
        for (i, mean) in out.row_mut(j).iter_mut().enumerate() {
            let [north, middle, south] = rows.map(|row| {
                let [west, here, east] = std::array::from_fn(|column| row[2 * i + GAP - 1 + column]);
                (west + 2.0 * here + east) * 0.25
            });
            *mean = (north + 2.0 * middle + south) * 0.25;
        }
    }
    out
}

/// Raises samples that are not above their receiver, and those that drain to them, `times` links upstream. Each pass
/// reads the heights of the one before, so that a sample depends on the samples within `times` links only.
fn raise(heights: &mut Grid, receivers: &Receivers, times: u32) {
    let fall = (FALL * heights.window().cell) as f32;
    let steps = strides(heights.width());
    let donors = receivers.donors();
    let least = |heights: &Grid, at: usize| {
        let below = heights.data()[receivers.of(at)];
        (below + fall).max(below.next_up())
    };
    let is_low = |heights: &Grid, at: usize| receivers.code(at) != NONE && heights.data()[at] < least(heights, at);
    let mut low: Vec<usize> = (0..heights.data().len()).filter(|at| is_low(heights, *at)).collect();
    for _ in 0..times {
        if low.is_empty() {
            break;
        }
        let raised: Vec<f32> = low.iter().map(|at| least(heights, *at)).collect();
        low.iter().zip(raised).for_each(|(at, height)| heights.data_mut()[*at] = height);
        let mut above = Vec::new();
        for at in &low {
            for direction in (0..8u8).filter(|direction| donors[*at] >> direction & 1 == 1) {
                let donor = at.wrapping_add_signed(steps[usize::from(direction)]);
                debug_assert_eq!(receivers.code(donor), opposite(direction));
                if is_low(heights, donor) {
                    above.push(donor);
                }
            }
        }
        low = above;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn samples_are_raised_above_their_receivers_link_by_link() {
        let window = Window::new(6, 3, 1e4);
        let mut heights = Grid::filled(window, 90.0);
        heights.row_mut(1).copy_from_slice(&[50.0, 40.0, 45.0, 30.0, 80.0, 90.0]);
        let mut receivers = Receivers::none(window);
        // All drain west, to the first sample.
        receivers.codes_mut()[7..11].fill(4);
        let mut once = heights.clone();
        raise(&mut once, &receivers, 1);
        assert_eq!(once.row(1), [50.0, 53.0, 45.0, 48.0, 80.0, 90.0]);
        raise(&mut heights, &receivers, 9);
        assert_eq!(heights.row(1), [50.0, 53.0, 56.0, 59.0, 80.0, 90.0]);
    }
}
