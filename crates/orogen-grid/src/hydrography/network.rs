//! A known network of rivers, with one node per sample.

use crate::grid::Grid;

/// The parts of a given network that [`Water`](super::water::Water) stores.
#[derive(Debug, Clone)]
pub struct Network {
    /// Drainage area of each node in m^2.
    pub flow: Grid,
    /// Columns and rows from the sample to its node; `None` if nodes are at their samples.
    pub offset: Option<[Grid; 2]>,
    /// The standing water of each node: the number of a lake, [`AT_SEA`], or 0. `None` if nodes are at their samples.
    pub covers: Option<Grid<u32>>,
}

/// The number of the sea among the numbers of lakes.
pub const AT_SEA: u32 = u32::MAX;
