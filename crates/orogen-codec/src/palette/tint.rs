//! The tint of a map: the atlas tint, or any palette.

use super::atlas::Atlas;
use super::color::Light;
use super::fitted::Fitted;
use super::palette::Palette;
use crate::format::levels::Levels;
use orogen_grid::grid::Grid;
use serde::{Deserialize, Serialize};

/// A mapping from heights to colors.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct Tint {
    colors: Colors,
    sea_level: f32,
    /// Whether water has different colors from land.
    sea: bool,
}

#[derive(Debug, Clone, Serialize, Deserialize)]
enum Colors {
    Atlas(Atlas),
    Fitted(Fitted),
}

impl Tint {
    /// The atlas tint (`Atlas`) for a world with heights from `low` to `high` and the sea at `sea_level`, in metres.
    #[must_use]
    pub fn hypsometric(low: f32, high: f32, sea_level: f32) -> Tint {
        Tint { colors: Colors::Atlas(Atlas::new(low, high, sea_level)), sea_level, sea: true }
    }

    /// The atlas tint fitted to the heights of a grid.
    #[must_use]
    pub fn fit(grid: &Grid, sea_level: f32) -> Tint {
        Tint { colors: Colors::Atlas(Atlas::fit(grid, sea_level)), sea_level, sea: true }
    }

    /// A palette fitted to the heights of a grid: it extends from the lowest to the highest, unless its positions are
    /// values. The atlas tint is fitted to the relief.
    #[must_use]
    pub fn of(palette: &Palette, grid: &Grid, sea_level: f32) -> Tint {
        if palette.follows_relief {
            return Tint::fit(grid, sea_level);
        }
        let levels = Levels::of(grid);
        Tint::between(palette, [levels.low(), levels.high()], sea_level)
    }

    /// A palette over a fixed range of heights, which is independent of a grid and thus the same for every window of a
    /// world.
    #[must_use]
    pub fn between(palette: &Palette, [low, high]: [f32; 2], sea_level: f32) -> Tint {
        if palette.follows_relief {
            return Tint::hypsometric(low, high, sea_level);
        }
        let fitted = Fitted::new(palette, low, high, sea_level);
        Tint { colors: Colors::Fitted(fitted), sea_level, sea: palette.has_sea() }
    }

    /// The sea level, in metres.
    #[must_use]
    pub fn sea_level(&self) -> f32 {
        self.sea_level
    }

    /// Whether a height is in the sea; always false if the tint does not distinguish water from land.
    #[must_use]
    pub fn is_sea(&self, height: f32) -> bool {
        self.sea && height.is_finite() && height <= self.sea_level
    }

    /// The color of a height; if it is not finite, the palette's color of missing samples.
    #[must_use]
    pub fn at(&self, height: f32) -> Light {
        match &self.colors {
            Colors::Atlas(atlas) => atlas.at(height),
            Colors::Fitted(fitted) => fitted.at(height),
        }
    }
}
