//! Water on maps that do not fit in memory: the same to the bit as [`hydrology`](orogen_grid::hydrology) makes it, tile by tile, the
//! map itself on disk and in memory only what goes on along the tiles' borders.

pub(crate) mod areas;
pub(crate) mod basins;
pub mod drainage;
pub(crate) mod flats;
pub mod streams;
pub mod tiling;
pub(crate) mod tree;
