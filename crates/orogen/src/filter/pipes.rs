//! Running water cuts and lays down.

use crate::erosion::pipe_rows::{BED, DEPTH, SEDIMENT};
use crate::erosion::pipes::{Pipes as Law, RADIUS, Wet};
use crate::error::Result;
use crate::grid::{Grid, Window};
use crate::op::{Context, Filter};

op! {
    /// Hydraulic erosion by rain on a grid of virtual pipes: water runs off, cuts gullies, gathers and lays down what it carries.
    ///
    /// After Mei, Decaudin and Hu (2007) and Stava et al. (2008). Water flows between neighbouring cells as the difference of its
    /// surfaces pulls; it can carry sin(slope) times its discharge times `capacity`, cuts where it carries less and lays down where it
    /// carries more. Sediment moves with the water that crosses each side (not along the velocity as in Mei), so mass is kept to
    /// rounding. What is cut or laid down is shared over 3 x 3 cells, no cut is deeper than half way to the lowest neighbour, nothing laid down
    /// higher than the neighbours' mean and a quarter of the water: no grooves along the grid, no pits, no spikes.
    ///
    /// The storm is a quick one, rain and erosion far above nature's: what counts is rain times iterations. Water comes no farther than
    /// a cell an iteration; each looks three cells far, and the window is made with so much more on each side. `bake` long ones. What
    /// comes out depends on the cell. About 4 ns a sample and iteration.
    pub struct Pipes = "pipes", filter, revision 1;
    inputs {
        /// The ground to begin with, dry.
        source: required,
    }
    params {
        /// How many iterations.
        iterations: u32 = 100, range 0.0 to 10000.0;
        /// How much rain falls each second.
        rain: f64 = 2.0, unit "mm/s", range 0.0 to 1000.0;
        /// The share of the water that goes into the air each second.
        evaporation: f64 = 0.01, unit "1/s", range 0.0 to 1.0;
        /// How much sediment, as metres of ground, 1 m^2/s of water carries down a sheer slope.
        capacity: f64 = 2.0, unit "s/m", range 0.0 to 1000.0;
        /// The share of what could still be carried that is cut each second.
        erosion: f64 = 0.3, unit "1/s", range 0.0 to 10.0;
        /// The share of what is too much to carry that is laid down each second.
        deposition: f64 = 0.3, unit "1/s", range 0.0 to 10.0;
        /// The area of a pipe for each metre of a cell's side: the depth whose waves run as fast as the model's.
        pipe: f64 = 1.0, unit "m", range 1e-3 to 1000.0;
        /// The share of a pipe's flow that is lost each second.
        friction: f64 = 0.05, unit "1/s", range 0.0 to 10.0;
        /// The pull of the earth.
        gravity: f64 = 9.81, unit "m/s^2", range 1e-3 to 1000.0;
        /// How long an iteration is. What would not be stable, cell / (2 sqrt(gravity pipe)), takes its place if it is less.
        time_step: f64 = 1.0, unit "s", range 1e-6 to 1e6;
    }
    layers {
        /// The ground in the end.
        height: height, unit "m";
        /// How deep the water is.
        water: height, unit "m";
        /// What the water still carries, as metres of ground.
        sediment: height, unit "m";
        /// How fast the water runs.
        velocity: height, unit "m/s";
    }
}

impl Filter for Pipes {
    fn halo(&self, _: f64) -> usize {
        // One more for the velocity, which is between a cell's sides.
        RADIUS * self.iterations as usize + 1
    }

    fn scratch(&self, window: &Window) -> u64 {
        // Five planes, before, after, and in bands.
        60 * window.grown(self.halo(window.cell) + 1).len() as u64
    }

    fn apply(
        &self,
        inputs: &[Option<&Grid>],
        window: &Window,
        out: &mut [Option<Grid>],
        context: &Context,
    ) -> Result<()> {
        let [Some(source)] = inputs else { return Ok(()) };
        if window.is_empty() {
            return Ok(());
        }
        let law = self.law();
        let wet = law.open(Wet::new(source), self.iterations as usize, context.progress)?;
        let planes: [&dyn Fn() -> Grid; 4] =
            [&|| wet.plane(BED), &|| wet.plane(DEPTH), &|| carried(&wet), &|| wet.speed(&law)];
        for (layer, plane) in out.iter_mut().zip(planes) {
            if let Some(layer) = layer {
                layer.paste(&plane());
            }
        }
        Ok(())
    }

    fn cost(&self, _: f64) -> f64 {
        4.0 * f64::from(self.iterations)
    }
}

/// The sediment; where there is none, it may be off by the rounding of the bed.
fn carried(wet: &Wet) -> Grid {
    let mut carried = wet.plane(SEDIMENT);
    carried.data_mut().iter_mut().for_each(|metres| *metres = metres.max(0.0));
    carried
}

impl Pipes {
    fn law(&self) -> Law {
        Law {
            rain: self.rain / 1000.0,
            evaporation: self.evaporation,
            capacity: self.capacity,
            erosion: self.erosion,
            deposition: self.deposition,
            pipe: self.pipe,
            friction: self.friction,
            gravity: self.gravity,
            time_step: self.time_step,
        }
    }
}
