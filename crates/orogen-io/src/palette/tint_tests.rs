//! Tests of the tint with built-in palettes.

use super::color::decode;
use super::named;
use super::palette::NO_DATA;
use super::tint::Tint;
use orogen_grid::grid::{Grid, Window};

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
