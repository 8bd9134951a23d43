//! Land that rises and is cut, step by step.

use super::accumulation::{Accumulation, accumulate};
use super::creep::creep_again;
use super::drainage;
use super::outlets::Outlets;
use super::points::Points;
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
    /// By how much of half a cell points stand off the lattice, 0 to 1. Between points off the lattice no way is scattered.
    pub irregular: f64,
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
        let salt = self.scattered.unwrap_or_default();
        let points = (self.irregular > 0.0).then(|| Points::new(*heights.window(), self.irregular, salt));
        let between = Ground { points: points.as_ref(), ..*ground };
        for step in 0..self.steps {
            go_on()?;
            // Other ways in each step: over the steps a slope's water spreads as wide as it would in nature.
            let descent = match (&points, self.scattered) {
                (Some(points), _) => Descent::Between(points),
                (None, Some(seed)) => Descent::Scattered(seed.wrapping_add(step)),
                (None, None) => Descent::Steepest,
            };
            self.cut(heights, &outlets, &between, descent, years);
            creep_again(heights, &outlets, years * self.creep, &mut buffers);
        }
        go_on()?;
        let mut last = *self;
        if let Some(points) = &points {
            points.onto_lattice(heights, &outlets);
            // What was too steep has slid between the points; along the lattice it would fall into facets after all.
            last.law.steepest = f64::INFINITY;
        }
        last.cut(heights, &outlets, ground, Descent::Steepest, 0.0);
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
        Erosion { law: StreamPower::default(), creep: 1e-6, years: 1e5, steps: 4, scattered: Some(1), irregular: 0.0 }
    }

    fn eroded(heights: &Grid, erosion: &Erosion, sea: Option<f32>) -> Grid {
        let mut out = heights.clone();
        erosion.run(&mut out, &Ground::default(), sea, &|| Ok(())).unwrap();
        out
    }

    #[test]
    fn every_cell_drains_downhill_and_the_sea_stays() {
        for heights in samples::grids() {
            for (sea, irregular) in [(None, 0.0), (Some(250.0), 0.0), (None, 1.0), (Some(250.0), 0.6)] {
                let outlets = Outlets::new(&heights, sea);
                let out = eroded(&heights, &Erosion { irregular, ..erosion() }, sea);
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
            pool.install(|| {
                [0.0, 1.0].map(|irregular| eroded(&heights, &Erosion { irregular, ..erosion() }, Some(100.0)))
            })
        };
        let one = run(1);
        assert!(one[0] != heights && one[0] != one[1] && [2, 3, 8].map(run).iter().all(|other| *other == one));
    }

    #[test]
    fn slopes_between_irregular_points_do_not_face_the_grids_directions() {
        // Ground that rises until it stands at the talus angle all over.
        let heights = samples::hills(160, 160, 3);
        let aligned = |irregular: f64| {
            let law = StreamPower { uplift: 1.0, erodibility: 1e-6, steepest: 0.8, ..StreamPower::default() };
            let run = Erosion { law, irregular, years: 1e6, steps: 60, creep: 1e-6, scattered: Some(1) };
            let out = eroded(&heights, &run, None);
            let mut bins = [0u32; 9];
            for j in 10..150 {
                for i in 10..150 {
                    let east = out.get(i + 1, j) - out.get(i - 1, j);
                    let south = out.get(i, j + 1) - out.get(i, j - 1);
                    let off = libm::atan2(f64::from(south), f64::from(east)).to_degrees().rem_euclid(45.0);
                    bins[((off / 5.0) as usize).min(8)] += 1;
                }
            }
            f64::from(bins[4]) / f64::from(bins.iter().sum::<u32>())
        };
        // On the lattice nearly all face what lies between two of its directions; otherwise each ninth has its ninth.
        let (regular, irregular) = (aligned(0.0), aligned(1.0));
        assert!(regular > 0.9 && (0.08..0.14).contains(&irregular), "{regular} {irregular}");
    }

    #[test]
    fn it_stops_when_asked() {
        let mut heights = samples::hills(20, 20, 3);
        let stop = || Err(Error::new(ErrorKind::Cancelled, "stop"));
        assert!(erosion().run(&mut heights, &Ground::default(), None, &stop).is_err());
    }
}
