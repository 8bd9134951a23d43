//! Palettes: colors at positions, before they are applied to heights.

use super::color::Rgb;
use serde::{Deserialize, Serialize};

/// The default color of a sample without a finite value: a light, neutral gray.
pub const NO_DATA: Rgb = [222, 222, 222];

/// The position of a color.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub enum Position {
    /// A height in metres, or a value in the unit of the layer.
    Value(f64),
    /// A share of the range, from 0 at the lowest value to 1 at the highest.
    Share(f64),
    /// Relative to the sea: -1 is the deepest sea, 0 the shore, 1 the highest land. Land that does not reach the sea
    /// starts at 0.
    Sea(f64),
}

impl Position {
    /// The number of the position, of any kind.
    #[doc(hidden)]
    #[must_use]
    pub fn number(self) -> f64 {
        match self {
            Position::Value(at) | Position::Share(at) | Position::Sea(at) => at,
        }
    }

    /// The name of the kind in palette files.
    #[doc(hidden)]
    #[must_use]
    pub fn unit(self) -> &'static str {
        match self {
            Position::Value(_) => "m",
            Position::Share(_) => "range",
            Position::Sea(_) => "sea",
        }
    }
}

/// A color and its position. Two stops at the same position give a hard step.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Stop {
    /// The position.
    pub at: Position,
    /// The color.
    pub color: Rgb,
}

/// The color space in which colors between stops are mixed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[non_exhaustive]
pub enum Mix {
    /// Oklab, which is perceptually uniform.
    #[default]
    Oklab,
    /// sRGB bytes, as in most other programs.
    Rgb,
    /// Hue, saturation and value. The hue follows the shorter arc.
    Hsv,
    /// Not mixed: the color of the nearest stop.
    Nearest,
}

impl Mix {
    /// All color spaces.
    #[doc(hidden)]
    pub const ALL: [Mix; 4] = [Mix::Oklab, Mix::Rgb, Mix::Hsv, Mix::Nearest];

    /// The name in palette files.
    #[doc(hidden)]
    #[must_use]
    pub fn word(self) -> &'static str {
        match self {
            Mix::Oklab => "oklab",
            Mix::Rgb => "rgb",
            Mix::Hsv => "hsv",
            Mix::Nearest => "nearest",
        }
    }
}

/// Colors for a map.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[non_exhaustive]
pub struct Palette {
    /// The name.
    pub name: String,
    /// Colors in ascending order of their positions, if all positions are of the same kind.
    pub stops: Vec<Stop>,
    /// The color space for mixing between stops.
    pub mix: Mix,
    /// The color below the first stop; by default the color of the first stop.
    pub below: Option<Rgb>,
    /// The color above the last stop; by default the color of the last stop.
    pub above: Option<Rgb>,
    /// The color of samples that are not finite; by default [`NO_DATA`].
    pub missing: Option<Rgb>,
    /// Whether this is the atlas tint, which is fitted to the relief.
    pub follows_relief: bool,
}

impl Palette {
    /// A palette with these stops, mixed in Oklab.
    #[must_use]
    pub fn new(name: &str, stops: Vec<Stop>) -> Palette {
        Palette { name: name.to_string(), stops, ..Palette::default() }
    }

    /// The same palette without mixing: each value has the color of the nearest stop. The atlas tint is then not fitted
    /// to the relief.
    #[must_use]
    pub fn nearest(self) -> Palette {
        Palette { mix: Mix::Nearest, follows_relief: false, ..self }
    }

    /// Whether the palette distinguishes sea from land: it is the atlas tint, or a stop is relative to the sea.
    #[must_use]
    pub fn has_sea(&self) -> bool {
        self.follows_relief || self.stops.iter().any(|stop| matches!(stop.at, Position::Sea(_)))
    }
}
