//! Worley's cellular noise.

use super::basis::fill;
use crate::op::{Field, Inputs, WorldParams};
use orogen_noise::Points;

choice! {
    /// What cellular noise tells about the points near a sample.
    pub enum Feature {
        /// The distance to the nearest point: dimples.
        F1 = "f1",
        /// The distance to the second nearest point.
        F2 = "f2",
        /// F2 - F1: zero on the edges between cells.
        Difference = "difference",
        /// F1 * F2.
        Product = "product",
        /// A value of its own for each cell.
        Value = "value",
        /// The distance to the nearest edge between cells: cracks.
        Edge = "edge",
    }
}

choice! {
    /// How cellular noise measures distance.
    pub enum Distance {
        /// The straight line: round cells.
        Euclidean = "euclidean",
        /// The sum along the axes: cells with slanted sides.
        Manhattan = "manhattan",
        /// The greatest along the axes: square cells.
        Chebyshev = "chebyshev",
    }
}

impl Feature {
    fn noise(self) -> orogen_noise::Feature {
        match self {
            Feature::F1 => orogen_noise::Feature::F1,
            Feature::F2 => orogen_noise::Feature::F2,
            Feature::Difference => orogen_noise::Feature::Difference,
            Feature::Product => orogen_noise::Feature::Product,
            Feature::Value => orogen_noise::Feature::Value,
            Feature::Edge => orogen_noise::Feature::Edge,
        }
    }
}

impl Distance {
    fn noise(self) -> orogen_noise::Distance {
        match self {
            Distance::Euclidean => orogen_noise::Distance::Euclidean,
            Distance::Manhattan => orogen_noise::Distance::Manhattan,
            Distance::Chebyshev => orogen_noise::Distance::Chebyshev,
        }
    }
}

op! {
    /// Worley's cellular noise, in -1 ..= 1: one point at random in each cell of a lattice, and how far the nearest of them are.
    ///
    /// A distance d becomes 2 d / greatest - 1, with the greatest there can be for the feature: F1 is -1 on the points, `edge` -1 on
    /// the edges between cells. No nearer point is ever missed, so there are no breaks. Worley, "A cellular texture basis function"
    /// (1996).
    pub struct Worley = "worley", field, revision 1;
    params {
        /// Seed of its own, hashed with the world's: two nodes of one seed are the same noise.
        seed: u64 = 0;
        /// Side of a cell: about the distance between points.
        wavelength: f64 = 1000.0, unit "m", range 1e-3 to 1e9;
        /// What is told about the points near a sample.
        feature: Feature = Feature::F1;
        /// How distance is measured.
        distance: Distance = Distance::Euclidean;
        /// How much of its cell a point may be in along each axis: 0 is its middle, a regular lattice; 1 all of it.
        jitter: f64 = 1.0, range 0.0 to 1.0;
    }
}

impl Field for Worley {
    fn eval(&self, at: &Points, _: &Inputs, world_params: &WorldParams, out: &mut [f32]) {
        let noise = orogen_noise::Worley {
            seed: world_params.seed_of(self.seed),
            wavelength: self.wavelength,
            distance: self.distance.noise(),
            feature: self.feature.noise(),
            jitter: self.jitter,
        };
        fill(out, |out| noise.fill(at, out));
    }

    // One octave of a wavelength looks at fewer cells than the finer ones of a fractal.
    fn cost(&self) -> f64 {
        if self.feature == Feature::Edge { 5.8 } else { 3.0 }
    }

    fn cost_in_rows(&self) -> f64 {
        if self.feature == Feature::Edge { 2.6 } else { 1.1 }
    }
}
