//! Palettes: colours at positions, before they are laid over heights.

use super::color::Rgb;

/// The color of a sample without a finite value, if the palette does not say: a light, neutral grey.
pub const NO_DATA: Rgb = [222, 222, 222];

/// Where a colour stands.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Position {
    /// At a height in metres, or a value in the layer's own unit.
    Value(f64),
    /// At a share of the range: 0 the lowest, 1 the highest.
    Share(f64),
    /// -1 the deepest sea, 0 the shore, 1 the highest land. Land that does not reach the sea begins at 0.
    Sea(f64),
}

/// A colour and where it stands. Two at one position make a hard step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stop {
    /// Where.
    pub at: Position,
    /// The colour.
    pub color: Rgb,
}

/// How colours between stops are mixed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Mix {
    /// In Oklab: even steps to the eye.
    #[default]
    Oklab,
    /// As sRGB bytes, as most other programs do.
    Rgb,
    /// By hue, saturation and value, the shorter way around.
    Hsv,
}

/// Colours for a map.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Palette {
    /// What it is called.
    pub name: String,
    /// Colours in ascending order of their positions, as far as those are of one kind.
    pub stops: Vec<Stop>,
    /// How colours between them are mixed.
    pub mix: Mix,
    /// Below the first stop; without one, the first stop's colour.
    pub below: Option<Rgb>,
    /// Above the last stop.
    pub above: Option<Rgb>,
    /// Where a sample is not finite; without one, [`NO_DATA`].
    pub missing: Option<Rgb>,
    /// Whether it is the atlas tint, whose colours reach further up the more relief there is.
    pub follows_relief: bool,
}

impl Palette {
    /// A palette of these stops, colours between them mixed in Oklab.
    pub fn new(name: &str, stops: Vec<Stop>) -> Palette {
        Palette { name: name.to_string(), stops, ..Palette::default() }
    }

    /// Whether it tells sea from land, or may: its stops are not mere shares of the range.
    pub fn has_sea(&self) -> bool {
        self.follows_relief || self.stops.iter().any(|stop| matches!(stop.at, Position::Sea(_)))
    }
}
