//! Levels of blocks.

/// A range of levels. The blocks of level k lie between the altitudes k and k + 1 times the cell.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Levels {
    /// The lowest level.
    pub bottom: i32,
    /// Number of levels.
    pub count: usize,
}

/// Levels are limited to plus or minus this; beyond it altitudes would not be exact.
pub const MAX_LEVEL: i32 = 1 << 22;

/// Which levels a land has.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Extent {
    /// Given levels.
    Levels(Levels),
    /// From this number of levels below the lowest ground of the window to the tops of its trees.
    Below(u32),
}

/// Default number of levels below the lowest ground.
pub const DEFAULT_BELOW: u32 = 16;

/// Maximum number of levels below the lowest ground.
pub const MAX_BELOW: u32 = 4096;

impl Levels {
    /// The levels from `bottom` to `top`, excluding `top`; empty if `top` is not above `bottom`.
    #[must_use]
    pub fn between(bottom: i32, top: i32) -> Levels {
        Levels { bottom, count: top.saturating_sub(bottom).max(0) as usize }
    }

    /// The level above the highest one.
    #[must_use]
    pub fn top(self) -> i32 {
        self.bottom + self.count as i32
    }

    /// The level that contains an altitude.
    #[must_use]
    pub fn of(altitude: f64, cell: f64) -> i32 {
        (altitude / cell).floor().clamp(-f64::from(MAX_LEVEL), f64::from(MAX_LEVEL)) as i32
    }

    /// The altitude of the middle of a level, in metres.
    #[inline]
    #[must_use]
    pub fn middle(level: i32, cell: f64) -> f64 {
        (f64::from(level) + 0.5) * cell
    }
}
