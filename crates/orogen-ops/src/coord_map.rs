//! The positions at which fields read their sources.

use serde::{Deserialize, Serialize};

/// A source that a field also reads around its position: [`Inputs::around`](crate::op::Inputs::around) returns the
/// source at `step` metres to the east, west, south and north. The engine evaluates the source at these four positions,
/// so the field knows the slope at any point without neighboring samples.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stencil {
    /// Index of the input.
    pub source: usize,
    /// Distance from the position to each of the four positions, in metres.
    pub step: f64,
}

impl Stencil {
    /// The maps to the four positions: east, west, south, north.
    #[must_use]
    pub fn maps(&self) -> [Affine; 4] {
        let offsets = [[self.step, 0.0], [-self.step, 0.0], [0.0, self.step], [0.0, -self.step]];
        offsets.map(|offset| Affine { offset, ..Affine::IDENTITY })
    }
}

/// The positions at which a field reads its source.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum CoordMap {
    /// Displaced by two inputs times `strength` metres; each displacement is clamped to -reach ..= reach.
    Displaced {
        /// Index of the input that is read at the displaced position.
        source: usize,
        /// Index of the input for the displacement east.
        east: usize,
        /// Index of the input for the displacement south.
        south: usize,
        /// Displacement in metres for an input of 1.
        strength: f64,
        /// Maximum displacement along each axis, in metres.
        reach: f64,
    },
    /// Mapped by an affine transform.
    Mapped {
        /// Index of the input that is read at the mapped position.
        source: usize,
        /// The map from the requested position to the one that is read.
        map: Affine,
    },
}

impl CoordMap {
    /// The altitude at which the source is read, in metres; `None` for the altitude of the field.
    #[must_use]
    pub fn altitude(&self) -> Option<f64> {
        match self {
            CoordMap::Displaced { .. } => None,
            CoordMap::Mapped { map, .. } => map.altitude,
        }
    }
}

/// A similarity transform of the plane, p -> rotate(p) * scale + offset, at the same altitude or a given one.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Affine {
    /// Cosine and sine of the rotation; [1, 0] is no rotation.
    pub turn: [f64; 2],
    /// Scale factor.
    pub scale: f64,
    /// Offset east and south, in metres.
    pub offset: [f64; 2],
    /// The altitude of the mapped position, in metres; `None` for the altitude of the original position.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub altitude: Option<f64>,
}

impl Affine {
    /// The map of each position to itself.
    pub const IDENTITY: Affine = Affine { turn: [1.0, 0.0], scale: 1.0, offset: [0.0; 2], altitude: None };

    /// Whether columns stay columns and rows stay rows.
    #[must_use]
    pub fn is_separable(&self) -> bool {
        self.turn == [1.0, 0.0]
    }

    /// Maps a position. Without a rotation the result is x * scale + offset bit for bit, so lattices stay lattices.
    #[must_use]
    pub fn apply(&self, x: f64, y: f64) -> (f64, f64) {
        let (tx, ty) = if self.is_separable() {
            (x, y)
        } else {
            (self.turn[0] * x - self.turn[1] * y, self.turn[1] * x + self.turn[0] * y)
        };
        (tx * self.scale + self.offset[0], ty * self.scale + self.offset[1])
    }
}
