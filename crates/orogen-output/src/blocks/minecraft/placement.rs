//! Where the levels of a land are in Minecraft.

use orogen_grid::analysis::finite::FiniteCount;
use orogen_grid::error::{Error, ErrorKind, Result};
use orogen_grid::grid::Window;
use orogen_grid::words::number;

use super::super::levels::{Levels, MAX_LEVEL};

/// The lowest y.
pub const BOTTOM: i32 = -64;

/// The y above the highest one.
pub const TOP: i32 = 320;

/// The y of the uppermost water of Minecraft's seas.
pub const SEA_Y: i32 = 62;

/// The coordinate at which the game's world ends, in blocks.
const MAX_COORDINATE: i64 = 29_999_984;

/// The heights of a window: how many are finite, the lowest and the highest.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HeightExtent {
    /// How many are finite.
    pub finite: FiniteCount,
    /// The lowest and the highest; infinities if none is finite.
    pub range: [f32; 2],
}

impl Default for HeightExtent {
    fn default() -> HeightExtent {
        HeightExtent { finite: FiniteCount::default(), range: [f32::INFINITY, f32::NEG_INFINITY] }
    }
}

impl HeightExtent {
    /// The extent with more heights.
    #[must_use]
    pub fn with(self, heights: &[f32]) -> HeightExtent {
        let own = heights.iter().filter(|height| height.is_finite());
        HeightExtent {
            finite: self.finite.and(FiniteCount::of(heights)),
            range: own.fold(self.range, |[low, high], height| [low.min(*height), high.max(*height)]),
        }
    }

    /// The range in metres, multiplied by the exaggeration; `None` if no height is finite.
    #[must_use]
    pub fn altitudes(self, exaggeration: f64) -> Option<[f64; 2]> {
        (self.range[0] <= self.range[1]).then(|| self.range.map(|height| f64::from(height) * exaggeration))
    }
}

/// The position of a land's levels.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Placement {
    /// What is added to a level to get its y.
    pub up: i32,
}

impl Placement {
    /// The placement that puts the uppermost block of the sea at `sea_y`.
    #[must_use]
    pub fn new(sea_level: f64, cell: f64, sea_y: i32) -> Placement {
        Placement { up: (sea_y + 1).saturating_sub(Levels::of(sea_level, cell)) }
    }

    /// The levels of all blocks.
    #[must_use]
    pub fn levels(self) -> Levels {
        Levels::between(BOTTOM - self.up, TOP - self.up)
    }

    /// Checks that the ground from altitude `low` to `high` fits, with `room` levels above it. The altitudes contain
    /// the exaggeration.
    ///
    /// # Errors
    /// If it does not; the message says which options make it fit.
    pub fn check(self, [low, high]: [f64; 2], room: i32, cell: f64, exaggeration: f64, sea_y: i32) -> Result<()> {
        let [lowest, highest] = [low, high].map(|altitude| Levels::of(altitude, cell));
        if lowest <= -MAX_LEVEL || highest >= MAX_LEVEL {
            let message = format!(
                "the heights are {} to {} m, and blocks of {} m reach up to {} m from height 0; scale the heights, or use a larger cell",
                number(low),
                number(high),
                number(cell),
                number(f64::from(MAX_LEVEL) * cell)
            );
            return Err(Error::new(ErrorKind::Request, message));
        }
        // Below the ground are the floor of a shallow water, and bedrock.
        let [bottom, top] = [lowest + self.up - 2, highest + self.up + 1 + room];
        if bottom >= BOTTOM && top <= TOP {
            return Ok(());
        }
        let needed = top - bottom;
        let mut message =
            format!("the ground reaches from y = {bottom} to {top}, and Minecraft has room from {BOTTOM} to {TOP}; ");
        // The middle of the ground at the middle of the room.
        let moved = sea_y + (TOP + BOTTOM - top - bottom).div_euclid(2);
        match needed <= TOP - BOTTOM {
            true => message.push_str(&format!("use --sea-y {moved}, or a larger cell")),
            false => {
                let factor = exaggeration * f64::from(TOP - BOTTOM - 8 - room) / f64::from(needed - room);
                let shown = (factor * 100.0).floor() / 100.0;
                message.push_str(&format!(
                    "use --exaggeration {} or less, or a larger cell, and --sea-y to move it",
                    number(shown)
                ));
            }
        }
        Err(Error::new(ErrorKind::Request, message))
    }

    /// Checks that the columns of a window are in the game's world.
    ///
    /// # Errors
    /// If they are not.
    pub fn check_window(window: &Window) -> Result<()> {
        let ends = [window.x, window.y, window.x + window.width as i64, window.y + window.height as i64];
        if ends.iter().all(|end| end.abs() <= MAX_COORDINATE) {
            return Ok(());
        }
        let message = format!(
            "a world of Minecraft ends {MAX_COORDINATE} blocks from its middle, and this map has the columns {} to {} and the rows {} to {}; \
             use a larger cell, or a window nearer to the origin",
            ends[0], ends[2], ends[1], ends[3]
        );
        Err(Error::new(ErrorKind::Request, message))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_sea_is_where_it_is_asked_for() {
        let placement = Placement::new(0.0, 2.0, SEA_Y);
        // The uppermost water is the level -1.
        assert_eq!(placement.up - 1, SEA_Y);
        assert_eq!(placement.levels().bottom + placement.up, BOTTOM);
        assert_eq!(placement.levels().count, 384);
        assert_eq!(Placement::new(100.0, 10.0, -20).up + 9, -20);
    }

    #[test]
    fn what_does_not_fit_is_explained() {
        let check = |range: [f64; 2], sea_y: i32| {
            let placement = Placement::new(0.0, 1.0, sea_y);
            placement.check(range, 0, 1.0, 1.0, sea_y).map_err(|error| error.to_string())
        };
        assert!(check([-120.0, 250.0], SEA_Y).is_ok());
        let moved = check([300.0, 500.0], SEA_Y).unwrap_err();
        let y = moved.split("--sea-y ").nth(1).and_then(|rest| rest.split(',').next()?.parse().ok()).unwrap();
        assert!(check([300.0, 500.0], y).is_ok(), "{moved}");
        let scaled = check([-500.0, 1500.0], SEA_Y).unwrap_err();
        assert!(scaled.contains("use --exaggeration 0.18 or less"), "{scaled}");
        assert!(check([-500.0 * 0.18, 1500.0 * 0.18], 40).is_ok());
        assert!(check([-1e30, 1e30], SEA_Y).unwrap_err().contains("scale the heights"));
        assert!(Placement::check_window(&Window::new(10, 10, 1.0).at(29_999_980, 0)).is_err());
    }
}
