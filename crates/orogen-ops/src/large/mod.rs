//! Hydrology of maps that do not fit in memory, with the same bits as [`hydrology`](orogen_grid::hydrology): tile by
//! tile, with the map on disk and only the values along the tiles' borders in memory.

pub(crate) mod areas;
pub(crate) mod basins;
pub mod drainage;
pub(crate) mod flats;
pub mod streams;
pub mod tiling;
pub(crate) mod tree;
