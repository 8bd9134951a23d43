//! The measured worlds, all based on hills of noise. The hills are a former version of the preset `hills`, so that
//! figures stay comparable.

use orogen::filter::Blur;
use orogen::solver::Normalise;
use orogen::{Options, Recipe, World};

/// The hills themselves: fields only.
pub fn fields() -> Result<Recipe, String> {
    Recipe::parse(include_str!("hills.toml"), "hills.toml").map_err(|e| e.to_string())
}

/// The normalized layer of the recipes below.
pub const STRETCHED: &str = "stretched";

/// The hills with normalized heights.
pub fn stretched() -> Result<Recipe, String> {
    let mut recipe = fields()?;
    recipe.add("stretched", Normalise { source: "terrain".into(), low: 40.0, high: 340.0, ..Normalise::default() });
    recipe.output(STRETCHED, "stretched");
    Ok(recipe)
}

/// The hills with heights blurred with a halo of 32 samples at `cell` and then normalized.
pub fn with_halo(cell: f64) -> Result<Recipe, String> {
    let mut recipe = fields()?;
    // The kernel ends at three radii: 31.5 samples.
    recipe.add("soft", Blur { source: "terrain".into(), radius: 10.5 * cell });
    recipe.add("stretched", Normalise { source: "soft".into(), low: 40.0, high: 340.0, ..Normalise::default() });
    recipe.output(STRETCHED, "stretched");
    Ok(recipe)
}

/// Opens a recipe on this many threads.
pub fn open(recipe: Recipe, threads: usize) -> Result<World, String> {
    World::with_options(recipe, Options { threads: Some(threads), ..Options::default() }).map_err(|e| e.to_string())
}
