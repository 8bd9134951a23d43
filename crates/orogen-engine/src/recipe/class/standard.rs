//! The standard terrain classes, for a recipe without any: water, sand, grass, forest, rock and snow by height, slope
//! and distance from water.
//!
//! | class | where |
//! |---|---|
//! | 0 water | at or below the sea level, and in lakes |
//! | 1 sand | within a cell and a half of water, on slopes of less than 15 degrees |
//! | 5 snow | above 2600 m above the sea, on slopes of less than 45 degrees |
//! | 4 rock | on slopes of 33 degrees and more, and above 2200 m above the sea |
//! | 3 forest | in patches of about eight cells below 1900 m above the sea |
//! | 2 grass | elsewhere |

use crate::recipe::document::Recipe;
use crate::recipe::outputs::{CLASS, HEIGHT, LAKES};
use orogen_grid::error::{Error, ErrorKind, Result};
use orogen_grid::words::number;
use orogen_ops::field::{Expr, Fbm};
use orogen_ops::filter::{Distance, Slope};

/// The names of the classes, by their numbers.
pub const NAMES: [&str; 6] = ["water", "sand", "grass", "forest", "rock", "snow"];

/// Depth from which a lake is drawn, in metres.
const DEPTH: f64 = 0.01;

/// Width of a beach, in cells.
const BEACH: f64 = 1.5;

/// Wavelength of the patches of forest, in cells.
const PATCH: f64 = 16.0;

/// The cells for which beaches and patches of forest are within the bounds of the ops that make them, in metres.
const CELLS: [f64; 2] = [1e-4, 4e5];

/// Adds the output [`CLASS`] to a recipe that has none. `cell` is the cell of the map in metres.
///
/// # Errors
/// If the recipe has neither this output nor the output `height`, or the cell is too small or too large for beaches and
/// forests.
pub fn classify(recipe: &mut Recipe, cell: f64) -> Result<()> {
    let input =
        |name: &str| recipe.output_inputs().iter().find(|(output, _)| output == name).map(|(_, input)| input.clone());
    if input(CLASS).is_some() {
        return Ok(());
    }
    let Some(height) = input(HEIGHT) else {
        let message = "the recipe has no output `height` and no output `class`, so there is nothing to draw tiles of; name the heights in \
                       [outputs], or the number of each sample's terrain class";
        return Err(Error::new(ErrorKind::Recipe, message));
    };
    let [least, most] = CELLS;
    if !(least..=most).contains(&cell) {
        let message = format!(
            "the standard terrain classes need a cell of {least} m to {most} m, not {} m; give the recipe classes of its own, or use another cell",
            number(cell)
        );
        return Err(Error::new(ErrorKind::Request, message));
    }
    let lakes = input(LAKES);
    let sea = recipe.world.sea_level;
    let free = |name: &str| {
        let mut free = format!("tilemap-{name}");
        while recipe.nodes().iter().any(|named| named.name == free) {
            free.push('_');
        }
        free
    };
    let [water, shore, slope, patches, class] = ["water", "shore", "slope", "patches", "class"].map(free);
    let sea_or_lake = match lakes {
        Some(lakes) => Expr::new(&format!("max(height <= {sea}, lakes > {DEPTH})")).with("lakes", lakes),
        None => Expr::new(&format!("height <= {sea}")),
    };
    recipe.add(&water, sea_or_lake.with("height", height.clone()));
    let reach = (BEACH + 1.0) * cell;
    recipe.add(&shore, Distance { source: water.as_str().into(), threshold: 0.5, reach });
    recipe.add(&slope, Slope { source: height.clone(), ..Slope::default() });
    recipe.add(&patches, Fbm { seed: 3, wavelength: PATCH * cell, octaves: 3, ..Fbm::default() });
    let land = format!(
        "max(max(2 + (patches > 0.02) * (height < {forest}), 4 * max(slope >= 33, height > {rock})), 5 * (height > {snow}) * (slope < 45))",
        forest = sea + 1900.0,
        rock = sea + 2200.0,
        snow = sea + 2600.0,
    );
    let beach = format!("(shore < {}) * (slope < 15)", BEACH * cell);
    // A beach replaces the class of the land; it is class 1. Where the height is not a number, neither is the class.
    let expr = format!("(1 - water) * (({beach}) + (1 - ({beach})) * ({land})) + 0 * height");
    let node = Expr::new(&expr)
        .with("height", height)
        .with("water", water.as_str())
        .with("shore", shore.as_str())
        .with("slope", slope.as_str())
        .with("patches", patches.as_str());
    recipe.add(&class, node);
    recipe.output(CLASS, class.as_str());
    Ok(())
}
