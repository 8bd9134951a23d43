//! Definition of layers of vector features.

use super::options::FeatureOptions;
use super::source::FeatureSource;
use orogen_engine::world::World;
use orogen_grid::error::Result;
use orogen_grid::grid::Window;
use orogen_grid::progress::Progress;
use orogen_io::format::features::FeatureLayer;

/// A layer of vector features, declared in its own file in `vectors/`.
pub struct VectorLayer {
    /// The name for `--layer`.
    pub name: &'static str,
    /// A one-line description.
    pub about: &'static str,
    /// The names of its options.
    pub options: &'static [&'static str],
    /// The style in drawings.
    pub style: Style,
    /// Computes its features, in metres east and south of the world's origin.
    pub make: Maker,
}

impl VectorLayer {
    /// Computes the features from the heights and the water of a window; `None` if the layer is not made from these.
    #[must_use]
    pub fn of_ground(
        &self,
        ground: &FeatureSource,
        options: &FeatureOptions,
        progress: &Progress,
    ) -> Option<Result<FeatureLayer>> {
        match self.make {
            Maker::Ground(make) => Some(make(ground, options, progress)),
            Maker::World(_) => None,
        }
    }
}

/// The input that features are computed from.
pub enum Maker {
    /// The heights and the water of a window.
    Ground(fn(&FeatureSource, &FeatureOptions, &Progress) -> Result<FeatureLayer>),
    /// A world and a window of it.
    World(fn(&World, &Window, &Progress) -> Result<FeatureLayer>),
}

/// The style of features in a drawing.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Style {
    /// The color of lines and of the borders of polygons, in SVG syntax.
    pub stroke: &'static str,
    /// Width of lines, in thousandths of the longer side.
    pub width: f64,
    /// The field whose square root scales the width of lines, from half the width to four times the width.
    pub by: Option<&'static str>,
    /// The fill color of polygons, or `none`.
    pub fill: &'static str,
}
