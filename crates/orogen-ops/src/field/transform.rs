//! Translation, scaling and rotation of a field.

use super::ramp::sin_cos_degrees;
use crate::op::{Affine, CoordMap, Field};

op! {
    /// The source translated, scaled and rotated: the value at p is the source's value at rotate(p) / scale + offset.
    ///
    /// Offset and scale keep the fast path of lattice noise; a rotation does not.
    pub struct Transform = "transform", field, revision 1;
    inputs {
        /// The field to transform.
        source: required,
    }
    params {
        /// Offset of the position that is read: metres east, metres south.
        offset: [f64; 2] = [0.0, 0.0], unit "m", range -1e12 to 1e12;
        /// Factor by which the source's features become larger.
        scale: f64 = 1.0, range 1e-6 to 1e6;
        /// Angle by which the source appears rotated, clockwise on a map.
        angle: f64 = 0.0, unit "deg", range -360.0 to 360.0;
    }
}

impl Field for Transform {
    fn coord_map(&self) -> Option<CoordMap> {
        let (sin, cos) = sin_cos_degrees(self.angle);
        Some(CoordMap::Mapped {
            source: 0,
            map: Affine { turn: [cos, -sin], scale: 1.0 / self.scale, offset: self.offset, altitude: None },
        })
    }
}
