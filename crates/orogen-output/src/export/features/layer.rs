//! What a layer of vector features is.

use super::options::FeatureOptions;
use super::source::FeatureSource;
use orogen_grid::error::Result;
use orogen_io::format::features::FeatureLayer;

/// A layer of vector features, declared in a file of its own in `vectors/`.
pub struct VectorLayer {
    /// What `--layer` calls it.
    pub name: &'static str,
    /// One line for a list.
    pub about: &'static str,
    /// The options that change it.
    pub options: &'static [&'static str],
    /// How it is drawn.
    pub style: Style,
    /// Makes its features, in metres east and south of the world's origin.
    pub make: fn(&FeatureSource, &FeatureOptions) -> Result<FeatureLayer>,
}

/// How features are drawn.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Style {
    /// The colour of lines, and of the borders of areas, as SVG writes it.
    pub stroke: &'static str,
    /// How wide lines are, in thousandths of the longer side.
    pub width: f64,
    /// The field by whose square root lines are wider, from half the width to four times it.
    pub by: Option<&'static str>,
    /// The colour that areas are filled with, or `none`.
    pub fill: &'static str,
}
