//! Land that rises and is cut, step by step.

use super::accumulation::{Accumulation, accumulate};
use super::creep::creep_again;
use super::drainage;
use super::outlets::Outlets;
use super::steepest::Descent;
use super::stream_power::{Ground, StreamPower};
use crate::error::Result;
use crate::grid::Grid;

/// A run of the stream power law.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Erosion {
    /// How rivers cut.
    pub law: StreamPower,
    /// How fast soil creeps: the diffusivity, in m^2 a year.
    pub creep: f64,
    /// How long it goes on, in years.
    pub years: f64,
    /// In how many steps. In each the water finds its way anew.
    pub steps: u32,
    /// Hashed into the scattered ways of the water in each step; none for the steepest way always.
    pub scattered: Option<u32>,
}

impl Erosion {
    /// Erodes `heights`, whose sea, if it has one, and whose border stay as they are. `go_on` is asked before each step and ends
    /// the run with its error.
    ///
    /// In the end every cell stands higher than the one it drains to: no depressions and no flats are left. Returns how the
    /// water runs then, by the steepest descent. Costs O(cells) a step.
    ///
    /// # Errors
    /// Those of `go_on`.
    pub fn run(
        &self,
        heights: &mut Grid,
        ground: &Ground,
        sea_level: Option<f32>,
        go_on: &dyn Fn() -> Result<()>,
    ) -> Result<Accumulation> {
        let outlets = Outlets::new(heights, sea_level);
        let years = self.years / f64::from(self.steps.max(1));
        let mut buffers = Vec::new();
        for step in 0..self.steps {
            go_on()?;
            // Other ways in each step: over the steps a slope's water spreads as wide as it would in nature.
            let descent = self.scattered.map_or(Descent::Steepest, |seed| Descent::Scattered(seed.wrapping_add(step)));
            self.cut(heights, &outlets, ground, descent, years);
            creep_again(heights, &outlets, years * self.creep, &mut buffers);
        }
        go_on()?;
        self.cut(heights, &outlets, ground, Descent::Steepest, 0.0);
        Ok(accumulate(&drainage::over_surface(heights, &outlets, Descent::Steepest)))
    }

    fn cut(&self, heights: &mut Grid, outlets: &Outlets, ground: &Ground, descent: Descent, years: f64) {
        let receivers = drainage::over_bed(heights, outlets, descent).receivers;
        self.law.step(heights, &receivers, &accumulate(&receivers), ground, years);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::error::{Error, ErrorKind};
    use crate::hydrology::samples;

    fn erosion() -> Erosion {
        Erosion { law: StreamPower::default(), creep: 1e-6, years: 1e5, steps: 4, scattered: Some(1) }
    }

    fn eroded(heights: &Grid, erosion: &Erosion, sea: Option<f32>) -> Grid {
        let mut out = heights.clone();
        erosion.run(&mut out, &Ground::default(), sea, &|| Ok(())).unwrap();
        out
    }

    #[test]
    fn every_cell_drains_downhill_and_the_sea_stays() {
        for heights in samples::grids() {
            for sea in [None, Some(250.0)] {
                let outlets = Outlets::new(&heights, sea);
                let out = eroded(&heights, &erosion(), sea);
                let receivers = super::super::steepest::receivers(&out, &outlets, Descent::Steepest);
                for c in 0..out.data().len() {
                    match outlets.at(c) {
                        true => assert_eq!(out.data()[c].to_bits(), heights.data()[c].to_bits()),
                        false => assert!(receivers.of(c) != c && out.data()[c] > out.data()[receivers.of(c)]),
                    }
                }
            }
        }
    }

    #[test]
    fn any_number_of_threads_makes_the_same() {
        let heights = samples::hills(150, 130, 3);
        let run = |threads: usize| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            pool.install(|| eroded(&heights, &erosion(), Some(100.0)))
        };
        let one = run(1);
        assert!(one != heights && [2, 3, 8].map(run).iter().all(|other| *other == one));
    }

    #[test]
    fn it_stops_when_asked() {
        let mut heights = samples::hills(20, 20, 3);
        let stop = || Err(Error::new(ErrorKind::Cancelled, "stop"));
        assert!(erosion().run(&mut heights, &Ground::default(), None, &stop).is_err());
    }
}
