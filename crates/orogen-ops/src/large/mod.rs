//! Hydrology of maps that do not fit in memory, with the same bits as [`hydrology`](orogen_grid::hydrology). The map is
//! on disk and is processed tile by tile; only the values along the tiles' borders are in memory.

pub(crate) mod areas;
pub(crate) mod basins;
pub mod drainage;
pub(crate) mod flats;
pub mod streams;
pub mod tiling;
pub(crate) mod tree;
