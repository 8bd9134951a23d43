//! What may be asked of a file.

use crate::format::dem::Georeference;

/// How a file is laid out.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Options {
    /// Samples along a tile's side, a multiple of 16; `None` for 512, or 384 where a level would be just one tile of 512 wide and
    /// taller than that: some readers take it for strips.
    pub tile: Option<usize>,
    /// The value that stands for no value, if there is one. Overviews leave it out of their means.
    pub nodata: Option<f32>,
    /// How metres lie on a map; `None` for local metres from the origin.
    pub map: Option<Georeference>,
    /// BigTIFF even where the file does not pass 4 GiB.
    pub big: bool,
}
