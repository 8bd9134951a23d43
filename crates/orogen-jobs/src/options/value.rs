//! Values of options.

use std::path::PathBuf;

use orogen_io::palette::color::Rgb;
use orogen_output::sheet::paper::Paper;

/// A given value.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Value {
    Given,
    Whole(u64),
    Number(f64),
    Numbers(Vec<f64>),
    Word(&'static str),
    Text(String),
    Color(Rgb),
    Paper(Paper),
    File(PathBuf),
}
