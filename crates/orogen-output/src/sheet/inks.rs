//! Inks and widths of a map's lines.

use orogen_io::palette::color::{Light, Rgb};

use super::options::PageColors;
use super::scene::{INK, WHITE};
use crate::map::paint::LAKES;

/// Ink of small print.
const SOFT: Rgb = [92, 90, 88];
/// A section through the sea.
const SEA: Rgb = [150, 192, 222];
const BROWN: Rgb = [126, 82, 42];
const DARK_BROWN: Rgb = [92, 56, 26];
const ISOBATH: Rgb = [58, 112, 166];
/// Ink of rivers.
const BLUE: Rgb = [34, 92, 156];
/// Ink of the shores of lakes and of the sea.
const SHORE: Rgb = [40, 96, 152];

/// Relative luminance of the ground below which inks are bright.
const DARK: f32 = 0.14;

/// Width of ordinary contours, in millimetres.
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
    /// Inks that are visible on a color: dark inks, or bright ones on dark ground. Inks that the user chose do not
    /// depend on the ground.
    pub fn over([red, green, blue]: Light, is_land: bool, colors: &PageColors) -> Inks {
        let chosen = if is_land { colors.contours } else { colors.water };
        if let Some(line) = chosen {
            return Inks { line, words: mixed(line, colors.ink, 0.3), cover: 0.62 };
        }
        let dark = 0.2126 * red + 0.7152 * green + 0.0722 * blue < DARK;
        match (is_land, dark) {
            (true, false) => Inks { line: BROWN, words: DARK_BROWN, cover: 0.62 },
            (true, true) => Inks { line: [226, 200, 168], words: [244, 228, 208], cover: 0.4 },
            (false, false) => Inks { line: ISOBATH, words: [28, 74, 122], cover: 0.5 },
            (false, true) => Inks { line: [176, 208, 232], words: [206, 228, 244], cover: 0.32 },
        }
    }
}

impl PageColors {
    /// Ink of small print.
    pub(super) fn soft(&self) -> Rgb {
        if (self.page, self.ink) == (WHITE, INK) { SOFT } else { mixed(self.ink, self.page, 0.25) }
    }

    /// Ink of rivers.
    pub(super) fn rivers(&self) -> Rgb {
        self.water.unwrap_or(BLUE)
    }

    /// Ink of the shores of lakes and of the sea.
    pub(super) fn shores(&self) -> Rgb {
        self.water.unwrap_or(SHORE)
    }

    /// Color of lakes.
    pub(super) fn lakes(&self) -> Rgb {
        self.water.map_or(LAKES, |water| mixed(water, self.page, LIGHT))
    }

    /// Color of a section through the sea.
    pub(super) fn sea(&self) -> Rgb {
        self.water.map_or(SEA, |water| mixed(water, self.page, LIGHT))
    }

    /// The ink of contours in the legend.
    pub(super) fn of_contours(&self, is_land: bool) -> Rgb {
        match is_land {
            true => self.contours.unwrap_or(BROWN),
            false => self.water.unwrap_or(ISOBATH),
        }
    }
}

/// Share of the page color in the color of lakes, if a color of water was chosen.
const LIGHT: f32 = 0.6;

/// A color between two others.
fn mixed(from: Rgb, to: Rgb, share: f32) -> Rgb {
    let part = |k: usize| f32::from(from[k]) + (f32::from(to[k]) - f32::from(from[k])) * share;
    [0, 1, 2].map(|k| (part(k) + 0.5) as u8)
}
