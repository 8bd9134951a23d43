//! Volcanoes.

use crate::lower::{Lowering, Passes};
use crate::op::{Context, Reading, Solution, Solver, Sources, WorldParams};
use orogen_grid::error::Result;
use orogen_grid::grid::Window;
use orogen_grid::lava::Lava as Law;
use orogen_grid::words::number;

op! {
    /// Ground after the eruptions of volcanoes: flows of lava with levees and steep fronts, cinder cones, and a
    /// caldera.
    ///
    /// Eruptions follow each other. Lava is a Bingham fluid: it flows to lower neighbors as far as it is thicker than
    /// `yield_strength` / (density gravity slope) (Hulme 1974; Miyamoto and Sasaki 1997), with a density of 2500
    /// kg/m^3. It gets stiffer on its way, by e^2 over the length that Walker (1973) gives for the `effusion`. So flows
    /// follow valleys, divide, fill hollows and end in lobes; later ones flow over and around them. Cinders build a
    /// cone with a slope of 31 degrees, 0.18 as high as wide, with a crater of 0.4 of its width (Wood 1980).
    ///
    /// Volume is kept: what is erupted is the gain of the heights, up to rounding, less what sinks in the caldera and
    /// what flows over the border of the domain. Time grows with the volume and with 1 / `cell`^2: about 2 s for a
    /// cubic kilometre of lava at 20 m.
    pub struct Lava = "lava", solver, revision 1;
    margin;
    inputs {
        /// The heights of the ground before.
        source: required,
        /// Likelihood of a vent at each sample, relative to others; no vents where it is 0 or less. Without it vents
        /// may be anywhere.
        vents: optional,
    }
    params {
        /// Seed of the node, hashed with the world's seed, for the places and volumes of eruptions.
        seed: u64 = 0;
        /// Number of eruptions.
        eruptions: u32 = 40, range 0 to 100_000;
        /// Minimum and maximum volume of an eruption, lava and ash. Small ones are more frequent: the number above a
        /// volume falls with its logarithm.
        volume: [f64; 2] = [5e6, 1e8], unit "m^3", range 1e-3 to 1e13;
        /// Yield strength of lava at the vent: 100 to 5000 Pa for basalt, 10 000 to 100 000 for andesite, more for
        /// dacite. Flows are as thick as it is large.
        yield_strength: f64 = 50_000.0, unit "Pa", range 1.0 to 1e8;
        /// Volume of lava per time: 1 to 1000 m^3/s. Fast flows are long and wide.
        effusion: f64 = 20.0, unit "m^3/s", range 1e-3 to 1e7;
        /// Mean share of ash and cinders in the volume; it varies from 0 to twice that. 0 makes no cones.
        ash: f64 = 0.2, range 0.0 to 1.0;
        /// Diameter of the floor of a caldera at the mean position of the vents. It sinks after 0.6 of the eruptions by
        /// a quarter of their volume, at most half as deep as wide. 0 makes none.
        caldera: f64 = 0.0, unit "m", range 0.0 to 1e6;
        /// Cell size of the solution; 0 uses the world's cell.
        cell: f64 = 0.0, unit "m", range 0.0 to 1e6;
    }
    layers {
        /// Heights after the eruptions.
        height: height, unit "m";
        /// Thickness of all lava.
        lava: height, unit "m";
        /// Thickness of ash and cinders.
        ash: height, unit "m";
        /// Age of the surface: 0 after the last eruption, 1 before the first.
        age: label;
    }
    check |op| match op.volume {
        [least, most] if least > most => Err((
            "volume",
            format!("the first of `volume` ({}) must not be more than the second ({})", number(least), number(most)),
        )),
        _ => Ok(()),
    };
}

/// The layers with a thickness.
const LAVA: usize = 1;
const ASH: usize = 2;

impl Lava {
    fn law(&self, seed: u64) -> Law {
        Law::default()
            .with_eruptions(self.eruptions)
            .with_volume(self.volume)
            .with_yield_strength(self.yield_strength)
            .with_effusion(self.effusion)
            .with_ash(self.ash)
            .with_caldera(self.caldera)
            .with_seed(seed)
    }
}

impl Solver for Lava {
    fn cell(&self, world_cell: f64) -> f64 {
        if self.cell > 0.0 { self.cell } else { world_cell }
    }

    fn scratch(&self, padded: &Window) -> u64 {
        self.law(0).memory(padded)
    }

    fn solve(&self, sources: &dyn Sources, context: &Context) -> Result<Solution> {
        let ground = super::terrain::heights(sources, context)?;
        let vents = sources.given("vents").then(|| sources.whole("vents", sources.padded())).transpose()?;
        context.progress.check()?;
        let law = self.law(context.world_params.seed_of(self.seed));
        let after = law.run(&ground, vents.as_ref(), context.progress)?;
        drop((ground, vents));
        let layers = [after.height, after.lava, after.ash, after.age];
        let layers = layers.into_iter().map(|grid| sources.keep(grid)).collect::<Result<Vec<_>>>()?;
        Ok(Solution { layers, scalars: Vec::new() })
    }

    fn read(&self, solution: &Solution, asked: &Reading, out: &mut [f32]) -> Result<()> {
        solution.read_positive(&[LAVA, ASH], asked, out)
    }

    fn lower(&self, _: &Window, _: &[bool], _: &WorldParams) -> Lowering<Passes> {
        Lowering::Processor("lava flows from cell to cell, in f64")
    }

    fn cost(&self) -> f64 {
        2000.0
    }
}
