//! A mask of an exact share of the world.

use crate::lower::{Lowering, Passes};
use crate::op::{Context, Reading, Solution, Solver, Sources, WorldParams};
use orogen_grid::error::{Error, ErrorKind, Result};
use orogen_grid::grid::{Grid, Window};
use orogen_grid::progress::Progress;
use orogen_io::raster::Raster;

op! {
    /// A mask of an exact share: 1 at the lowest samples of the world, or the highest ones, and 0 at all others.
    ///
    /// Of the N samples with a value that a map of the world at the solution's cell has, round(`share` N) are 1. Of
    /// equal values those further north are taken first, and in a row those further west. The threshold is found by
    /// radix selection: the values are counted by the upper and then by the lower half of their bits, as integers of
    /// the same order, so it is exact, and the same in memory and on disk.
    ///
    /// The solution is the threshold, with which readers compare the source where they are. So at a finer cell the
    /// border is finer, too, and at any other cell the share is that of the threshold, which is not quite exact. With a
    /// `margin` it is a share of the wider domain. Solving takes 4 bytes per sample.
    pub struct SelectShare = "select-share", solver, revision 1;
    margin;
    inputs {
        /// The values to select by, for example heights.
        source: required,
        /// Where samples can be selected: where this is at least 0.5. If there are fewer such samples than wanted, all
        /// of them are selected. Default: everywhere.
        among: optional,
    }
    params {
        /// Share of the samples that are selected.
        share: f64 = 0.4, range 0.0 to 1.0;
        /// Whether the highest samples are selected instead of the lowest.
        highest: bool = false;
        /// Cell size at which the share is exact; 0 uses the world's cell.
        cell: f64 = 0.0, unit "m", range 0.0 to 1e6;
    }
    layers {
        /// 1 at the selected samples, 0 at the others and where the source has no value.
        selected: label;
    }
}

/// Number of values of half of a sample's bits.
const HALVES: usize = 1 << 16;

/// Side of the parts in which a raster is read, in samples.
const SIDE: usize = 1024;

/// Minimum value of the input `among` for candidates.
const CANDIDATE: f32 = 0.5;

impl Solver for SelectShare {
    fn cell(&self, world_cell: f64) -> f64 {
        if self.cell > 0.0 { self.cell } else { world_cell }
    }

    fn rasters(&self) -> usize {
        1
    }

    fn scratch(&self, padded: &Window) -> u64 {
        // The counts, a part of the raster and a row, and the ties of each row.
        let sides = (padded.width as u64).saturating_add(padded.height as u64);
        (8 * HALVES as u64 + 4 * (SIDE * SIDE) as u64).saturating_add(sides.saturating_mul(8))
    }

    fn reads_inputs(&self) -> bool {
        true
    }

    fn solve(&self, sources: &dyn Sources, context: &Context) -> Result<Solution> {
        let drawn = drawn(sources.domain(), context.world_params);
        let mut values = sources.raster()?;
        let mut count = 0u64;
        sources.each_tile("source", &drawn, &mut |tile| {
            count += tile.data().iter().filter(|value| !value.is_nan()).count() as u64;
            values.put(tile)
        })?;
        if sources.given("among") {
            sources.each_tile("among", &drawn, &mut |among| {
                let mut tile = values.get(among.window())?;
                let candidates = among.data().iter().map(|among| *among >= CANDIDATE);
                tile.data_mut()
                    .iter_mut()
                    .zip(candidates)
                    .filter(|(_, is)| !is)
                    .for_each(|(value, _)| *value = f32::NAN);
                values.put(&tile)
            })?;
        }
        let wanted = (self.share * count as f64).round() as u64;
        let ranked = Ranked { values: &values, drawn, highest: self.highest, progress: context.progress };
        let Last { rank, row, column } = ranked.last(wanted)?;
        Ok(Solution { layers: Vec::new(), scalars: vec![rank, row, column, drawn.cell] })
    }

    fn read(&self, solution: &Solution, asked: &Reading, out: &mut [f32]) -> Result<()> {
        let [last, row, column, cell] = solution.scalars[..] else {
            return Err(Error::new(ErrorKind::Internal, "a solution has no threshold"));
        };
        let among = asked.inputs.get("among");
        for (k, (sample, value)) in out.iter_mut().zip(asked.inputs.required("source")?).enumerate() {
            let is_candidate = among.is_none_or(|among| among.get(k).is_some_and(|among| *among >= CANDIDATE));
            let is_selected = is_candidate
                && rank(*value, self.highest).is_some_and(|rank| {
                    let rank = f64::from(rank);
                    rank < last
                        || rank == last
                            && asked.at.position(k).is_some_and(|(x, y)| {
                                let [x, y] = [x, y].map(|metres| (metres / cell + 0.5).floor());
                                y < row || y == row && x <= column
                            })
                });
            *sample = f32::from(u8::from(is_selected));
        }
        Ok(())
    }

    fn lower(&self, _: &Window, _: &[bool], _: &WorldParams) -> Lowering<Passes> {
        Lowering::Processor("its solution is a number, not a grid")
    }

    fn cost(&self) -> f64 {
        5.0
    }
}

/// The samples of a domain that a map shows, without the last edge.
fn drawn(domain: &Window, world: &WorldParams) -> Window {
    let [margin_x, margin_y] = [domain.x, domain.y].map(|first| first.unsigned_abs() as usize);
    let [width, height] = world.size.unwrap_or_default().map(|length| (length / domain.cell).round() as usize);
    Window {
        width: (width.max(1) + 2 * margin_x).min(domain.width),
        height: (height.max(1) + 2 * margin_y).min(domain.height),
        ..*domain
    }
}

/// The rank of a value in the order of selection; smaller ranks come first. Zeros of both signs are equal; NaN has no
/// rank.
fn rank(value: f32, highest: bool) -> Option<u32> {
    const SIGN: u32 = 1 << 31;
    if value.is_nan() {
        return None;
    }
    let bits = (value + 0.0).to_bits();
    let rising = if bits & SIGN == 0 { bits | SIGN } else { !bits };
    Some(if highest { !rising } else { rising })
}

/// The last sample that is selected: its rank and, among samples of this rank, its row and column.
struct Last {
    rank: f64,
    row: f64,
    column: f64,
}

impl Last {
    /// A selection of all samples up to this rank.
    fn all_of(rank: f64) -> Last {
        Last { rank, row: f64::MAX, column: f64::MAX }
    }
}

/// Samples in the order in which they are selected.
struct Ranked<'a> {
    values: &'a Raster,
    drawn: Window,
    highest: bool,
    progress: &'a Progress,
}

impl Ranked<'_> {
    /// The last of `wanted` samples.
    fn last(&self, wanted: u64) -> Result<Last> {
        if wanted == 0 {
            return Ok(Last::all_of(-1.0));
        }
        let upper = self.counts(|rank| Some(rank >> 16))?;
        let Some((half, before)) = nth(&upper, wanted) else { return Ok(Last::all_of(f64::from(u32::MAX))) };
        let lower = self.counts(|rank| (rank >> 16 == half).then_some(rank & 0xFFFF))?;
        // The counts of the lower halves add up to the count of the upper half.
        let (low, before) = nth(&lower, wanted - before).map_or((0xFFFF, 0), |(low, more)| (low, before + more));
        let rank = half << 16 | low;
        let ties = lower.get(low as usize).copied().unwrap_or_default();
        match wanted - before {
            left if left < ties => self.tie(rank, left),
            _ => Ok(Last::all_of(f64::from(rank))),
        }
    }

    /// The `n`th sample of a rank, row by row.
    fn tie(&self, rank: u32, n: u64) -> Result<Last> {
        let of_rank = |value: &f32| self::rank(*value, self.highest) == Some(rank);
        let mut rows = vec![0u64; self.drawn.height];
        self.each_part(|part| {
            let first = (part.window().y - self.drawn.y) as usize;
            for (j, row) in rows.iter_mut().skip(first).take(part.height()).enumerate() {
                *row += part.row(j).iter().filter(|value| of_rank(value)).count() as u64;
            }
        })?;
        let Some((row, before)) = nth(&rows, n) else { return Ok(Last::all_of(f64::from(rank))) };
        let y = self.drawn.y + i64::from(row);
        let values = self.values.get(&Window { y, height: 1, ..self.drawn })?;
        let mut ties = (0i64..).zip(values.data()).filter(|(_, value)| of_rank(value));
        let column = ties.nth((n - before - 1) as usize).map_or(self.drawn.width as i64, |(column, _)| column);
        Ok(Last { rank: f64::from(rank), row: y as f64, column: (self.drawn.x + column) as f64 })
    }

    /// Number of samples for each value of half of their bits.
    fn counts(&self, half: impl Fn(u32) -> Option<u32>) -> Result<Vec<u64>> {
        let mut counts = vec![0u64; HALVES];
        self.each_part(|part| {
            for half in part.data().iter().filter_map(|value| rank(*value, self.highest)).filter_map(&half) {
                counts[half as usize] += 1;
            }
        })?;
        Ok(counts)
    }

    fn each_part(&self, mut visit: impl FnMut(&Grid)) -> Result<()> {
        for part in self.drawn.tiles(SIDE) {
            self.progress.check()?;
            visit(&self.values.get(&part)?);
        }
        Ok(())
    }
}

/// The bin of the `n`th sample, from 1, and the number of samples in the bins before it; `None` if there are fewer
/// samples.
fn nth(counts: &[u64], n: u64) -> Option<(u32, u64)> {
    let mut before = 0;
    for (bin, count) in (0..).zip(counts) {
        if before + count >= n {
            return Some((bin, before));
        }
        before += count;
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ranks_have_the_order_of_values() {
        let values = [f32::NEG_INFINITY, -1e30, -1.0, -1e-40, 0.0, 1e-40, 1.0, 1e30, f32::INFINITY];
        for pair in values.windows(2) {
            assert!(rank(pair[0], false) < rank(pair[1], false), "{pair:?}");
            assert!(rank(pair[0], true) > rank(pair[1], true), "{pair:?}");
        }
        assert_eq!(rank(-0.0, false), rank(0.0, false));
        assert_eq!(rank(f32::NAN, true), None);
    }

    #[test]
    fn drawn_samples_are_those_of_maps() {
        let world = |size: [f64; 2]| WorldParams { seed: 0, size: Some(size), cell: 1.0, sea_level: 0.0 };
        let domain = Window::new(11, 6, 10.0);
        assert_eq!(drawn(&domain, &world([100.0, 56.0])), Window::new(10, 6, 10.0));
        assert_eq!(drawn(&domain, &world([104.0, 52.0])), Window::new(10, 5, 10.0));
        assert_eq!(drawn(&Window::new(1, 1, 10.0), &world([2.0, 3.0])), Window::new(1, 1, 10.0));
        let wider = Window::new(15, 10, 10.0).at(-2, -2);
        assert_eq!(drawn(&wider, &world([100.0, 56.0])), Window::new(14, 10, 10.0).at(-2, -2));
    }
}
