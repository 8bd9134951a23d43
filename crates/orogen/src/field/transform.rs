//! Looking elsewhere on the infinite map.

use super::ramp::sin_cos_degrees;
use crate::op::{Affine, CoordMap, Field, Inputs, WorldParams};
use orogen_noise::Points;

op! {
    /// The source moved, scaled and turned: the value at p is the source's at turn(p) / scale + offset.
    ///
    /// Offset and scale keep the fast path of lattice noise; a turn leaves it.
    pub struct Transform = "transform", field, revision 1;
    inputs {
        /// What is looked at.
        source: required,
    }
    params {
        /// How far east and south of the origin to look.
        offset: [f64; 2] = [0.0, 0.0], unit "m", range -1e12 to 1e12;
        /// How many times larger the source's features appear.
        scale: f64 = 1.0, range 1e-6 to 1e6;
        /// Angle by which the source appears turned, clockwise as seen on a map.
        angle: f64 = 0.0, unit "deg", range -360.0 to 360.0;
    }
}

impl Field for Transform {
    fn eval(&self, _: &Points, inputs: &Inputs, _: &WorldParams, out: &mut [f32]) {
        out.copy_from_slice(inputs.required(0));
    }

    fn coord_map(&self) -> Option<CoordMap> {
        let (sin, cos) = sin_cos_degrees(self.angle);
        Some(CoordMap::Mapped {
            source: 0,
            map: Affine { turn: [cos, -sin], scale: 1.0 / self.scale, offset: self.offset },
        })
    }
}
