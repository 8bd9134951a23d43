//! Rivers that deposit: the stream power law with the transport of sediment.
//!
//! ```text
//! dh/dt = U - K A^m S^n + G Q / A
//! ```
//!
//! where Q is the volume of sediment that a river carries per year, and G is dimensionless (Yuan, Braun, Guerit, Rouby
//! and Cordonnier, "A new efficient method to solve the stream power law model taking into account sediment
//! deposition", 2019; after Davy and Lague 2009). Q is the sum of the net erosion upstream, including the cell's own.
//!
//! The paper iterates between a sweep upstream, for the heights, and one downstream, for the sediment. Here both are
//! solved together. Receivers form a tree, and with them the equations: a cell depends on its receiver's height and on
//! its donors' sediment. The first sweep visits donors before receivers. In each cell it eliminates the donors: their
//! sediment is a linear function of the height of this cell. The second sweep visits receivers first, and finds the
//! heights. For n = 1 this solves the equations exactly; limits on slopes and other n are linearized, and a second
//! iteration follows. Sums are made in the order of the directions, so the result does not depend on threads.
//!
//! A third sweep adds up the sediment from the heights as they are. Where more was laid than the river had, the excess
//! is taken back. So no sediment comes from nowhere: what is eroded is laid or leaves through outlets.
//!
//! A depression is a trap: its sediment covers the floor up to a level height, and only what is more than the
//! depression holds is carried over its pass. Water always leaves over the pass.

use super::accumulation::Accumulation;
use super::basins::{Basins, OUTSIDE, Spill, ordered};
use super::direction::{neighbor, strides};
use super::drainage::Drainage;
use super::outlets::Outlets;
use super::receivers::Receivers;
use super::spread::spread;
use super::stream_power::{Step, StreamPower, Substrate, Terms};
use crate::grid::Grid;
use crate::parallel;
use std::cmp::Reverse;
use std::collections::BinaryHeap;

/// The sediment of a run.
#[derive(Debug, Clone)]
pub struct Deposits {
    /// G: the deposition coefficient.
    deposition: f64,
    /// Thickness of the deposits in metres: what was laid and not eroded again.
    pub thickness: Grid,
    /// Sediment that left each cell in the last step, in metres of a cell's area. At outlets: what reached them.
    flux: Vec<f64>,
    /// What happened so far.
    pub balance: SedimentBalance,
    places: Vec<CellLaw>,
    sweep: Vec<Sweep>,
    raised: Vec<f32>,
    /// The thickness of what was laid in a step.
    fresh: Vec<f32>,
    /// 0 for outlets, otherwise 1.
    is_open: Vec<f32>,
    buffers: [Vec<f32>; 2],
    seen: Vec<u32>,
}

/// Volumes of sediment, in m^3.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct SedimentBalance {
    /// Eroded ground: in each step the net loss of all cells that became lower.
    pub eroded: f64,
    /// Laid sediment: in each step the net gain of all cells that became higher.
    pub laid: f64,
    /// Sediment that left through outlets.
    pub left: f64,
}

/// Number of iterations of a step, where the law is linear and where it is not.
const ITERATIONS: [usize; 2] = [1, 2];

/// Maximum coefficient of the law: beyond it nothing of a drop remains in f32.
const MAX_CUT: f64 = 1e30;

/// What the first sweep leaves for the second, and for the receiver.
#[derive(Debug, Clone, Copy, Default)]
struct Sweep {
    /// The sediment of all donors if this cell keeps its present height, and its derivative with respect to this
    /// cell's height.
    arriving: [f32; 2],
    /// The sediment that leaves the cell if the receiver keeps its present height, and its derivative with respect to
    /// the receiver's height.
    leaving: [f32; 2],
}

/// The parts of cells in depressions.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Role {
    /// A cell whose water takes its natural way.
    Slope,
    /// A cell between a pit and its pass: sediment goes by.
    WayOut,
    /// The last of these cells, before the pass: sediment stays as long as the basin is not full.
    Trap,
}

/// The traps of a step.
struct Traps<'a> {
    basins: &'a Basins,
    /// Empty if there are no basins.
    roles: Vec<Role>,
    /// The basin by which each basin leaves the depression that they are part of.
    depressions: Vec<u32>,
    /// The volume of each basin up to its pass, in metres of a cell's area; of the last basin of a depression also what
    /// the others hold above their passes.
    capacities: Vec<f64>,
}

impl<'a> Traps<'a> {
    fn new(drainage: &'a Drainage, outlets: &Outlets, raised: &[f32]) -> Traps<'a> {
        let Drainage { receivers, basins } = drainage;
        let mut capacities = vec![0.0; basins.spills.len()];
        let mut depressions: Vec<u32> = (0..capacities.len() as u32).collect();
        if basins.order.is_empty() {
            return Traps { basins, roles: Vec::new(), depressions, capacities };
        }
        let mut roles = vec![Role::Slope; raised.len()];
        // The heights of the pass of each basin, and of the depression.
        let mut passes = vec![[f32::NEG_INFINITY; 2]; capacities.len()];
        for basin in basins.order.iter().map(|basin| *basin as usize) {
            let Spill { pit, last, next, .. } = basins.spills[basin];
            let (mut cell, last) = (pit as usize, last as usize);
            while cell != last {
                roles[cell] = Role::WayOut;
                cell = receivers.of(cell);
            }
            // All rivers of the basin leave it here, also those that join the path after the pit.
            roles[last] = Role::Trap;
            let (pass, level) = (raised[last].max(raised[receivers.of(last)]), passes[next as usize][1]);
            passes[basin] = [pass, pass.max(level)];
            if pass <= level {
                depressions[basin] = depressions[next as usize];
            }
        }
        for (cell, label) in basins.labels.iter().enumerate().filter(|(_, label)| **label != OUTSIDE) {
            let basin = *label as usize;
            let [pass, level] = passes[basin];
            if raised[cell] < level && !outlets.at(cell) {
                let below = |pass: f32| f64::from(pass) - f64::from(raised[cell]);
                let own = below(pass).max(0.0);
                capacities[basin] += own;
                if depressions[basin] != *label {
                    capacities[depressions[basin] as usize] += below(level) - own;
                }
            }
        }
        Traps { basins, roles, depressions, capacities }
    }

    #[inline(always)]
    fn role(&self, cell: usize) -> Role {
        self.roles.get(cell).copied().unwrap_or(Role::Slope)
    }

    /// Lays a volume, in metres of a cell's area, on the lowest ground around the pit of a basin, up to a level height.
    /// `seen` has the last basin that each cell was reached from.
    fn fill(&self, heights: &mut Grid, basin: usize, volume: f64, seen: &mut [u32]) {
        let strides = strides(heights.width());
        let h = heights.data();
        let pit = self.basins.spills[basin].pit as usize;
        seen[pit] = basin as u32;
        let mut region = Vec::new();
        let mut higher = BinaryHeap::from([Reverse((ordered(h[pit]), pit))]);
        let mut level_cells = Vec::new();
        let mut sum = 0.0;
        while let Some(Reverse((key, cell))) = higher.pop() {
            if region.len() as f64 * f64::from(h[cell]) - sum >= volume {
                break;
            }
            // All cells up to this height that are connected with it.
            level_cells.push(cell);
            while let Some(cell) = level_cells.pop() {
                sum += f64::from(h[cell]);
                region.push(cell);
                for stride in strides {
                    let next = neighbor(cell, stride);
                    // Outlets, among them all cells of the border, are outside.
                    let label = self.basins.labels[next] as usize;
                    if self.depressions[label] == self.depressions[basin] && seen[next] != basin as u32 {
                        seen[next] = basin as u32;
                        let next_key = ordered(h[next]);
                        if next_key <= key {
                            level_cells.push(next);
                        } else {
                            higher.push(Reverse((next_key, next)));
                        }
                    }
                }
            }
        }
        // The level below which the region has room for the volume: cells above it are left out until none is.
        let mut level = f64::INFINITY;
        loop {
            let (mut count, mut sum) = (0.0, 0.0);
            for height in region.iter().map(|cell| f64::from(h[*cell])).filter(|height| *height < level) {
                count += 1.0;
                sum += height;
            }
            let lower = (volume + sum) / count;
            if lower < level {
                level = lower;
            } else {
                break;
            }
        }
        for cell in &region {
            let height = &mut heights.data_mut()[*cell];
            *height = height.max(level as f32);
        }
    }

    /// The capacity of the basin whose trap is `cell`.
    fn capacity(&self, cell: usize) -> f64 {
        self.capacities[self.basins.labels[cell] as usize]
    }
}

/// The sediment that arrives at a cell, as a linear function of its height change: the value at 0, and the derivative,
/// which is never positive.
#[derive(Clone, Copy)]
struct Arriving {
    at_none: f64,
    derivative: f64,
}

/// What the law has for a cell during a step.
#[derive(Debug, Clone, Copy, Default)]
struct CellLaw {
    /// The coefficient of the law; see [`Terms`](super::stream_power::Terms).
    cut: f32,
    /// The distance to the receiver, in metres.
    away: f32,
    /// G / A, with A in cells.
    share: f32,
}

/// The solution of a cell's equations.
struct Law<'a> {
    step: Step<'a>,
    places: &'a [CellLaw],
    /// Slopes have these limits.
    min_slope: f64,
    max_slope: f64,
    /// Whether the law is linear and the rock uniform.
    is_linear: bool,
}

impl Law<'_> {
    /// The change of a cell's height from `base` to a receiver of height `below`, without uplift, and its derivative
    /// with respect to the receiver's height.
    #[inline(always)]
    fn change(&self, c: usize, role: Role, [base, below]: [f64; 2], arriving: Arriving) -> [f64; 2] {
        // x = left - above, where x weight + cut left^n = share at_none.
        let above = base - below;
        let place = self.places[c];
        let is_way_out = role != Role::Slope;
        if is_way_out && above <= 0.0 {
            return [0.0, 0.0];
        }
        let share = if is_way_out { 0.0 } else { f64::from(place.share) };
        let weight = 1.0 + share * (1.0 - arriving.derivative);
        let laid = share * arriving.at_none;
        let high = above * weight + laid;
        let least = self.min_slope * f64::from(place.away);
        let [left, most, mut derivative] = if self.is_linear {
            let cut = f64::from(place.cut);
            let scale = 1.0 / (weight + cut);
            [high * scale, self.max_slope * f64::from(place.away), cut * scale]
        } else {
            self.curved(c, high / weight, below, weight)
        };
        let mut x = left - above;
        if high <= 0.0 {
            // No erosion uphill.
            (x, derivative) = (laid / weight, 0.0);
        } else if left >= most {
            (x, derivative) = (most - above, 1.0);
        }
        let raised = least - above;
        if x < raised && !is_way_out {
            // Ground is raised above its receiver as far as there is sediment.
            let all = (arriving.at_none / (1.0 - arriving.derivative)).max(0.0);
            return if raised <= all { [raised, 1.0] } else { [if x > all { x } else { all }, 0.0] };
        }
        [x, derivative]
    }

    /// What remains of a drop, its maximum, and the derivative of what remains with respect to the receiver's height,
    /// where the law is not linear.
    #[inline(never)]
    fn curved(&self, c: usize, high: f64, below: f64, weight: f64) -> [f64; 3] {
        let terms = self.step.terms(c);
        let [left, most] = self.step.left(&terms, high, below, terms.cut / weight);
        // The cut is in proportion to left^n: its derivative is n times its ratio to what is left.
        let cut = self.step.slope_exponent * (high - left);
        [left, most, if left > 0.0 { cut / (left + cut) } else { 1.0 }]
    }
}

impl Deposits {
    /// No deposits yet. `deposition` is G.
    #[must_use]
    pub fn new(outlets: &Outlets, deposition: f64) -> Deposits {
        Deposits {
            deposition,
            thickness: Grid::filled(*outlets.mask().window(), 0.0),
            flux: Vec::new(),
            balance: SedimentBalance::default(),
            places: Vec::new(),
            sweep: Vec::new(),
            raised: Vec::new(),
            fresh: Vec::new(),
            is_open: outlets.mask().data().iter().map(|outlet| f32::from(u8::from(!outlet))).collect(),
            buffers: Default::default(),
            seen: Vec::new(),
        }
    }

    /// Advances the heights by `years`. Outlets keep their heights.
    ///
    /// `drainage` has the receivers that `drained` was computed with. The time is O(cells).
    ///
    /// # Errors
    /// Those of `check`.
    #[expect(clippy::too_many_arguments, reason = "a step of the law and what it is computed from")]
    pub(super) fn step<E: Send>(
        &mut self,
        law: &StreamPower,
        heights: &mut Grid,
        outlets: &Outlets,
        drainage: &Drainage,
        drained: &Accumulation,
        ground: &Substrate,
        years: f64,
        check: &(impl Fn() -> Result<(), E> + Sync),
    ) -> Result<(), E> {
        let receivers = &drainage.receivers;
        let width = heights.width();
        let step = Step::new(law, receivers, drained, ground, years);
        let mut places = std::mem::take(&mut self.places);
        places.resize(heights.data().len(), CellLaw::default());
        let rows = heights.data_mut().chunks_mut(width.max(1)).zip(places.chunks_mut(width.max(1)));
        parallel::for_each(rows.enumerate(), |(j, (heights, places))| {
            for (c, (height, place)) in (j * width..).zip(heights.iter_mut().zip(places)) {
                if !outlets.at(c) {
                    let Terms { cut, risen, away, .. } = step.terms(c);
                    // Missing factors of the uplift count as 0.
                    *height = (f64::from(*height) + if risen.is_finite() { risen } else { 0.0 }) as f32;
                    let share = self.deposition / step.water(c);
                    *place = CellLaw { cut: cut.min(MAX_CUT) as f32, away: away as f32, share: share as f32 };
                }
            }
        });
        let is_linear = law.slope_exponent == 1.0 && ground.bedding.is_none();
        let law = Law { step, places: &places, min_slope: law.min_slope, max_slope: law.max_slope, is_linear };
        let mut raised = std::mem::take(&mut self.raised);
        raised.clear();
        raised.extend_from_slice(heights.data());
        let traps = Traps::new(drainage, outlets, &raised);
        let donors = receivers.donors();
        let mut sweep = std::mem::take(&mut self.sweep);
        sweep.resize(raised.len(), Sweep::default());
        let arriving = |c: usize, height: f32, [sum, derivative]: [f32; 2]| {
            let derivative = f64::from(derivative);
            let now = f64::from(height) - f64::from(raised[c]);
            Arriving { at_none: f64::from(sum) - derivative * now, derivative }
        };
        for _ in 0..if is_linear { ITERATIONS[0] } else { ITERATIONS[1] } {
            let h = heights.data();
            let eliminate = |c: usize, sum: Sweep| {
                let receiver = receivers.of(c);
                if receiver == c {
                    return Sweep { arriving: sum.leaving, leaving: [0.0; 2] };
                }
                let role = traps.role(c);
                let from = arriving(c, h[c], sum.leaving);
                let [x, derivative] = law.change(c, role, [f64::from(raised[c]), f64::from(h[receiver])], from);
                let mut leaving = from.at_none + (from.derivative - 1.0) * x;
                if role == Role::Trap {
                    leaving -= traps.capacity(c);
                }
                let leaving = if leaving > 0.0 { [leaving, (from.derivative - 1.0) * derivative] } else { [0.0; 2] };
                Sweep { arriving: sum.leaving, leaving: leaving.map(|value| value as f32) }
            };
            let add =
                |a: Sweep, b: Sweep| Sweep { leaving: [a.leaving[0] + b.leaving[0], a.leaving[1] + b.leaving[1]], ..a };
            drained.upstream(&donors, width, &mut sweep, check, add, eliminate)?;
            drained.downstream(receivers, heights, check, |c, height, receiver| {
                let from = arriving(c, height, sweep[c].arriving);
                let base = f64::from(raised[c]);
                let [x, _] = law.change(c, traps.role(c), [base, f64::from(receiver)], from);
                (base + x) as f32
            })?;
        }
        drop(law);
        self.places = places;
        self.sweep = sweep;
        self.settle(heights, &raised, [receivers], &traps, drained, &donors, check)?;
        let pairs = heights.data().iter().zip(&raised);
        self.fresh.clear();
        self.fresh.extend(pairs.map(|(height, raised)| (height - raised).max(0.0)));
        spread(heights, &mut self.fresh, &self.is_open, &mut self.buffers);
        let cell_area = heights.window().cell * heights.window().cell;
        self.account(heights, &raised, outlets, cell_area);
        self.raised = raised;
        Ok(())
    }

    /// Adds up the sediment downstream, takes back what was laid without it, and fills the traps.
    #[expect(clippy::too_many_arguments, reason = "the parts of a step")]
    fn settle<E: Send>(
        &mut self,
        heights: &mut Grid,
        raised: &[f32],
        [receivers]: [&Receivers; 1],
        traps: &Traps,
        drained: &Accumulation,
        donors: &[u8],
        check: &(impl Fn() -> Result<(), E> + Sync),
    ) -> Result<(), E> {
        let width = heights.width();
        let mut flux = std::mem::take(&mut self.flux);
        flux.resize(raised.len(), 0.0);
        let h = heights.data();
        let arrived = |c: usize, sum: f64| sum + (f64::from(raised[c]) - f64::from(h[c]));
        drained.upstream(
            donors,
            width,
            &mut flux,
            check,
            |a: f64, b: f64| a + b.max(0.0),
            |c, sum| {
                let all = arrived(c, sum);
                if traps.role(c) == Role::Trap { (all - traps.capacity(c)).max(0.0) } else { all }
            },
        )?;
        let strides = strides(width);
        let mut trapped = vec![0.0; traps.capacities.len()];
        for basin in traps.basins.order.iter().map(|basin| *basin as usize) {
            let last = traps.basins.spills[basin].last as usize;
            let sum: f64 = (0..8)
                .filter(|code| donors[last] & 1 << code != 0)
                .map(|code| flux[neighbor(last, strides[code])].max(0.0))
                .sum();
            trapped[basin] = arrived(last, sum) - flux[last];
        }
        for (c, flux) in flux.iter_mut().enumerate().filter(|(_, flux)| **flux < 0.0) {
            if receivers.of(c) != c {
                heights.data_mut()[c] = (f64::from(heights.data()[c]) + *flux) as f32;
            }
            *flux = 0.0;
        }
        self.flux = flux;
        let mut seen = std::mem::take(&mut self.seen);
        seen.clear();
        seen.resize(raised.len(), OUTSIDE);
        for basin in traps.basins.order.iter().rev().map(|basin| *basin as usize) {
            if trapped[basin] > 0.0 {
                traps.fill(heights, basin, trapped[basin], &mut seen);
            }
        }
        self.seen = seen;
        Ok(())
    }

    /// Changes the thickness of the deposits by what was laid or eroded, and the balance.
    fn account(&mut self, heights: &Grid, raised: &[f32], outlets: &Outlets, cell_area: f64) {
        let pieces = self.thickness.data_mut().chunks_mut(parallel::SAMPLES).enumerate();
        let flux = &self.flux;
        let sums = parallel::map(pieces.collect::<Vec<_>>(), |(piece, thickness)| {
            let mut sums = [0.0; 3];
            for (c, thickness) in (piece * parallel::SAMPLES..).zip(thickness) {
                if outlets.at(c) {
                    sums[2] += flux[c];
                    continue;
                }
                let change = f64::from(heights.data()[c]) - f64::from(raised[c]);
                sums[usize::from(change > 0.0)] += change.abs();
                *thickness = (f64::from(*thickness) + change).max(0.0) as f32;
            }
            sums
        });
        for [eroded, laid, left] in sums {
            self.balance.eroded += eroded * cell_area;
            self.balance.laid += laid * cell_area;
            self.balance.left += left * cell_area;
        }
    }
}

#[cfg(test)]
mod tests;
