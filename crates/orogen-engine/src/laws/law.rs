//! The laws, and their violations.

use orogen_grid::grid::Window;
use std::fmt;
use std::time::Duration;

/// Maximum time for which work may continue after a request to cancel.
pub const LONGEST_CANCEL: Duration = Duration::from_millis(100);

/// A law: a property that every op must have.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Law {
    /// A tile has the bits of the crop of the whole.
    TileEqualsCrop,
    /// Finite inputs give finite results.
    Finite,
    /// Every SIMD level gives the same bits.
    Levels,
    /// Solutions on disk and sources in tiles change no bit.
    Stored,
    /// A tile equals the crop if warps and rotations read the op.
    Warped,
    /// A tile equals the crop at large and at negative positions.
    Unbounded,
    /// A field has the same bits where the samples of two cells coincide.
    Resolutions,
    /// A part of a volume has the bits of the whole, and the slice at altitude 0 is the plane.
    Altitudes,
    /// Every change of the world that changes samples changes the content key.
    ContentKeys,
    /// A solver with a margin has these properties, too.
    Margin,
    /// Work stops after a request to cancel.
    Cancel,
}

/// A violation of a law by an op.
#[derive(Debug, Clone, PartialEq)]
pub struct Violation {
    /// The op.
    pub op: String,
    /// The law.
    pub law: Law,
    /// The samples that were computed.
    pub window: Option<Window>,
    /// Description of the violation.
    pub message: String,
}

impl fmt::Display for Violation {
    fn fmt(&self, formatter: &mut fmt::Formatter) -> fmt::Result {
        write!(formatter, "`{}` breaks the law {:?}", self.op, self.law)?;
        if let Some(Window { x, y, width, height, cell }) = self.window {
            write!(formatter, " in {width} x {height} samples at ({x}, {y}), cell {cell} m")?;
        }
        write!(formatter, ": {}", self.message)
    }
}

impl std::error::Error for Violation {}

/// Whether a law holds.
pub type Verdict = Result<(), Violation>;
