//! Drops of rain cut gullies and lay down fans.

use crate::erosion::droplets::Droplets as Law;
use crate::error::Result;
use crate::grid::{Grid, Window};
use crate::op::{Context, Filter};

op! {
    /// Hydraulic erosion by droplets: each runs downhill, cuts where it is fast and lays down where it slows: gullies on slopes, sediment in hollows.
    ///
    /// After Beyer, "Implementation of a method for hydraulic erosion" (2015), with lengths in metres. A droplet goes a cell at a time and
    /// can carry capacity * max(slope, least_slope) * speed * water; it gains speed by v^2 = v^2 + gravity * drop. It cuts no deeper than the
    /// drop ahead of it, and in the end lays down all that it carries: mass is kept to rounding.
    ///
    /// Droplets that follow one another make what comes out depend on their order. Here they start at hashed places, in batches: all of a batch see
    /// the same ground, what they do is summed in fixed point, so tiles and threads make the same bits. After each batch what was laid down slides
    /// apart in 16 passes, or all that end in one hollow would pile up. A batch looks lifetime + radius and 18 cells far, and the
    /// window is made with so much more on each side for each. More batches make longer, deeper gullies. What comes out depends
    /// on the cell. About a microsecond a droplet of 30 cells.
    pub struct Droplets = "droplets", filter, revision 1;
    inputs {
        /// The ground to begin with.
        source: required,
    }
    params {
        /// How many droplets, in all batches together.
        density: f64 = 5000.0, unit "1/km^2", range 0.0 to 1e9;
        /// In how many batches.
        batches: u32 = 4, range 1.0 to 1000.0;
        /// How far a droplet goes at most.
        lifetime: f64 = 300.0, unit "m", range 0.0 to 1e6;
        /// How wide a droplet cuts.
        radius: f64 = 30.0, unit "m", range 0.0 to 1e5;
        /// The share of its direction that a droplet keeps at each cell: 0 follows the slope, near 1 runs straight on.
        inertia: f64 = 0.05, range 0.0 to 0.99;
        /// Ground carried down a sheer slope for each m/s, as a depth over the land that the droplet stands for.
        capacity: f64 = 0.4, unit "s", range 0.0 to 1000.0;
        /// The slope (rise over run) that capacity counts at least.
        least_slope: f64 = 0.01, range 0.0 to 10.0;
        /// The share of what could still be carried that is cut at each cell.
        erosion: f64 = 0.3, range 0.0 to 1.0;
        /// The share of what is too much to carry that is laid down at each cell.
        deposition: f64 = 0.3, range 0.0 to 1.0;
        /// The share of its water that a droplet loses each metre.
        evaporation: f64 = 0.001, unit "1/m", range 0.0 to 1.0;
        /// How fast droplets become quick.
        gravity: f64 = 4.0, unit "m/s^2", range 0.0 to 1000.0;
        /// Which droplets.
        seed: u64 = 0;
    }
}

impl Filter for Droplets {
    fn halo(&self, cell: f64) -> usize {
        self.law(0).halo(cell)
    }

    fn scratch(&self, window: &Window) -> u64 {
        // The heights twice, two sums of eight bytes, four planes while what was laid down slides.
        40 * window.grown(self.halo(window.cell)).len() as u64
    }

    fn apply(
        &self,
        inputs: &[Option<&Grid>],
        window: &Window,
        out: &mut [Option<Grid>],
        context: &Context,
    ) -> Result<()> {
        let ([Some(source)], [Some(out)]) = (inputs, out) else { return Ok(()) };
        if window.is_empty() {
            return Ok(());
        }
        *out = self.law(context.world_params.seed_of(self.seed)).run(source, context.progress)?;
        Ok(())
    }

    fn cost(&self, cell: f64) -> f64 {
        let steps = (self.lifetime / cell).ceil();
        100.0 + self.density * cell * cell / 1e6 * (100.0 + 30.0 * steps)
    }
}

impl Droplets {
    fn law(&self, seed: u64) -> Law {
        Law {
            density: self.density,
            batches: self.batches as usize,
            lifetime: self.lifetime,
            radius: self.radius,
            inertia: self.inertia,
            capacity: self.capacity,
            least_slope: self.least_slope,
            erosion: self.erosion,
            deposition: self.deposition,
            evaporation: self.evaporation,
            gravity: self.gravity,
            seed,
        }
    }
}
