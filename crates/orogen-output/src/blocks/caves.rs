//! Caves in any land: winding tubes below its surface, added to a recipe as an output `density`.
//!
//! They are nodes of the recipe, so for one size of blocks they are the same in every part of the world.

use super::density::DENSITY;
use orogen_engine::Recipe;
use orogen_engine::field::{Altitude, Expr, Fbm, Resample};
use orogen_engine::filter::Distance;
use orogen_engine::recipe::outputs::CLASS;
use orogen_engine::world::{HEIGHT, LAKES};
use orogen_grid::error::{Error, ErrorKind, Result};

/// Levels below the lowest ground that leave room for caves.
pub const BELOW: u32 = 48;

/// Wavelength of the tubes, wavelength of the areas where they open to the surface (both in blocks), and the vertical
/// scale of the tubes relative to the horizontal one.
const WAVELENGTH: f64 = 60.0;
const OPENINGS: f64 = 90.0;
const FLATTENED: f64 = 0.7;

/// Distances from water, in blocks: caves start at the first one and have their full width from the second one on.
/// Density is sampled at every fourth column, so with less than six blocks caves would reach into columns of water.
const DRY: [f64; 2] = [7.0, 14.0];

/// Depths in blocks at which caves start to become narrower, and at which they end.
const DEEP: [f64; 2] = [32.0, 44.0];

/// Thickness of the roof above caves that do not open to the surface, in blocks.
const ROOF: [f64; 2] = [2.0, 7.0];

/// Adds caves to a recipe. `cell` is the size of a block in metres; every column of the world needs a class.
///
/// # Errors
/// If the recipe has no output `height` or `class`, or already has an output `density`.
pub fn add(recipe: &mut Recipe, cell: f64) -> Result<()> {
    let input =
        |name: &str| recipe.output_inputs().iter().find(|(output, _)| output == name).map(|(_, input)| input.clone());
    let (Some(height), Some(class)) = (input(HEIGHT), input(CLASS)) else {
        return Err(Error::new(ErrorKind::Recipe, "caves need the outputs `height` and `class`"));
    };
    if input(DENSITY).is_some() {
        let message = "the recipe has an output `density`, which shapes its ground in space, also its caves; caves are added to recipes without one";
        return Err(Error::new(ErrorKind::Request, message));
    }
    let lakes = input(LAKES);
    let sea = recipe.world.sea_level;
    let free = |name: &str| {
        let mut free = format!("caves-{name}");
        while recipe.nodes().iter().any(|named| named.name == free) {
            free.push('_');
        }
        free
    };
    let [altitude, wet, shore, away, one, other, openings, tubes, ground, open] =
        ["altitude", "wet", "shore", "away", "one", "other", "openings", "tubes", "ground", "density"].map(free);
    let is_wet = match lakes {
        Some(lakes) => Expr::new(&format!("max(max(class < 0.5, height <= {sea}), lakes > 0)")).with("lakes", lakes),
        None => Expr::new(&format!("max(class < 0.5, height <= {sea})")),
    };
    recipe.add(&wet, is_wet.with("class", class).with("height", height.clone()));
    let [near, far] = DRY.map(|blocks| blocks * cell);
    recipe.add(&shore, Distance { source: wet.as_str().into(), threshold: 0.5, reach: far });
    // Densities are sampled at a larger cell, at which narrow rivers would be lost.
    recipe.add(&away, Resample { source: shore.as_str().into(), cell, ..Resample::default() });
    recipe.add(&altitude, Altitude {});
    for (name, seed) in [(&one, 1), (&other, 2)] {
        let wavelength = WAVELENGTH * cell;
        recipe.add(name, Fbm { seed, wavelength, octaves: 2, vertical: FLATTENED, ..Fbm::default() });
    }
    recipe.add(&openings, Fbm { seed: 3, wavelength: OPENINGS * cell, octaves: 2, ..Fbm::default() });
    // 1 in the middle of a tube, where two noises are near 0 at the same time, and 0 outside of it.
    let [deep, deepest] = DEEP.map(|blocks| blocks * cell);
    let [thin, thick] = ROOF.map(|blocks| blocks * cell);
    let carved = Expr::new(&format!(
        "(1 - smoothstep(0.005, 0.018, one * one + other * other)) * smoothstep({near}, {far}, away) \
         * (1 - smoothstep({deep}, {deepest}, height - altitude)) \
         * max(smoothstep({thin}, {thick}, height - altitude), smoothstep(0.1, 0.25, openings))"
    ))
    .with("one", one.as_str())
    .with("other", other.as_str())
    .with("away", away.as_str())
    .with("height", height.clone())
    .with("altitude", altitude.as_str())
    .with("openings", openings.as_str());
    recipe.add(&tubes, carved);
    let above = Expr::new("height - altitude").with("height", height).with("altitude", altitude.as_str());
    recipe.add(&ground, above);
    // Open in the middle of a tube at any depth.
    let room = 8.0 * cell;
    let carve = Expr::new(&format!("ground - tubes * (max(ground, 0) + {room})"))
        .with("ground", ground.as_str())
        .with("tubes", tubes.as_str());
    recipe.add(&open, carve);
    recipe.output(DENSITY, open.as_str());
    Ok(())
}
