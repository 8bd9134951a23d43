//! Options for writing a file.

use crate::format::dem::Georeference;

/// The layout of a file.
#[derive(Debug, Clone, PartialEq, Default)]
#[non_exhaustive]
pub struct Options {
    /// Side of a tile in samples, a multiple of 16. `None` means 512, or 384 if a level would be one tile of 512 wide
    /// and several tall, which some readers mistake for strips.
    pub tile: Option<usize>,
    /// The nodata value, if there is one. Overviews exclude it from their means.
    pub nodata: Option<f32>,
    /// The unit of the samples, such as "m"; empty if they have none.
    pub unit: String,
    /// The position of metres on a map; `None` for local metres from the origin.
    pub map: Option<Georeference>,
    /// Write BigTIFF even if the file is smaller than 4 GiB.
    pub big: bool,
}

impl Options {
    /// The layout for samples of a unit, such as "m", or "" for none. Missing samples are NaN: readers treat them as
    /// missing only if the file declares it.
    #[must_use]
    pub fn of_unit(unit: &str) -> Options {
        Options { nodata: Some(f32::NAN), unit: unit.to_string(), ..Options::default() }
    }

    /// Sets the side of a tile, in samples: a multiple of 16.
    #[must_use]
    pub fn with_tile(self, tile: Option<usize>) -> Options {
        Options { tile, ..self }
    }

    /// Sets the nodata value.
    #[must_use]
    pub fn with_nodata(self, nodata: Option<f32>) -> Options {
        Options { nodata, ..self }
    }

    /// Sets the position on a map.
    #[must_use]
    pub fn with_map(self, map: Option<Georeference>) -> Options {
        Options { map, ..self }
    }

    /// Sets whether the file is a BigTIFF in any case.
    #[must_use]
    pub fn with_big(self, big: bool) -> Options {
        Options { big, ..self }
    }
}
