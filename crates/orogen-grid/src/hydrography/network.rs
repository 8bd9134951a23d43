//! A network of rivers that is known, one node per sample.

use crate::grid::Grid;

/// What [`Water`](super::water::Water) keeps of a given network.
#[derive(Debug, Clone)]
pub struct Network {
    /// Drainage area of each node in m^2.
    pub flow: Grid,
    /// Columns and rows from the sample to its node; none if nodes are at their samples.
    pub offset: Option<[Grid; 2]>,
    /// The standing water of each node that is not at its sample: the number of a lake, [`AT_SEA`] or 0.
    pub covers: Option<Grid<u32>>,
}

/// The sea, where lakes are numbers.
pub const AT_SEA: u32 = u32::MAX;
