//! Rain over mountains.

use super::terrain;
use crate::budget::memory;
use crate::lower::{Lowering, Passes};
use crate::op::{Context, Reading, Solution, Solver, Sources, WorldParams};
use orogen_grid::climate::orographic::OrographicRain as Law;
use orogen_grid::error::{Error, ErrorKind, Result};
use orogen_grid::grid::Window;

op! {
    /// Rain of a year by the linear theory of orographic precipitation (Smith and Barstad 2004): it is wet where the
    /// wind blows uphill, and dry in the lee of mountains.
    ///
    /// Air that the ground lifts condenses water, which drifts with the wind while it turns into rain and falls;
    /// descending air takes water up. The theory is a factor for each wave of the heights: P = Cw i sigma h / ((1 - i m
    /// Hw) (1 + i sigma tau_c) (1 + i sigma tau_f)) with the intrinsic frequency sigma and the vertical wavenumber m of
    /// the wave. The result is multiplied by `rain_hours` and added to `background`; negative sums become 0. The sea
    /// counts as level. The air does not lose the water that it rains: behind a range all sea winds are alike.
    ///
    /// Beyond the sides of the solved domain heights change smoothly to those of the opposite side; with a `margin`
    /// this happens further from the world. Rain varies over some kilometres, so a `cell` of 1 to 2 km is enough. Time
    /// grows with the domain, about 0.3 microseconds per sample; memory is 20 to 150 bytes per sample, more in small
    /// worlds, because sides become powers of two after a strip is added.
    pub struct OrographicRain = "orographic-rain", solver, revision 1;
    margin;
    inputs {
        /// The heights. The ground below the world's sea level counts as sea.
        source: required,
    }
    params {
        /// Wind speed while it rains.
        wind_speed: f64 = 15.0, unit "m/s", range 0.0 to 100.0;
        /// Direction that the wind comes from, clockwise from north: 270 is a west wind.
        wind_direction: f64 = 270.0, unit "degrees", range -360.0 to 360.0;
        /// Nm: moist stability frequency. Stable air (0.01) flows around the ground more than over it: there is less
        /// rain, and it begins before the mountain.
        stability: f64 = 0.005, unit "1/s", range 0.0 to 0.1;
        /// tau_c: time in which cloud water turns into rain and snow, 200 to 2000 s.
        conversion_time: f64 = 1000.0, unit "s", range 0.0 to 1e5;
        /// tau_f: time in which rain and snow fall to the ground, 200 to 2000 s.
        fallout_time: f64 = 1000.0, unit "s", range 0.0 to 1e5;
        /// Hw: scale height of water vapour.
        vapor_height: f64 = 2500.0, unit "m", range 0.0 to 10000.0;
        /// Cw: condensed water for each metre of lifting; 0.001 in cold air and 0.01 in warm air.
        uplift_sensitivity: f64 = 0.004, unit "kg/m^3", range 0.0 to 0.1;
        /// Rain of a year where the ground is level.
        background: f64 = 800.0, unit "mm/yr", range 0.0 to 20000.0;
        /// Hours of a year with this wind and rain: the factor from mm/h to mm/yr.
        rain_hours: f64 = 1000.0, unit "h/yr", range 0.0 to 8784.0;
        /// Cell size of the solution; 0 uses the world's cell.
        cell: f64 = 0.0, unit "m", range 0.0 to 1e6;
    }
    layers {
        /// Rain and snow of a year.
        rain: height, unit "mm/yr";
    }
}

impl OrographicRain {
    fn law(&self) -> Law {
        Law::default()
            .with_wind_speed(self.wind_speed)
            .with_wind_direction(self.wind_direction)
            .with_stability(self.stability)
            .with_conversion_time(self.conversion_time)
            .with_fallout_time(self.fallout_time)
            .with_vapor_height(self.vapor_height)
            .with_uplift_sensitivity(self.uplift_sensitivity)
            .with_background(self.background)
            .with_rain_hours(self.rain_hours)
    }
}

impl Solver for OrographicRain {
    fn cell(&self, world_cell: f64) -> f64 {
        if self.cell > 0.0 { self.cell } else { world_cell }
    }

    fn scratch(&self, padded: &Window) -> u64 {
        // The heights and the rain.
        memory(padded, 8).saturating_add(self.law().memory(padded))
    }

    fn reads_sea_level(&self) -> bool {
        true
    }

    fn solve(&self, sources: &dyn Sources, context: &Context) -> Result<Solution> {
        let heights = terrain::heights(sources, context)?;
        let rain = self.law().over(&heights, context.world_params.sea_level as f32, context.progress)?;
        drop(heights);
        Ok(Solution { layers: vec![sources.keep(rain)?], scalars: Vec::new() })
    }

    fn read(&self, solution: &Solution, asked: &Reading, out: &mut [f32]) -> Result<()> {
        let Some(rain) = solution.layers.first() else {
            return Err(Error::new(ErrorKind::Internal, "a solution has no rain"));
        };
        rain.read(asked.kind, asked.at, out)?;
        // Interpolation by the cubic may undershoot 0 next to dry ground.
        out.iter_mut().for_each(|rain| *rain = rain.max(0.0));
        Ok(())
    }

    fn lower(&self, _: &Window, _: &[bool], _: &WorldParams) -> Lowering<Passes> {
        Lowering::Processor("it is a Fourier transform in f64")
    }

    fn cost(&self) -> f64 {
        600.0
    }
}
