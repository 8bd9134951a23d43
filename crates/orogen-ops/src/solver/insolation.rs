//! Solar energy that the ground receives.

use super::terrain;
use crate::budget::memory;
use crate::lower::{Lowering, Passes};
use crate::op::{Context, Solution, Solver, Sources, WorldParams};
use orogen_grid::analysis::clear_sky::ClearSky;
use orogen_grid::analysis::insolation::{Period, insolation};
use orogen_grid::error::Result;
use orogen_grid::grid::Window;

op! {
    /// Solar energy on the source, on an average day of a period, under a clear sky: direct, diffuse and reflected
    /// light, with cast shadows.
    ///
    /// Clear-sky model of the European Solar Radiation Atlas (Rigollier, Bauer and Wald 2000), with Muneer's model
    /// (1990) of diffuse light on slopes. The sun's position follows Spencer's series (1971), in true solar time. One
    /// day represents at most 30 days, and the middle of each `step` represents the step. Shadows have no maximum
    /// length; the earth's curvature is neglected. Time grows with the world and the number of sun positions: about 25
    /// per day, 300 for a year. Memory is 28 bytes per cell.
    pub struct Insolation = "insolation", solver, revision 1;
    margin;
    inputs {
        /// Heights above sea level.
        source: required,
    }
    params {
        /// Latitude; positive north of the equator.
        latitude: f64 = 45.0, unit "degrees", range -90.0 to 90.0;
        /// First and last day of the year, 1 to 365. If the first is greater than the last, the period includes the
        /// turn of the year.
        days: [f64; 2] = [1.0, 365.0], range 1.0 to 365.0;
        /// Maximum time step within a day.
        step: f64 = 0.5, unit "h", range 0.01 to 6.0;
        /// Linke turbidity of the air: 1 clean and dry, 3 typical, 6 hazy.
        turbidity: f64 = 3.0, range 1.0 to 10.0;
        /// Share of the light that the surrounding ground reflects.
        albedo: f64 = 0.2, range 0.0 to 1.0;
    }
    layers {
        /// Energy on an average day.
        energy: height, unit "kWh/m^2";
    }
}

impl Solver for Insolation {
    fn scratch(&self, padded: &Window) -> u64 {
        memory(padded, 28)
    }

    fn solve(&self, sources: &dyn Sources, context: &Context) -> Result<Solution> {
        let heights = terrain::heights(sources, context)?;
        let period = Period::new(self.latitude, self.days.map(|day| day.round() as u16)).with_step(self.step);
        let sky = ClearSky::default().with_turbidity(self.turbidity).with_albedo(self.albedo);
        let energy = insolation(&heights, &period, &sky, context.progress)?;
        drop(heights);
        Ok(Solution { layers: vec![sources.keep(energy)?], scalars: Vec::new() })
    }

    fn lower(&self, _: &Window, _: &[bool], _: &WorldParams) -> Lowering<Passes> {
        Lowering::Processor("angles of the sun and of horizons are sums in f64")
    }

    fn cost(&self) -> f64 {
        // One sun position costs about 20 ns per sample.
        let [first, last] = self.days;
        let days = if last >= first { last - first } else { last - first + 365.0 };
        20.0 * ((days + 1.0) / 30.0).ceil() * 12.0 / self.step
    }
}
