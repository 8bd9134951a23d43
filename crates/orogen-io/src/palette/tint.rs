//! The tint of a map: the atlas tint, or any palette.

use super::atlas::Atlas;
use super::color::Light;
use super::fitted::Fitted;
use super::palette::Palette;
use crate::format::levels::Levels;
use orogen_grid::grid::Grid;

/// A mapping from heights to colours.
#[derive(Debug, Clone)]
pub struct Tint {
    colors: Colors,
    sea_level: f32,
    /// Whether water is distinguished from land by colour.
    sea: bool,
}

#[derive(Debug, Clone)]
enum Colors {
    Atlas(Atlas),
    Fitted(Fitted),
}

impl Tint {
    /// The atlas tint (`Atlas`) for a world between `low` and `high` with the sea at `sea_level`, in metres.
    #[must_use]
    pub fn hypsometric(low: f32, high: f32, sea_level: f32) -> Tint {
        Tint { colors: Colors::Atlas(Atlas::new(low, high, sea_level)), sea_level, sea: true }
    }

    /// The atlas tint fitted to the heights of a grid.
    #[must_use]
    pub fn fit(grid: &Grid, sea_level: f32) -> Tint {
        Tint { colors: Colors::Atlas(Atlas::fit(grid, sea_level)), sea_level, sea: true }
    }

    /// A palette over the heights of a grid: its ends are the extremes of the grid, unless its positions are values.
    /// The atlas tint is fitted to the relief.
    #[must_use]
    pub fn of(palette: &Palette, grid: &Grid, sea_level: f32) -> Tint {
        if palette.follows_relief {
            return Tint::fit(grid, sea_level);
        }
        let levels = Levels::of(grid);
        Tint::between(palette, [levels.low(), levels.high()], sea_level)
    }

    /// A palette between two heights, independent of a grid: the same for every window of a world.
    #[must_use]
    pub fn between(palette: &Palette, [low, high]: [f32; 2], sea_level: f32) -> Tint {
        if palette.follows_relief {
            return Tint::hypsometric(low, high, sea_level);
        }
        let fitted = Fitted::new(palette, low, high, sea_level);
        Tint { colors: Colors::Fitted(fitted), sea_level, sea: palette.has_sea() }
    }

    /// Whether a height is below sea level.
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::palette::color::decode;
    use crate::palette::named;
    use crate::palette::palette::NO_DATA;
    use orogen_grid::grid::Window;

    #[test]
    fn samples_that_are_not_finite_have_one_color_that_is_not_on_the_palette() {
        let grid = Grid::from_data(Window::new(3, 1, 1.0), vec![-100.0, 0.0, 3000.0]).unwrap();
        let grey = NO_DATA.map(decode);
        for named in named::all() {
            let palette = named.palette();
            let tint = Tint::of(&palette, &grid, 0.0);
            for value in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
                assert_eq!(tint.at(value), palette.missing.map_or(grey, |color| color.map(decode)), "{}", palette.name);
                assert!(!tint.is_sea(value), "{}", palette.name);
            }
        }
    }

    #[test]
    fn a_range_gives_every_window_the_same_colors() {
        let high = Grid::from_data(Window::new(2, 1, 1.0), vec![900.0, 1000.0]).unwrap();
        for name in ["hypsometric", "viridis"] {
            let palette = named::find(name).unwrap().palette();
            let (fixed, fitted) = (Tint::between(&palette, [0.0, 2000.0], -1.0), Tint::of(&palette, &high, -1.0));
            assert!(fixed.at(1000.0) != fitted.at(1000.0), "{name}");
            assert_eq!(fixed.at(2000.0), fixed.at(9e9), "{name}");
        }
    }

    #[test]
    fn water_is_known_where_the_palette_knows_it() {
        let grid = Grid::from_data(Window::new(3, 1, 1.0), vec![-100.0, 0.0, 300.0]).unwrap();
        for (name, sea) in [("hypsometric", true), ("oleron", true), ("viridis", false)] {
            let tint = Tint::of(&named::find(name).unwrap().palette(), &grid, 0.0);
            assert_eq!((tint.is_sea(0.0), tint.is_sea(1.0)), (sea, false), "{name}");
            let [shore, land] = [0.0f32, 0.0f32.next_up()].map(|height| tint.at(height));
            let step = shore.iter().zip(land).any(|(a, b)| (a - b).abs() > 0.05);
            assert_eq!(step, sea, "{name}: {shore:?} {land:?}");
        }
    }
}
