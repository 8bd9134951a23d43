//! Volcanoes by their eruptions: flows of lava, cinder cones, and a caldera.
//!
//! Eruptions follow each other in time. Each releases lava that flows over the ground as it is then, as a Bingham
//! fluid (Hulme 1974) on cells (Ishihara, Iguchi and Kamo 1990; Miyamoto and Sasaki 1997), and builds a cone of cinders
//! (Wood 1980). A caldera is the ground that sinks where the magma was (Lipman 1997). Cells of a flow are visited in
//! the order in which the lava reached them, on one thread, with sums in f64.

mod caldera;
mod cones;
mod flow;
mod vents;

use crate::error::{Error, ErrorKind, Result};
use crate::grid::{Grid, Window};
use crate::progress::Progress;
use crate::random::Random;
use flow::Flow;
use vents::Vents;

/// A volcano's eruptions.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Lava {
    /// Number of eruptions.
    pub eruptions: u32,
    /// Minimum and maximum volume of an eruption, in m^3.
    pub volume: [f64; 2],
    /// Yield strength of lava at the vent, in Pa.
    pub yield_strength: f64,
    /// Volume of lava per time, in m^3/s.
    pub effusion: f64,
    /// Mean share of ash and cinders in the volume.
    pub ash: f64,
    /// Diameter of the caldera, in metres; 0 makes none.
    pub caldera: f64,
    /// Seed of places and volumes.
    pub seed: u64,
}

impl Default for Lava {
    /// The defaults of the op `lava`.
    fn default() -> Lava {
        Lava {
            eruptions: 40,
            volume: [1e7, 1e8],
            yield_strength: 2e4,
            effusion: 20.0,
            ash: 0.15,
            caldera: 0.0,
            seed: 0,
        }
    }
}

orogen_noise::builder!(
    Lava:
    with_eruptions(eruptions: u32),
    with_volume(volume: [f64; 2]),
    with_yield_strength(yield_strength: f64),
    with_effusion(effusion: f64),
    with_ash(ash: f64),
    with_caldera(caldera: f64),
    with_seed(seed: u64)
);

/// Ground after the eruptions.
#[derive(Debug, Clone, PartialEq)]
pub struct Erupted {
    /// Heights, in metres.
    pub height: Grid,
    /// Thickness of the lava, in metres.
    pub lava: Grid,
    /// Thickness of ash and cinders, in metres.
    pub ash: Grid,
    /// Age of the surface: 0 after the last eruption, 1 before the first.
    pub age: Grid,
    /// The volumes of all eruptions.
    pub volumes: Volumes,
}

/// Volumes in m^3. The heights gain `lava + ash - collapsed - left`.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Volumes {
    /// Lava that was released.
    pub lava: f64,
    /// Ash and cinders that fell, less the ground that was blown out of craters.
    pub ash: f64,
    /// Ground that sank.
    pub collapsed: f64,
    /// Lava that flowed over the border.
    pub left: f64,
}

/// Density of lava times gravity, in N/m^3.
const WEIGHT: f64 = 2500.0 * 9.81;

/// The caldera sinks after this share of the eruptions, by this share of the volume that they brought up: the chamber
/// is refilled between eruptions, and empty at the last one (Geshi, Ruch and Acocella 2014).
const COLLAPSE: f64 = 0.6;
const EMPTIED: f64 = 0.25;

/// Ground and what lies on it, during the eruptions.
struct Ground {
    window: Window,
    height: Vec<f64>,
    lava: Vec<f32>,
    ash: Vec<f32>,
    age: Vec<f32>,
}

impl Ground {
    /// The cells within a distance of a position in cells.
    fn around(&self, [x, y]: [f64; 2], reach: f64) -> impl Iterator<Item = (usize, [f64; 2])> + use<> {
        let end = |at: f64, side: usize| ((at + reach).floor() as i64 + 1).clamp(0, side as i64) as usize;
        let start = |at: f64| (at - reach).ceil().max(0.0) as usize;
        let (columns, rows) = (start(x)..end(x, self.window.width), start(y)..end(y, self.window.height));
        let width = self.window.width;
        rows.flat_map(move |j| columns.clone().map(move |i| (j * width + i, [i as f64 - x, j as f64 - y])))
    }

    /// Raises or lowers a cell by ash: what is blown away is first ash, then lava, then ground.
    fn shift(&mut self, cell: usize, by: f64, age: f32) {
        self.height[cell] += by;
        let ash = f64::from(self.ash[cell]) + by;
        self.ash[cell] = ash.max(0.0) as f32;
        self.lava[cell] = (f64::from(self.lava[cell]) + ash.min(0.0)).max(0.0) as f32;
        self.age[cell] = age;
    }

    /// Lowers a cell with what lies on it.
    fn sink(&mut self, cell: usize, by: f64, age: f32) {
        self.height[cell] -= by;
        self.age[cell] = age;
    }
}

impl Lava {
    /// Memory in bytes of [`Lava::run`] over a window, with its grids.
    #[must_use]
    pub fn memory(&self, window: &Window) -> u64 {
        // Two grids before, the heights, four grids after, and the planes of a flow.
        (window.len() as u64).saturating_mul(2 * 4 + 8 + 4 * 4 + flow::BYTES)
    }

    /// The ground after all eruptions. `vents` has the likelihood of a vent at each sample, relative to the others;
    /// without it vents may be anywhere.
    ///
    /// # Errors
    /// If the grids have different windows, or the work is cancelled.
    pub fn run(&self, ground: &Grid, vents: Option<&Grid>, progress: &Progress) -> Result<Erupted> {
        let window = *ground.window();
        if vents.is_some_and(|vents| *vents.window() != window) {
            return Err(Error::new(ErrorKind::Request, "the ground and its vents must have the same window"));
        }
        let mut state = Ground {
            window,
            height: ground.data().iter().map(|height| f64::from(*height)).collect(),
            lava: vec![0.0; window.len()],
            ash: vec![0.0; window.len()],
            age: vec![1.0; window.len()],
        };
        let mut volumes = Volumes::default();
        if let Some(vents) = Vents::new(ground, vents) {
            self.erupt(&mut state, &vents, &mut volumes, progress)?;
        }
        let grid = |data: Vec<f32>| {
            Grid::from_data(window, data).ok_or_else(|| Error::new(ErrorKind::Internal, "a plane of another length"))
        };
        Ok(Erupted {
            height: grid(state.height.iter().map(|height| *height as f32).collect())?,
            lava: grid(state.lava)?,
            ash: grid(state.ash)?,
            age: grid(state.age)?,
            volumes,
        })
    }

    fn erupt(&self, ground: &mut Ground, vents: &Vents, volumes: &mut Volumes, progress: &Progress) -> Result<()> {
        let mut flow = Flow::new(&ground.window, self);
        let count = self.eruptions;
        let collapse = (f64::from(count) * COLLAPSE) as u32;
        progress.expect(f64::from(count));
        for eruption in 0..count {
            let age = (1.0 - f64::from(eruption + 1) / f64::from(count)) as f32;
            let mut random = Random::new(self.seed, u64::from(eruption));
            let vent = vents.draw(&mut random);
            // As many eruptions between 1 and 2 as between 2 and 4 units of volume.
            let [least, most] = self.volume;
            let volume = least * libm::pow((most / least).max(1.0), random.share());
            let ash = volume * (2.0 * self.ash * random.share()).min(1.0);
            let lava = volume - ash;
            volumes.lava += lava;
            volumes.left += flow.run(ground, vent, lava, age, progress)?;
            volumes.ash += cones::build(ground, vent, ash, age);
            if self.caldera > 0.0 && eruption == collapse {
                let emptied = EMPTIED * (volumes.lava + volumes.ash);
                volumes.collapsed += caldera::collapse(ground, vents.center(), self.caldera, emptied, age, &mut random);
            }
            progress.step(1.0)?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests;
