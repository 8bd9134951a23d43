//! A horizontal section of a field.

use crate::op::{Affine, CoordMap, Field};

op! {
    /// The source at one altitude: a horizontal section of what depends on the altitude, the same at all altitudes.
    ///
    /// Filters, levelled ops and solvers can read it. With noise of space (`vertical` above 0) as the source the
    /// altitude is a third axis: land whose noises move along it changes smoothly, as if in time. Of a density it is
    /// the plan of its caves at that altitude.
    pub struct Slice = "slice", field, revision 1;
    inputs {
        /// The field to cut.
        source: required,
    }
    params {
        /// The altitude at which the source is read.
        altitude: f64 = 0.0, unit "m", range -1e9 to 1e9;
    }
}

impl Field for Slice {
    fn coord_map(&self) -> Option<CoordMap> {
        Some(CoordMap::Mapped { source: 0, map: Affine { altitude: Some(self.altitude), ..Affine::IDENTITY } })
    }
}
