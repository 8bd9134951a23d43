//! The parts of a map.

use crate::format::features::Ring;

/// Water in place of land.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Water {
    /// Water that reaches the border of the map.
    Sea,
    /// Other water.
    Lake,
}

/// A height at a position.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Site {
    /// Metres east and south of the north-west corner of the map.
    pub at: [f64; 2],
    /// Height in metres; of water, the height of its bed.
    pub height: f64,
    /// Water, or `None` for land.
    pub water: Option<Water>,
}

/// A lake.
#[derive(Debug, Clone, PartialEq)]
pub struct Lake {
    /// Its name; may be empty.
    pub name: String,
    /// The height of its surface in metres, if it is stated.
    pub height: Option<f64>,
    /// Its polygons, each an outer ring and its islands; parts that touch at a corner are separate.
    pub parts: Vec<Vec<Ring>>,
    /// The middle of the cell of the lake that is nearest to the mean of its cells.
    pub middle: [f64; 2],
}

/// A river from its source to its mouth.
#[derive(Debug, Clone, PartialEq)]
pub struct River {
    /// Its name; may be empty.
    pub name: String,
    /// Metres east and south of the north-west corner of the map.
    pub points: Vec<[f64; 2]>,
    /// Discharge at the mouth in m^3/s.
    pub discharge: Option<f64>,
    /// Width at the mouth in metres.
    pub width: Option<f64>,
    /// The river that it ends in, one that comes before it.
    pub parent: Option<usize>,
}

/// A settlement.
#[derive(Debug, Clone, PartialEq)]
pub struct Settlement {
    /// Its name.
    pub name: String,
    /// Metres east and south of the north-west corner of the map.
    pub at: [f64; 2],
    /// Whether it is the capital of a state.
    pub is_capital: bool,
    /// Number of thousands of people, or another unit of the author's.
    pub population: f64,
}
