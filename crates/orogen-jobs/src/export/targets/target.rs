//! Definition of engine targets.

use crate::export::vectors::scatter;
use crate::options::Options;
use orogen_engine::world::HEIGHT;
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
    /// Values for the import dialog, one line each, for the number of samples along a side (of a tile), the cell in
    /// metres, and the range of heights.
    pub import: fn(usize, f64, &Levels) -> Vec<String>,
    /// How it reads scattered objects; `None` if it has no form of its own for them.
    pub objects: Option<EngineObjects>,
}

/// The form in which an engine reads scattered objects.
#[derive(Debug)]
pub struct EngineObjects {
    /// The supported formats, the default first.
    pub formats: &'static [&'static str],
    /// What to do with the files, one line each.
    pub import: &'static [&'static str],
}

impl EngineTarget {
    /// The layer of scattered objects, if the engine reads them.
    #[must_use]
    pub fn objects_layer(&self) -> Option<&'static str> {
        self.objects.as_ref().map(|_| scatter::LAYER.name)
    }

    /// The formats that the engine reads a layer from, the default first.
    #[must_use]
    pub fn formats_of(&self, layer: &str) -> &'static [&'static str] {
        match layer {
            HEIGHT => self.formats,
            _ if layer == scatter::LAYER.name => self.objects.as_ref().map_or(&[], |objects| objects.formats),
            _ => &["png"],
        }
    }
}
