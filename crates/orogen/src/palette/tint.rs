//! The tint of a map: the atlas's, or that of any palette.

use super::atlas::Atlas;
use super::color::Light;
use super::fitted::Fitted;
use super::palette::Palette;
use crate::format::levels::Levels;
use crate::grid::Grid;

/// Which colour a height has.
#[derive(Debug, Clone)]
pub struct Tint {
    colors: Colors,
    sea_level: f32,
    /// Whether water is told from land by its colours.
    sea: bool,
}

#[derive(Debug, Clone)]
enum Colors {
    Atlas(Atlas),
    Fitted(Fitted),
}

impl Tint {
    /// The atlas tint ([`Atlas`]) for a world between `low` and `high` with the sea at `sea_level`, all in metres.
    pub fn hypsometric(low: f32, high: f32, sea_level: f32) -> Tint {
        Tint { colors: Colors::Atlas(Atlas::new(low, high, sea_level)), sea_level, sea: true }
    }

    /// The atlas tint that suits the heights of a grid.
    pub fn fit(grid: &Grid, sea_level: f32) -> Tint {
        Tint { colors: Colors::Atlas(Atlas::fit(grid, sea_level)), sea_level, sea: true }
    }

    /// The colours of a palette over the heights of a grid: those of its extremes are those of the palette, or, of one that names
    /// heights, what it says. One that follows the relief is fitted to it.
    pub fn of(palette: &Palette, grid: &Grid, sea_level: f32) -> Tint {
        if palette.follows_relief {
            return Tint::fit(grid, sea_level);
        }
        let levels = Levels::of(grid);
        let fitted = Fitted::new(palette, levels.low(), levels.high(), sea_level);
        Tint { colors: Colors::Fitted(fitted), sea_level, sea: palette.has_sea() }
    }

    /// Whether a height is under water.
    pub fn is_sea(&self, height: f32) -> bool {
        self.sea && height <= self.sea_level
    }

    /// The colour of a height; of NaN, what the palette says, or the atlas's lowest land's.
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
    use crate::grid::Window;
    use crate::palette::named;

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
