//! A flow of lava over the ground.

use super::{Ground, Lava, WEIGHT};
use crate::error::Result;
use crate::grid::Window;
use crate::progress::Progress;
use std::f64::consts::SQRT_2;

/// Bytes per cell of the planes of a [`Flow`], with the list of its cells.
pub(super) const BYTES: u64 = 8 + 4 + 4 + 4 + 1 + 4;

/// Logarithm by which the yield strength grows over a cooling length.
const COOLING: f64 = 2.0;

/// Speed of lava above its critical thickness, in m/s: with the effusion it gives the width of a flow.
const SPEED: f64 = 0.01;

/// Radius of a vent, in metres.
const VENT: f64 = 30.0;

/// Thickness that leaves a cell at once, over the mean fall to the neighbors that get it: more would make lava slosh.
const LEVEL: f64 = 0.6;

/// Lava moves as far as at least this thickness would leave a cell, in metres.
const LEAST: f64 = 0.3;

/// Maximum number of portions of an eruption, and of rounds after the last portion.
const MAX_PORTIONS: f64 = 300.0;
const MAX_ROUNDS: u32 = 400;

/// Number of rounds after which all cells are visited, and cancellation is checked.
const CHECKED: u32 = 16;

/// A channel is where this many times the thickness flowed through; there hot lava drains at the end, down to this
/// share of the critical thickness, and levees stay.
const CHANNEL: f32 = 10.0;
const DRAINED: f32 = 0.4;

/// Number of times that the surface of a flow is smoothed at its end.
const SMOOTHED: usize = 2;

/// States of a cell.
const TOUCHED: u8 = 1;
const AWAKE: u8 = 2;
const BORDER: u8 = 4;

/// The lava of one eruption. Its planes are empty between eruptions.
pub(super) struct Flow {
    width: usize,
    cell: f64,
    /// One over the distances of straight and diagonal neighbors.
    steepness: [f64; 2],
    /// Yield strength at the vent over the weight of lava, in metres.
    strength: f64,
    /// Length in which lava cools.
    length: f64,
    /// Lava per round, in metres times cells.
    portion: f64,
    lava: Vec<f64>,
    /// Yield strength over that at the vent.
    stiffness: Vec<f32>,
    /// Shortest way from the vent through the flow, in metres.
    way: Vec<f32>,
    /// Lava that has left the cell, in metres.
    through: Vec<f32>,
    state: Vec<u8>,
    /// The cells of the flow, in the order in which lava reached them.
    cells: Vec<u32>,
}

impl Flow {
    pub(super) fn new(window: &Window, law: &Lava) -> Flow {
        let cells = window.len();
        let mut state = vec![0; cells];
        for (j, row) in state.chunks_mut(window.width.max(1)).enumerate() {
            let ends = if j == 0 || j + 1 == window.height { 1 } else { window.width.saturating_sub(1).max(1) };
            row.iter_mut().step_by(ends).for_each(|state| *state = BORDER);
        }
        Flow {
            width: window.width,
            cell: window.cell,
            steepness: [1.0 / window.cell, 1.0 / (window.cell * SQRT_2)],
            strength: law.yield_strength / WEIGHT,
            // Walker (1973): the median length of flows by their effusion.
            length: libm::pow(10.0, 3.11) * libm::pow(law.effusion, 0.47),
            portion: law.effusion / (SPEED * window.cell),
            lava: vec![0.0; cells],
            stiffness: vec![1.0; cells],
            way: vec![f32::INFINITY; cells],
            through: vec![0.0; cells],
            state,
            cells: Vec::new(),
        }
    }

    /// Releases a volume in m^3 at a vent, and returns the volume that left over the border.
    pub(super) fn run(
        &mut self,
        ground: &mut Ground,
        vent: [usize; 2],
        volume: f64,
        age: f32,
        progress: &Progress,
    ) -> Result<f64> {
        let area = self.cell * self.cell;
        let mouth = self.mouth(ground, vent);
        let mut supply = volume / area;
        let portion = self.portion.max(supply / MAX_PORTIONS);
        let mut left = 0.0;
        let mut round = 0;
        while supply > 0.0 {
            let released = portion.min(supply);
            supply -= released;
            for cell in &mouth {
                self.add(&mut ground.height, *cell, released / mouth.len() as f64, 0.0);
            }
            self.round(&mut ground.height, &mut left);
            round += 1;
            if round % CHECKED == 0 {
                self.wake();
                progress.check()?;
            }
        }
        self.drain();
        for round in 0..MAX_ROUNDS {
            if round % CHECKED == 0 {
                self.wake();
                progress.check()?;
            }
            // Nothing moves after all have been woken: the lava is at rest.
            if !self.round(&mut ground.height, &mut left) && round % CHECKED == 0 {
                break;
            }
        }
        for _ in 0..SMOOTHED {
            self.smooth(&mut ground.height);
        }
        self.freeze(ground, age);
        Ok(left * area)
    }

    /// The cells of a vent.
    fn mouth(&self, ground: &Ground, [i, j]: [usize; 2]) -> Vec<usize> {
        let reach = (VENT / self.cell).max(1.0);
        let near = ground.around([i as f64, j as f64], reach);
        let is_inside = |[x, y]: [f64; 2]| x * x + y * y <= reach * reach;
        near.filter(|(cell, at)| is_inside(*at) && ground.height[*cell].is_finite()).map(|(cell, _)| cell).collect()
    }

    fn add(&mut self, height: &mut [f64], cell: usize, thickness: f64, way: f32) {
        if self.state[cell] & TOUCHED == 0 {
            self.cells.push(cell as u32);
        }
        self.state[cell] |= TOUCHED | AWAKE;
        self.lava[cell] += thickness;
        height[cell] += thickness;
        if way < self.way[cell] {
            self.way[cell] = way;
            self.stiffness[cell] = libm::expf((COOLING * f64::from(way) / self.length).min(40.0) as f32);
        }
    }

    /// Moves the lava of all cells that may move, from the vent down. Returns whether any moved.
    fn round(&mut self, height: &mut [f64], left: &mut f64) -> bool {
        let mut is_moving = false;
        let mut at = 0;
        // The list grows on the way: what leaves a cell may go far in one round.
        while let Some(cell) = self.cells.get(at).map(|cell| *cell as usize) {
            at += 1;
            if self.state[cell] & AWAKE != 0 {
                is_moving |= self.spread(height, cell, left);
            }
        }
        is_moving
    }

    /// Moves lava from a cell to its lower neighbors, as far as it is thicker than the critical thickness of the slope
    /// to each of them: strength over slope. Returns whether any moved.
    fn spread(&mut self, height: &mut [f64], cell: usize, left: &mut f64) -> bool {
        if self.state[cell] & BORDER != 0 {
            *left += self.lava[cell];
            height[cell] -= self.lava[cell];
            self.lava[cell] = 0.0;
            self.state[cell] &= !AWAKE;
            return false;
        }
        let (north, south) = (cell - self.width, cell + self.width);
        let around = [cell - 1, cell + 1, north, south, north - 1, north + 1, south - 1, south + 1];
        let (thickness, level) = (self.lava[cell], height[cell]);
        let strength = self.strength * f64::from(self.stiffness[cell]);
        // Without branches: which neighbors are lower is random.
        let falls = around.map(|beside| {
            let fall = level - height[beside];
            if fall > 0.0 { fall } else { 0.0 }
        });
        let mut slopes = falls;
        slopes[..4].iter_mut().for_each(|slope| *slope *= self.steepness[0]);
        slopes[4..].iter_mut().for_each(|slope| *slope *= self.steepness[1]);
        // What is above the critical thickness, times the slope.
        let weights = slopes.map(|slope| {
            let weight = thickness * slope - strength;
            if weight > 0.0 { weight } else { 0.0 }
        });
        let steepest = slopes.into_iter().fold(0.0, |a: f64, b| if b > a { b } else { a });
        let sum: f64 = weights.into_iter().sum();
        let falling: f64 = weights.into_iter().zip(falls).map(|(weight, fall)| weight * fall).sum();
        let moving = if sum > 0.0 { (thickness - strength / steepest).min(LEVEL * falling / sum) } else { 0.0 };
        let mut moved = 0.0;
        if moving > LEAST {
            for (n, beside) in around.into_iter().enumerate() {
                if weights[n] > 0.0 {
                    let part = moving * weights[n] / sum;
                    let step = if n < 4 { self.cell } else { self.cell * SQRT_2 };
                    self.add(height, beside, part, self.way[cell] + step as f32);
                    moved += part;
                }
            }
        }
        self.lava[cell] -= moved;
        height[cell] -= moved;
        self.through[cell] += moved as f32;
        if moved <= LEAST {
            self.state[cell] &= !AWAKE;
            return false;
        }
        true
    }

    /// Wakes all cells: those above a cell that has become lower may move again.
    fn wake(&mut self) {
        for cell in &self.cells {
            self.state[*cell as usize] |= AWAKE;
        }
    }

    /// Lets the lava in channels move on, which is hotter than that beside them.
    fn drain(&mut self) {
        for cell in self.cells.iter().map(|cell| *cell as usize) {
            if self.through[cell] > CHANNEL * self.lava[cell] as f32 {
                self.stiffness[cell] *= DRAINED;
            }
        }
    }

    /// Levels the surface a little: what moves in steps ends uneven from cell to cell. Pairs of cells exchange lava.
    fn smooth(&mut self, height: &mut [f64]) {
        let mut gains = vec![0.0; self.cells.len()];
        for (gain, cell) in gains.iter_mut().zip(&self.cells) {
            let cell = *cell as usize;
            if self.state[cell] & BORDER == 0 {
                for beside in [cell - 1, cell + 1, cell - self.width, cell + self.width] {
                    let most = self.lava[cell].min(self.lava[beside]);
                    if most > 0.0 && self.state[beside] & BORDER == 0 {
                        *gain += 0.125 * (height[beside] - height[cell]).clamp(-most, most);
                    }
                }
            }
        }
        for (gain, cell) in gains.iter().zip(&self.cells) {
            let cell = *cell as usize;
            self.lava[cell] += gain;
            height[cell] += gain;
        }
    }

    /// Makes the lava a part of the ground.
    fn freeze(&mut self, ground: &mut Ground, age: f32) {
        for cell in self.cells.drain(..).map(|cell| cell as usize) {
            if self.lava[cell] > 0.0 {
                ground.lava[cell] += self.lava[cell] as f32;
                ground.age[cell] = age;
            }
            self.lava[cell] = 0.0;
            self.stiffness[cell] = 1.0;
            self.way[cell] = f32::INFINITY;
            self.through[cell] = 0.0;
            self.state[cell] &= BORDER;
        }
    }
}
