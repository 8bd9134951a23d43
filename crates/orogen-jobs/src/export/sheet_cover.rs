//! The surfaces of a recipe as the colors of a map sheet.

use std::io;

use super::derived::layer::Derived;
use super::derived::rows::Rows;
use super::derived::{albedo, cover, splat};
use super::format::refuse;
use orogen_engine::recipe::document::Recipe;
use orogen_engine::recipe::surface::expand::expand;
use orogen_engine::world::World;
use orogen_grid::grid::{Grid, Window};
use orogen_grid::progress::Progress;
use orogen_io::palette::color::{Encoder, Rgb};
use orogen_output::map::surface_blend::land_share;
use orogen_output::sheet::options::{SurfaceCover, SurfaceEntry};

/// Maximum number of surfaces in a legend, and minimum share of the window of each.
const MOST: usize = 8;
const LEAST: f64 = 0.001;

/// Memory of the cover of a window, including its computation, in bytes.
#[must_use]
pub fn memory(window: &Window) -> u64 {
    (window.width as u64).saturating_mul(window.height as u64).saturating_mul(24)
}

/// Adds the nodes to a recipe that compute its surfaces; call it before the world is opened.
pub fn prepare(recipe: &mut Recipe) {
    expand(recipe);
}

/// The albedo over the window of these heights, and the surfaces that cover most of its land.
///
/// Fails if the world fails, or the recipe was not [prepared](prepare).
pub fn of(world: &World, heights: &Grid, sea_level: Option<f64>, progress: &Progress) -> io::Result<SurfaceCover> {
    let window = heights.window();
    let sea_level = sea_level.map_or(f32::NEG_INFINITY, |sea_level| sea_level as f32);
    let recipe = world.recipe();
    if recipe.expanded().is_empty() {
        return refuse("the surfaces of this recipe were not prepared before its world was opened".into());
    }
    let [coloring, weighing] = progress.parts([1.0, 1.0]);
    let albedo = rows(&albedo::LAYER, world, window, &coloring)?.whole()?;
    let Ok(albedo) = <[Grid; 3]>::try_from(albedo) else { return refuse("a color has three channels".into()) };
    let names = cover::names(recipe);
    let mut sums = vec![0.0f64; names.len()];
    for band in rows(&splat::LAYER, world, window, &weighing)? {
        let weights = band?.0;
        let Some(first) = weights.first().map(|grid| (grid.window().y - window.y) as usize * window.width) else {
            break;
        };
        for (sum, weights) in sums.iter_mut().zip(&weights) {
            *sum += land_share(weights.data(), &heights.data()[first..], sea_level);
        }
    }
    Ok(SurfaceCover { albedo, entries: entries(recipe, &names, &sums) })
}

/// The surfaces in the order of the recipe, without those with small shares.
fn entries(recipe: &Recipe, names: &[String], sums: &[f64]) -> Vec<SurfaceEntry> {
    let total: f64 = sums.iter().sum();
    let mut order: Vec<usize> = (0..names.len()).filter(|k| sums[*k] > LEAST * total).collect();
    order.sort_by(|a, b| sums[*b].total_cmp(&sums[*a]));
    order.truncate(MOST);
    order.sort_unstable();
    let encoder = Encoder::new();
    let colors = |name: &str| -> Vec<Rgb> {
        let first = recipe.expanded().iter().find(|expanded| expanded.surface.name == name);
        first.map_or(Vec::new(), |expanded| expanded.colors.iter().map(|light| encoder.bytes(*light)).collect())
    };
    let entry = |k: usize| SurfaceEntry { name: names[k].clone(), colors: colors(&names[k]), share: sums[k] / total };
    order.into_iter().map(entry).collect()
}

fn rows<'w>(layer: &'static Derived, world: &'w World, window: &Window, progress: &Progress) -> io::Result<Rows<'w>> {
    let Some(channels) = layer.channels() else { return refuse(format!("`{}` has no channels", layer.name)) };
    Ok(Rows::new(channels, world, window, 0, progress)?)
}
