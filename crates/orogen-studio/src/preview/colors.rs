//! Colors of samples.

use orogen::Grid;
use orogen::export::derived::list;
use orogen::io::palette::color::Encoder;
use orogen::io::palette::{Palette, Rgb, Tint, named};
use orogen::layer::LayerKind;
use orogen::output::map::Painter;
use orogen::recipe::Recipe;
use orogen::recipe::outputs::CLASS;
use orogen::world::HEIGHT;
use serde::{Deserialize, Serialize};

use super::coloring::Coloring;
use super::legend::{Legend, STEPS};
use super::statistics::range;

/// How values are converted to colors.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub enum Colors {
    /// By a tint.
    Tint {
        /// The tint.
        tint: Tint,
        /// Whether the tint applies to the logarithms of the values.
        log: bool,
    },
    /// One color for each number.
    Numbers(Vec<Rgb>),
}

/// The default palette of layers without their own palette.
const LAYERS: &str = "viridis";

/// Number of colors for numbers without their own color, with hues that are far apart.
const HUES: usize = 24;

impl Colors {
    /// The colors of a layer over a range of its values.
    #[must_use]
    pub fn of(recipe: &Recipe, layer: &str, kind: LayerKind, coloring: &Coloring, values: &Grid) -> Colors {
        if layer == CLASS && !recipe.classes().is_empty() {
            let classes = recipe.classes().iter().enumerate();
            return Colors::Numbers(classes.map(|(k, class)| class.color(k)).collect());
        }
        if let Some((_, classes)) = orogen::export::biome_cover::classes(recipe).filter(|(output, _)| *output == layer)
        {
            return Colors::Numbers(classes.into_iter().map(|(_, color)| color).collect());
        }
        if kind == LayerKind::Label {
            return Colors::Numbers((0..HUES).map(|k| hue(k as f32 * 0.618_034)).collect());
        }
        let sea_level = recipe.world.sea_level as f32;
        let log = kind == LayerKind::Flow;
        let tint = match palette(layer, coloring) {
            Some(palette) if log => {
                let logs: Vec<f32> = values.data().iter().map(|value| logarithm(*value)).collect();
                match Grid::from_data(*values.window(), logs) {
                    Some(logs) => Tint::of(&palette, &logs, f32::NEG_INFINITY),
                    None => Tint::fit(values, sea_level),
                }
            }
            Some(palette) => Tint::of(&palette, values, sea_level),
            None => Tint::fit(values, sea_level),
        };
        Colors::Tint { tint, log }
    }

    /// The legend of these colors for these values.
    #[must_use]
    pub fn legend(&self, values: &Grid) -> Legend {
        let Colors::Tint { tint, log } = self else { return Legend::Entries(Vec::new()) };
        let low = if *log { f32::MIN_POSITIVE } else { f32::NEG_INFINITY };
        let ends = range(values.data().iter().copied().filter(|value| *value >= low));
        let encoder = Encoder::new();
        let [first, last] = if *log { ends.map(logarithm) } else { ends };
        let at = |k: usize| first + (last - first) * k as f32 / (STEPS - 1) as f32;
        Legend::Ramp { ends, colors: (0..STEPS).map(|k| encoder.bytes(tint.at(at(k)))).collect(), log: *log }
    }

    /// Colors without light, four bytes per sample.
    #[must_use]
    pub fn paint(&self, values: &Grid) -> Vec<u8> {
        let mut bytes = Vec::with_capacity(4 * values.data().len());
        match self {
            Colors::Tint { tint, log } => {
                let encoder = Encoder::new();
                for value in values.data() {
                    let value = if *log { logarithm(*value) } else { *value };
                    let [red, green, blue] = encoder.bytes(tint.at(value));
                    bytes.extend_from_slice(&[red, green, blue, 255]);
                }
            }
            Colors::Numbers(colors) => {
                for value in values.data() {
                    let [red, green, blue] = number(colors, *value);
                    bytes.extend_from_slice(&[red, green, blue, 255]);
                }
            }
        }
        bytes
    }

    /// Colors with the relief shading of `heights`; `albedo` is the colors without light.
    #[must_use]
    pub fn shade(&self, albedo: &[u8], heights: &Grid, sea_level: f64) -> Vec<u8> {
        let mut shaded = albedo.to_vec();
        self.painter(heights, sea_level).shade(heights, &mut shaded);
        shaded
    }

    /// The painter of relief for these colors, fitted to heights.
    #[must_use]
    pub fn painter(&self, heights: &Grid, sea_level: f64) -> Painter {
        // Other layers do not show water.
        let tint = match self {
            Colors::Tint { tint, log: false } => tint.clone(),
            _ => Tint::fit(heights, f32::NEG_INFINITY),
        };
        Painter::with_tint(tint, heights, sea_level)
    }
}

/// The palette of a layer.
#[must_use]
pub fn palette(layer: &str, coloring: &Coloring) -> Option<Palette> {
    let own = list::named(layer).map(|derived| derived.palette).filter(|name| !name.is_empty());
    let usual = own.unwrap_or(if layer == HEIGHT { named::DEFAULT } else { LAYERS });
    let name = match coloring {
        Coloring::Edited(palette) => return Some(Palette::clone(palette)),
        Coloring::Named(name) => name,
        _ => usual,
    };
    named::find(name).or(named::find(LAYERS)).map(named::Named::palette)
}

/// The logarithm of a value that spans orders of magnitude; NaN if it is not above 0.
fn logarithm(value: f32) -> f32 {
    if value > 0.0 { libm::log10f(value) } else { f32::NAN }
}

/// The color of a number; gray if it has none.
#[must_use]
pub fn number(colors: &[Rgb], value: f32) -> Rgb {
    match value.is_finite() && value >= 0.0 && !colors.is_empty() {
        true => colors[(value + 0.5) as usize % colors.len()],
        false => [128; 3],
    }
}

/// A color of a hue from 0 to 1.
fn hue(at: f32) -> Rgb {
    orogen::io::palette::fitted::of_hsv([at.fract(), 0.55, 0.85]).map(|c| (c * 255.0) as u8)
}

#[cfg(test)]
mod tests {
    use super::*;
    use orogen::{Recipe, Window, presets};

    #[test]
    fn heights_classes_and_numbers_have_colors() {
        let grid = Grid::from_data(Window::new(4, 1, 10.0), vec![-50.0, 0.0, 100.0, f32::NAN]).unwrap();
        let recipe = presets::find("tile-continent").unwrap().recipe().unwrap();
        let heights = Colors::of(&recipe, HEIGHT, LayerKind::Height, &Coloring::Own, &grid).paint(&grid);
        assert!(heights[2] > heights[0], "the sea is blue: {heights:?}");
        let classes = Grid::from_data(Window::new(2, 1, 10.0), vec![0.0, 1.0]).unwrap();
        let colors = Colors::of(&recipe, CLASS, LayerKind::Label, &Coloring::Own, &classes).paint(&classes);
        let expect = [recipe.classes()[0].color(0), recipe.classes()[1].color(1)];
        assert_eq!([&colors[..3], &colors[4..7]], [&expect[0][..], &expect[1][..]]);
        let plain = Recipe::new(orogen::WorldSpec::default());
        let numbers = Colors::of(&plain, "basins", LayerKind::Label, &Coloring::Own, &classes).paint(&classes);
        assert_ne!(numbers[..3], numbers[4..7]);
        let flow = Colors::of(&plain, "flow", LayerKind::Flow, &Coloring::Own, &grid).paint(&grid);
        assert_eq!(flow.len(), 16);
        let Legend::Ramp { ends, colors, log } =
            Colors::of(&plain, "flow", LayerKind::Flow, &Coloring::Own, &grid).legend(&grid)
        else {
            panic!()
        };
        assert!(ends == [100.0; 2] && colors.len() == STEPS && log);
    }
}
