//! What an engine wants.

use crate::export::options::Options;
use orogen_io::format::levels::Levels;

use orogen_grid::error::Result;

/// An engine's import of heights.
pub struct EngineTarget {
    /// What `--target` calls it.
    pub name: &'static str,
    /// One line for a list.
    pub about: &'static str,
    /// The samples that a side may have.
    pub sides: &'static [usize],
    /// The formats of heights that it reads, the usual one first.
    pub formats: &'static [&'static str],
    /// What the name of a tile ends with, by its column, its row, and how many rows there are; none if it takes one file alone.
    pub tile: Option<fn(usize, usize, usize) -> String>,
    /// How many samples fewer a side its weight maps have.
    pub weights_less: usize,
    /// How it wants weights: the value of the option `weights`.
    pub weights: &'static str,
    /// Where green points in its normal maps: the value of the option `normal`.
    pub normal: &'static str,
    /// Sets the formats' options for heights of this range; every tile is written by them.
    pub heights: fn(&Levels, &mut Options) -> Result<()>,
    /// What to type into its import dialogue, a line each, for so many samples along a side (of a tile), so many metres apart, of these heights.
    pub import: fn(usize, f64, &Levels) -> Vec<String>,
}
