//! Distances within which blocks depend on their surroundings.

use super::cover::MAX_THICKNESS;

/// Open height, in blocks, below which a floor belongs to a cave and has no soil.
pub(super) const CEILING: i32 = 8;

/// How far below the ground, in blocks, a floor may have soil.
pub(super) const SOIL_REACH: i32 = 12;

/// Number of levels above a block that it depends on.
pub(super) const ABOVE: i32 = MAX_THICKNESS + CEILING + 2;

/// Columns from the trunk of a tree to the edge of its crown.
pub(super) const CROWN: i64 = 2;

/// Maximum number of levels from the foot of a tree to its top.
pub(super) const TREE_HEIGHT: i32 = 10;
