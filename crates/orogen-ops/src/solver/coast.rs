//! Coasts.

use crate::lower::{Lowering, Passes};
use crate::op::{Context, Reading, Solution, Solver, Sources, WorldParams};
use orogen_grid::coast::Coast as Law;
use orogen_grid::error::Result;
use orogen_grid::grid::Window;

op! {
    /// Ground after waves have worked on its shore: cliffs, shore platforms, beaches, spits, lagoons and tombolos.
    ///
    /// Winds from 32 directions raise waves over their fetch (Sverdrup, Munk and Bretschneider; CERC 1977). The shore
    /// retreats by their power times the erodibility, slower behind wide platforms and where high cliffs fall down, and
    /// leaves a cliff and a platform. Sand of cliffs and rivers moves along the shore as the CERC formula says, and
    /// makes beaches with the profile h = A y^(2/3) of Dean (1977), mostly in bays. Where the shore turns away, sand
    /// goes on into water up to 12 m deep as a spit with a recurved end; before a bay it is a bar with a lagoon. Islets
    /// close to a shore are joined to it. Rivers keep their way to the sea, and inlets of lagoons open.
    /// Samples that waves do not reach keep their heights.
    ///
    /// The sea is what is not above `world.sea_level`, and goes on outside of the domain. Another `cell` gives similar
    /// coasts; a beach should be wider than one. Time grows with the domain, about 3 microseconds per sample.
    pub struct Coast = "coast", solver, revision 2;
    margin;
    inputs {
        /// The heights of the ground and of the sea floor.
        source: required,
        /// Factor on the retreat at each sample: 0.1 for granite, 1 for sandstone, 10 for clay.
        erodibility_factor: optional,
    }
    params {
        /// Duration. The sea has been at its level for about 6000 years.
        years: f64 = 6000.0, unit "yr", range 0.0 to 1e6;
        /// Retreat of a low coast open to the sea, as it begins: 0.01 to 1 m/yr.
        retreat: f64 = 0.1, unit "m/yr", range 0.0 to 100.0;
        /// Speed of strong winds.
        wind_speed: f64 = 14.0, unit "m/s", range 1.0 to 60.0;
        /// Direction that the main wind comes from, clockwise from north: 270 is a west wind.
        wind_direction: f64 = 270.0, unit "degrees", range -360.0 to 360.0;
        /// Share of the main wind, which blows from within about 45 degrees; the rest blows from all directions alike.
        wind_share: f64 = 0.5, range 0.0 to 1.0;
        /// Maximum fetch, also over the sea outside of the domain.
        fetch: f64 = 200_000.0, unit "m", range 10.0 to 1e7;
        /// Slope of cliffs. Where waves are weak, debris of 33 degrees stays.
        cliff_angle: f64 = 60.0, unit "degrees", range 5.0 to 80.0;
        /// Slope of shore platforms: 0.01 to 0.05.
        platform_slope: f64 = 0.015, range 0.0 to 1.0;
        /// Share of sand in what cliffs and rivers bring. 0 makes no beaches.
        sand_share: f64 = 0.1, range 0.0 to 1.0;
        /// Mean denudation of the land, which rivers bring to the sea: 0.01 in flat land to 1 in high mountains.
        denudation: f64 = 0.05, unit "mm/yr", range 0.0 to 100.0;
        /// Size of the grains of sand: 0.15 for gentle beaches, 2 and more for steep ones of gravel.
        grain_size: f64 = 0.3, unit "mm", range 0.05 to 100.0;
        /// Height of exposed beaches above the sea.
        berm: f64 = 2.0, unit "m", range 0.0 to 20.0;
        /// How far sand moves along the shore.
        reach: f64 = 2000.0, unit "m", range 0.0 to 1e6;
        /// Share of the sand that makes spits, bars and tombolos, each as long as `reach` at most. 0 makes none.
        spits: f64 = 0.5, range 0.0 to 1.0;
        /// Cell size of the solution; 0 uses the world's cell.
        cell: f64 = 0.0, unit "m", range 0.0 to 1e6;
    }
    layers {
        /// Heights after the waves.
        height: height, unit "m";
        /// Thickness of the sand of beaches, spits, bars and tombolos.
        beach: height, unit "m";
        /// Power of the waves over that of a straight coast that faces the main wind; 0 on land.
        exposure: height;
        /// What the sea has taken (negative) and laid down.
        change: height, unit "m";
    }
}

/// The layers that are never negative.
const BEACH: usize = 1;
const EXPOSURE: usize = 2;

impl Coast {
    fn law(&self, sea_level: f64) -> Law {
        Law::default()
            .with_sea_level(sea_level)
            .with_years(self.years)
            .with_retreat(self.retreat)
            .with_wind_speed(self.wind_speed)
            .with_wind_direction(self.wind_direction)
            .with_wind_share(self.wind_share)
            .with_fetch(self.fetch)
            .with_cliff_angle(self.cliff_angle)
            .with_platform_slope(self.platform_slope)
            .with_sand_share(self.sand_share)
            .with_denudation(self.denudation)
            .with_grain_size(self.grain_size)
            .with_berm(self.berm)
            .with_reach(self.reach)
            .with_spits(self.spits)
    }
}

impl Solver for Coast {
    fn cell(&self, world_cell: f64) -> f64 {
        if self.cell > 0.0 { self.cell } else { world_cell }
    }

    fn reads_sea_level(&self) -> bool {
        true
    }

    fn scratch(&self, padded: &Window) -> u64 {
        self.law(0.0).memory(padded)
    }

    fn solve(&self, sources: &dyn Sources, context: &Context) -> Result<Solution> {
        let ground = super::terrain::heights(sources, context)?;
        let given = sources.given("erodibility_factor");
        let factor = given.then(|| sources.whole("erodibility_factor", sources.padded())).transpose()?;
        context.progress.check()?;
        let law = self.law(context.world_params.sea_level);
        let after = law.run(&ground, factor.as_ref(), context.progress)?;
        drop((ground, factor));
        let layers = [after.height, after.beach, after.exposure, after.change];
        let layers = layers.into_iter().map(|grid| sources.keep(grid)).collect::<Result<Vec<_>>>()?;
        Ok(Solution { layers, scalars: Vec::new() })
    }

    fn read(&self, solution: &Solution, asked: &Reading, out: &mut [f32]) -> Result<()> {
        solution.read_positive(&[BEACH, EXPOSURE], asked, out)
    }

    fn lower(&self, _: &Window, _: &[bool], _: &WorldParams) -> Lowering<Passes> {
        Lowering::Processor("the shore moves from cell to cell, in order of time")
    }

    fn cost(&self) -> f64 {
        3000.0
    }
}
