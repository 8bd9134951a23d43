//! How far blocks depend on what is around them.

use super::cover::MAX_THICKNESS;

/// Free height, in blocks, below which a floor is that of a cave and has no soil.
pub(super) const CEILING: i32 = 8;

/// How far below the ground, in blocks, a floor may have soil.
pub(super) const SOIL_REACH: i32 = 12;

/// Levels above a block that it depends on.
pub(super) const ABOVE: i32 = MAX_THICKNESS + CEILING + 2;

/// Columns from the trunk of a tree to the end of its crown.
pub(super) const CROWN: i64 = 2;

/// Levels from the foot of a tree to its top, at most.
pub(super) const TREE_HEIGHT: i32 = 10;
