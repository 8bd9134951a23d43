//! Inks and widths of a map's lines.

use orogen_io::palette::color::{Light, Rgb};

pub use crate::map::paint::LAKES;

const BROWN: Rgb = [126, 82, 42];
const DARK_BROWN: Rgb = [92, 56, 26];
const ISOBATH: Rgb = [58, 112, 166];
/// Ink of rivers.
pub const BLUE: Rgb = [34, 92, 156];
/// Ink of the shores of lakes and of the sea.
pub const SHORE: Rgb = [40, 96, 152];

/// Relative luminance of the ground below which inks are bright.
const DARK: f32 = 0.14;

/// Widths of contours and of index contours, in millimetres.
pub const THIN: f32 = 0.12;
/// Width of index contours, in millimetres.
pub const THICK: f32 = 0.24;

/// Width of contours whose heights were given, in millimetres.
pub const GIVEN: f32 = 0.18;

/// The inks of contours and their labels.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Inks {
    /// Ink of the lines.
    pub line: Rgb,
    /// Ink of the labels.
    pub words: Rgb,
    /// Opacity of the lines, 0 to 1.
    pub cover: f32,
}

impl Inks {
    /// Inks visible on a color: dark ones, or bright ones on dark ground.
    pub fn over([red, green, blue]: Light, is_land: bool) -> Inks {
        let dark = 0.2126 * red + 0.7152 * green + 0.0722 * blue < DARK;
        match (is_land, dark) {
            (true, false) => Inks { line: BROWN, words: DARK_BROWN, cover: 0.62 },
            (true, true) => Inks { line: [226, 200, 168], words: [244, 228, 208], cover: 0.4 },
            (false, false) => Inks { line: ISOBATH, words: [28, 74, 122], cover: 0.5 },
            (false, true) => Inks { line: [176, 208, 232], words: [206, 228, 244], cover: 0.32 },
        }
    }
}

/// The ink of contours in the legend.
pub fn of_contours(is_land: bool) -> Rgb {
    if is_land { BROWN } else { ISOBATH }
}
