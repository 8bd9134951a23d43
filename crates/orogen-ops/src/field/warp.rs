//! Domain warp: reads the source at displaced positions.

use crate::op::{CoordMap, Field};

op! {
    /// Domain warp: the value at p is the source's value at p + strength * (x, y).
    ///
    /// `x` and `y` are usually noise in -1 ..= 1. Displacements beyond `strength` along an axis are limited to it, so
    /// that the engine knows how far from p the source is read. Sources: Perlin 1985 ("An Image Synthesizer"); Quilez,
    /// "Domain warping".
    pub struct Warp = "warp", field, revision 1;
    inputs {
        /// The field to warp.
        source: required,
        /// Displacement to the east, in units of `strength`.
        x: required,
        /// Displacement to the south, in units of `strength`.
        y: required,
    }
    params {
        /// Displacement where an input is 1.
        strength: f64 = 100.0, unit "m", range 0.0 to 1e6;
    }
}

impl Field for Warp {
    fn coord_map(&self) -> Option<CoordMap> {
        Some(CoordMap::Displaced { source: 0, east: 1, south: 2, strength: self.strength, reach: self.strength })
    }
}
