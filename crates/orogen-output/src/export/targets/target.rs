//! Definition of engine targets.

use crate::export::options::Options;
use orogen_io::format::levels::Levels;

use orogen_grid::error::Result;

/// The requirements of an engine's terrain import.
#[derive(Debug)]
pub struct EngineTarget {
    /// The name for `--target`.
    pub name: &'static str,
    /// A one-line description.
    pub about: &'static str,
    /// The supported numbers of samples per side.
    pub sides: &'static [usize],
    /// The supported formats of heights, the default first.
    pub formats: &'static [&'static str],
    /// The suffix of a tile's name, from its column, its row, and the number of rows; `None` if only one file is
    /// supported.
    pub tile: Option<fn(usize, usize, usize) -> String>,
    /// The number of samples that its weight maps have less per side.
    pub weights_less: usize,
    /// Layout of weights: the value of the option `weights`.
    pub weights: &'static str,
    /// Direction of green in normal maps: the value of the option `normal`.
    pub normal: &'static str,
    /// Sets the formats' options for heights of this range; every tile is written with them.
    pub heights: fn(&Levels, &mut Options) -> Result<()>,
    /// Values for the import dialogue, one line each, for the number of samples along a side (of a tile), the cell in
    /// metres, and the range of heights.
    pub import: fn(usize, f64, &Levels) -> Vec<String>,
}
