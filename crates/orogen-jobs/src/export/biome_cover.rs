//! The biomes or terrain classes of a recipe as the colors of a map sheet.

use std::io;

use super::format::refuse;
use orogen_engine::recipe::biomes::biomes;
use orogen_engine::recipe::document::Recipe;
use orogen_engine::recipe::outputs::CLASS;
use orogen_engine::world::World;
use orogen_grid::climate::biomes::class::WATER;
use orogen_grid::grid::{Grid, Window};
use orogen_grid::progress::Progress;
use orogen_io::palette::color::{Rgb, decode};
use orogen_output::map::shade::PRINTED;
use orogen_output::sheet::options::{SurfaceCover, SurfaceEntry};

/// Maximum number of classes in a legend.
const MAX_ENTRIES: usize = 8;

/// Memory of the colors of a window, including their computation, in bytes.
#[must_use]
pub fn memory(window: &Window) -> u64 {
    (window.width as u64).saturating_mul(window.height as u64).saturating_mul(20)
}

/// The output that contains biome codes, and the names and colors of its classes in the order of their codes; `None` if
/// the recipe has no such output.
#[must_use]
pub fn classes(recipe: &Recipe) -> Option<(&str, Vec<(&'static str, Rgb)>)> {
    let (output, scheme) = biomes(recipe)?;
    Some((output, scheme.classes().iter().map(|class| (class.name, class.color)).collect()))
}

/// The colors of the biomes over the window of these heights, with the most frequent biomes on land for the legend, in
/// this order.
///
/// Fails if the world fails, or no output of the recipe is the layer of a `biome`.
pub fn of(world: &World, heights: &Grid, sea_level: Option<f64>, progress: &Progress) -> io::Result<SurfaceCover> {
    let Some((output, scheme)) = biomes(world.recipe()) else {
        return refuse(
            "no output of this recipe is the layer of a `biome`; add such a node, and for example biome = \"NODE\" to its outputs".into(),
        );
    };
    let classes: Vec<(&str, Rgb)> = scheme.classes().iter().map(|class| (class.name, class.color)).collect();
    cover(world, output, &classes, Some(usize::from(WATER)), (heights, sea_level), progress)
}

/// Like [`of`], for the terrain classes of the recipe's tables `[[class]]`.
///
/// Fails if the world fails, or the recipe has no such tables.
pub fn of_terrain(
    world: &World,
    heights: &Grid,
    sea_level: Option<f64>,
    progress: &Progress,
) -> io::Result<SurfaceCover> {
    let recipe = world.recipe();
    if recipe.classes().is_empty() {
        return refuse("this recipe has no terrain classes; add tables `[[class]]` with a `name`".into());
    }
    let classes: Vec<(&str, Rgb)> =
        recipe.classes().iter().enumerate().map(|(k, class)| (class.name.as_str(), class.color(k))).collect();
    cover(world, CLASS, &classes, None, (heights, sea_level), progress)
}

/// The colors of the classes in an output of codes. The legend lists the classes on land, without `water`.
fn cover(
    world: &World,
    output: &str,
    classes: &[(&str, Rgb)],
    water: Option<usize>,
    (heights, sea_level): (&Grid, Option<f64>),
    progress: &Progress,
) -> io::Result<SurfaceCover> {
    let window = *heights.window();
    let codes = world.grids(&[output], &window, progress)?.pop();
    let Some(codes) = codes else { return refuse(format!("the output `{output}` was not computed")) };
    let sea_level = sea_level.map_or(f32::NEG_INFINITY, |sea_level| sea_level as f32);
    let mut counts = vec![0u64; classes.len()];
    let mut albedo = [(); 3].map(|()| Grid::filled(window, 0.0f32));
    // Level ground is printed in the color of its class, as in the legend.
    let lights: Vec<[f32; 3]> = classes.iter().map(|(_, color)| color.map(|byte| decode(byte) / PRINTED)).collect();
    for (k, (code, height)) in codes.data().iter().zip(heights.data()).enumerate() {
        let code = (*code as usize).min(classes.len() - 1);
        albedo.iter_mut().zip(lights[code]).for_each(|(grid, light)| grid.data_mut()[k] = light);
        if *height > sea_level && Some(code) != water {
            counts[code] += 1;
        }
    }
    let total: u64 = counts.iter().sum();
    let mut order: Vec<usize> = (0..classes.len()).filter(|code| counts[*code] > 0).collect();
    order.sort_by_key(|code| std::cmp::Reverse(counts[*code]));
    order.truncate(MAX_ENTRIES);
    let entry = |code: usize| SurfaceEntry {
        name: classes[code].0.to_string(),
        colors: vec![classes[code].1],
        share: counts[code] as f64 / total as f64,
    };
    Ok(SurfaceCover { albedo, entries: order.into_iter().map(entry).collect() })
}
