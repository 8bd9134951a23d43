//! Domain warp: the source read elsewhere.

use crate::op::{CoordMap, Field, Inputs, WorldParams};
use orogen_noise::Points;

op! {
    /// Domain warp: the value at p is the source's at p + strength * (x, y).
    ///
    /// `x` and `y` are usually noises in -1 ..= 1; displacements beyond `strength` along an axis are cut to it, so that the
    /// engine knows how far the source is read. Source: Perlin 1985 ("An Image Synthesizer"); Quilez, "Domain warping".
    pub struct Warp = "warp", field, revision 1;
    inputs {
        /// What is read elsewhere.
        source: required,
        /// Moves the reading east.
        x: required,
        /// Moves the reading south.
        y: required,
    }
    params {
        /// Distance moved where an input is 1.
        strength: f64 = 100.0, unit "m", range 0.0 to 1e6;
    }
}

impl Field for Warp {
    fn eval(&self, _: &Points, inputs: &Inputs, _: &WorldParams, out: &mut [f32]) {
        out.copy_from_slice(inputs.required(0));
    }

    fn coord_map(&self) -> Option<CoordMap> {
        Some(CoordMap::Displaced { source: 0, east: 1, south: 2, strength: self.strength, reach: self.strength })
    }
}
