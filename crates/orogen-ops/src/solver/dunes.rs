//! Dunes.

use crate::lower::{Lowering, Passes};
use crate::op::{Context, Reading, Solution, Solver, Sources, WorldParams};
use orogen_grid::dunes::Dunes as Law;
use orogen_grid::error::Result;
use orogen_grid::grid::Window;

op! {
    /// Ground with dunes: the wind moves sand until it forms barchans where there is little, transverse ridges where
    /// there is much, and long dunes along the mean wind where two winds alternate.
    ///
    /// The continuous model of Sauermann, Kroy and Herrmann (2001, 2002). The stress of the wind over heights h is 1 +
    /// A (|k| + i B k) h for each wave number k, with A = 2.4 and B = 0.6: it is highest a little before crests. The
    /// flux of sand follows the saturated flux over a saturation length, `wavelength` / 15.7. Behind crests, under a
    /// line that falls at 14 degrees, there is no wind. Sand slides where it is steeper than 33 degrees. All samples
    /// change at once. Sand is neither added nor lost: what leaves the domain enters it on the other side.
    ///
    /// A `cell` of an eighth of the `wavelength` or less shows dunes; at a twentieth slip faces are sharp. Time grows
    /// with `years`, `flux` and the fourth power of 1 / `cell`: about 30 ns per sample and step of 0.17 `cell`^2 /
    /// `flux` years.
    pub struct Dunes = "dunes", solver, revision 1;
    margin;
    inputs {
        /// The heights of the ground under the sand.
        source: required,
        /// Mean thickness of the sand at the beginning, in metres: 0.3 to 1 for barchans, 3 and more for ridges.
        sand: required,
    }
    params {
        /// Seed of the node, hashed with the world's seed, for the unevenness of the sand at the beginning.
        seed: u64 = 0;
        /// Distance between young dunes. Old ones are further apart, because small dunes catch up with larger ones.
        wavelength: f64 = 160.0, unit "m", range 1e-3 to 1e6;
        /// Flux of sand over level sand: 20 to 200 m^2/yr in deserts.
        flux: f64 = 100.0, unit "m^2/yr", range 0.0 to 1e6;
        /// Duration. Dunes are high after about 0.4 `wavelength`^2 / `flux` years.
        years: f64 = 110.0, unit "yr", range 0.0 to 1e7;
        /// Direction that the wind comes from, clockwise from north: 270 is a west wind.
        wind_direction: f64 = 270.0, unit "degrees", range -360.0 to 360.0;
        /// Angle between two winds that alternate, on both sides of `wind_direction`; 0 is one wind. From about 90 on,
        /// dunes are long and parallel to the mean wind.
        wind_spread: f64 = 0.0, unit "degrees", range 0.0 to 180.0;
        /// Cell size of the solution; 0 uses the world's cell.
        cell: f64 = 0.0, unit "m", range 0.0 to 1e6;
    }
    layers {
        /// Heights with the sand.
        height: height, unit "m";
        /// Thickness of the sand.
        sand: height, unit "m";
    }
}

/// The layer with the thickness.
const SAND: usize = 1;

impl Dunes {
    fn law(&self, seed: u64) -> Law {
        Law::default()
            .with_wavelength(self.wavelength)
            .with_flux(self.flux)
            .with_years(self.years)
            .with_wind_direction(self.wind_direction)
            .with_wind_spread(self.wind_spread)
            .with_seed(seed)
    }
}

impl Solver for Dunes {
    fn cell(&self, world_cell: f64) -> f64 {
        if self.cell > 0.0 { self.cell } else { world_cell }
    }

    fn scratch(&self, padded: &Window) -> u64 {
        self.law(0).memory(padded)
    }

    fn solve(&self, sources: &dyn Sources, context: &Context) -> Result<Solution> {
        let ground = super::terrain::heights(sources, context)?;
        let sand = sources.whole("sand", sources.padded())?;
        context.progress.check()?;
        let dunes = self.law(context.world_params.seed_of(self.seed)).run(&ground, &sand, context.progress)?;
        let layers =
            [dunes.height, dunes.sand].into_iter().map(|grid| sources.keep(grid)).collect::<Result<Vec<_>>>()?;
        Ok(Solution { layers, scalars: Vec::new() })
    }

    fn read(&self, solution: &Solution, asked: &Reading, out: &mut [f32]) -> Result<()> {
        solution.read_positive(&[SAND], asked, out)
    }

    fn lower(&self, _: &Window, _: &[bool], _: &WorldParams) -> Lowering<Passes> {
        Lowering::Processor("the wind is followed from line to line")
    }

    fn cost(&self) -> f64 {
        20_000.0
    }
}
