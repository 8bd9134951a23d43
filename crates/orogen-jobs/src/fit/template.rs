//! The fitted recipe: noise eroded by rivers, stretched and scaled.

use orogen_engine::field::{Curve, Fbm, Remap, Transform};
use orogen_engine::filter::Blur;
use orogen_engine::recipe::document::{Recipe, WorldSpec};
use orogen_engine::solver::StreamPower;

/// A parameter of the search.
#[derive(Debug, Clone, Copy)]
pub struct Param {
    /// The name.
    pub name: &'static str,
    /// The range.
    pub range: [f64; 2],
    /// Whether its scale is logarithmic.
    pub logarithmic: bool,
}

const fn param(name: &'static str, low: f64, high: f64, logarithmic: bool) -> Param {
    Param { name, range: [low, high], logarithmic }
}

/// All parameters. Lengths are in cells, so that one search fits places of any cell.
pub const PARAMS: [Param; 9] = [
    param("wavelength of the first land, cells", 24.0, 600.0, true),
    param("its gain", 0.3, 0.65, false),
    param("its amplitude, m", 20.0, 3000.0, true),
    param("erodibility", 5e-6, 2e-4, true),
    param("uplift, mm/yr", 0.01, 0.3, true),
    param("talus angle, deg", 15.0, 60.0, false),
    param("how much rock differs", 0.0, 1.5, false),
    param("creep, m^2/yr", 1e-3, 1.0, true),
    param("blur, cells", 0.2, 1.0, false),
];

/// Values of the parameters, each 0 to 1 within its range.
pub type ParamValues = [f64; PARAMS.len()];

/// The value of a parameter in its own unit.
#[must_use]
pub fn value(values: &ParamValues, k: usize) -> f64 {
    let Param { range: [low, high], logarithmic, .. } = PARAMS[k];
    let share = values[k].clamp(0.0, 1.0);
    match logarithmic {
        true => low * libm::exp(share * libm::log(high / low)),
        false => low + share * (high - low),
    }
}

/// The vertical stretching of the terrain.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stretch {
    /// The minimum and maximum of the eroded terrain.
    pub from: [f64; 2],
    /// The heights, in metres, that they are mapped to.
    pub to: [f64; 2],
    /// Between them heights follow exp(bend t) with t from 0 to 1: negative for high plains, positive for wide valleys.
    pub bend: f64,
}

impl Stretch {
    /// The new relative height of a relative height `t`, both 0 to 1.
    fn bent(&self, t: f64) -> f64 {
        match self.bend.abs() < 1e-3 {
            true => t,
            false => libm::expm1(self.bend * t) / libm::expm1(self.bend),
        }
    }

    /// The node for it. It extrapolates beyond both ends: a larger world may be lower and higher than the fitted one.
    #[must_use]
    pub fn curve(&self) -> Curve {
        let ([low, high], [base, top]) = (self.from, self.to);
        let point = |k: i32| {
            let t = f64::from(k) / 8.0;
            [round(low + t * (high - low)), round(base + self.bent(t) * (top - base))]
        };
        Curve { source: "soft".into(), points: (-8..=16).map(point).collect() }
    }
}

/// Rounds a number to the digits used in recipes.
fn round(value: f64) -> f64 {
    let digits = libm::pow(10.0, 4.0 - libm::log10(value.abs().max(1e-12)).floor());
    (value * digits).round() / digits
}

/// The area on which rivers are solved: the world, or a larger area with the world at its center, at the same
/// resolution. A solver ends at the world's edge, where heights do not change: a rim.
#[derive(Debug, Clone, Copy)]
struct View {
    /// Factor of lengths that fits the larger area into the world.
    scale: f64,
    /// Extent of the area beyond the world in the west and in the north, in metres.
    around: [f64; 2],
    /// Cell of the rivers' solver, in metres of the world.
    cell: f64,
}

impl View {
    /// The area with at least `margin` cells on each side.
    fn new(size: [usize; 2], cell: f64, margin: usize) -> View {
        let fewest = size[0].min(size[1]).max(1) as f64;
        let scale = fewest / (fewest + 2.0 * margin as f64);
        // Whole cells: the samples of the area coincide with those of the world, without interpolation.
        let around = size.map(|samples| (samples as f64 * (1.0 / scale - 1.0) / 2.0).round() * cell);
        View { scale, around, cell: cell * scale }
    }

    /// A source transformed to the area.
    fn wider(&self, source: &str) -> Transform {
        Transform {
            source: source.into(),
            scale: self.scale,
            offset: self.around.map(|metres| -metres),
            ..Transform::default()
        }
    }

    /// The center of the area's solution.
    fn middle(&self, source: &str) -> Transform {
        let offset = self.around.map(|metres| metres * self.scale);
        Transform { source: source.into(), scale: 1.0 / self.scale, offset, ..Transform::default() }
    }

    /// The law with the effect in the area that `law` has in the world: areas are smaller there, and slopes steeper.
    fn law(&self, law: StreamPower) -> StreamPower {
        let s = self.scale;
        let talus = libm::atan(libm::tan(law.talus_angle.to_radians()) / s).to_degrees();
        StreamPower {
            erodibility: law.erodibility * libm::pow(s, law.slope_exponent - 2.0 * law.area_exponent),
            talus_angle: talus,
            creep: law.creep * s * s,
            cell: self.cell,
            ..law
        }
    }
}

/// The world of a fitted recipe.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FittedWorld {
    /// Number of cells east and south.
    pub size: [usize; 2],
    /// Distance between samples, in metres.
    pub cell: f64,
    /// The seed.
    pub seed: u64,
}

/// The recipe of these values in a world, with rivers up to its edges. Its node `soft` is the
/// terrain before stretching.
#[must_use]
pub fn recipe(values: &ParamValues, stretch: &Stretch, world: &FittedWorld) -> Recipe {
    written(values, stretch, world, Some(View::new(world.size, world.cell, MARGIN)))
}

/// The same solved over the world only, which is faster: its terrain is like that of [`recipe`] at least [`MARGIN`]
/// samples from the border.
pub(super) fn trial(values: &ParamValues, stretch: &Stretch, world: &FittedWorld) -> Recipe {
    written(values, stretch, world, None)
}

/// Width of the border of a solved world that is affected by its edge, in samples.
pub(super) const MARGIN: usize = 48;

/// Cell from which the whole range of creep is searched, in metres.
const CREEP_CELL: f64 = 10.0;

/// The factor of creep at a cell. Creep over a number of cells takes time with the inverse of the cell: what it rounds
/// on cells of a metre in the same way as on cells of 10 m is a hundredth of it.
fn creep_factor(cell: f64) -> f64 {
    let share = (cell / CREEP_CELL).min(1.0);
    share * share
}

fn written(values: &ParamValues, stretch: &Stretch, world: &FittedWorld, view: Option<View>) -> Recipe {
    let FittedWorld { size, cell, seed } = *world;
    let value = |k: usize| round(value(values, k));
    let wavelength = round(value(0) * cell);
    let size = size.map(|samples| samples as f64 * cell);
    let mut recipe = Recipe::new(WorldSpec::default().with_seed(seed).with_size(Some(size)).with_cell(cell));
    let noise = |seed: u64, wavelength: f64, octaves: u32| Fbm { seed, wavelength, octaves, ..Fbm::default() };
    recipe.add("waves", Fbm { gain: value(1), ..noise(1, wavelength, 12) });
    let amplitude = value(2);
    recipe.add(
        "ground",
        Remap { source: "waves".into(), from: [-1.0, 1.0], to: [-amplitude, amplitude], ..Remap::default() },
    );
    recipe.add("rock", noise(2, round(wavelength / 2.0), 5));
    let differs = value(6);
    let share = |x: f64| [x, round(libm::exp(2.0 * differs * x))];
    recipe.add("erodibility", Curve { source: "rock".into(), points: [-1.0, -0.5, 0.0, 0.5, 1.0].map(share).to_vec() });
    recipe.add("lift", noise(3, wavelength, 4));
    recipe.add("uplift", Remap { source: "lift".into(), from: [-1.0, 1.0], to: [0.2, 1.8], ..Remap::default() });
    let law = StreamPower {
        source: "ground".into(),
        erodibility_factor: "erodibility".into(),
        uplift_factor: "uplift".into(),
        erodibility: value(3),
        uplift: value(4),
        talus_angle: value(5),
        creep: round(value(7) * creep_factor(cell)),
        sea: false,
        ..StreamPower::default()
    };
    match view {
        Some(view) => {
            for source in ["ground", "erodibility", "uplift"] {
                recipe.add(&format!("{source}_around"), view.wider(source));
            }
            let law = StreamPower {
                source: "ground_around".into(),
                erodibility_factor: "erodibility_around".into(),
                uplift_factor: "uplift_around".into(),
                ..view.law(law)
            };
            recipe.add("cut_around", law);
            recipe.add("cut", view.middle("cut_around"));
        }
        None => {
            recipe.add("cut", law);
        }
    }
    recipe.add("soft", Blur { source: "cut".into(), radius: round(value(8) * cell) });
    recipe.add("land", stretch.curve());
    recipe.output("height", "land");
    recipe
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn creep_of_small_cells_takes_no_longer_than_that_of_large_ones() {
        let stretch = Stretch { from: [0.0, 1.0], to: [0.0, 1.0], bend: 0.0 };
        let creep = |cell: f64| {
            let recipe =
                trial(&[1.0; PARAMS.len()], &stretch, &FittedWorld { size: [100; 2], cell, seed: 1 }).to_toml();
            let line = recipe.lines().find(|line| line.starts_with("creep = ")).unwrap_or_default();
            line["creep = ".len()..].parse::<f64>().unwrap()
        };
        assert_eq!([90.0, 30.0, 10.0, 1.0, 0.2].map(creep), [1.0, 1.0, 1.0, 0.01, 0.0004]);
    }
}
