//! Colors of the cover of the ground: surfaces, biomes, terrain classes.

use orogen::export::{biome_cover, sheet_cover};
use orogen::io::palette::color::Encoder;
use orogen::io::palette::{Rgb, Tint};
use orogen::recipe::Recipe;
use orogen::recipe::outputs::CLASS;
use orogen::{Error, ErrorKind, Grid, Progress, Result, World};

use super::coloring::Coloring;
use super::colors::{Colors, number};
use super::failure;
use super::legend::{Entry, Legend};

/// Adds the nodes to a recipe that compute the cover of the ground; call it before the world is opened.
pub fn prepare(recipe: &mut Recipe, coloring: &Coloring) {
    if *coloring == Coloring::Surfaces {
        sheet_cover::prepare(recipe);
    }
}

/// Colors without light over the window of the heights, four bytes per sample, and their legend. The colors of the sea
/// are those for the depths of all of the `land`.
///
/// # Errors
/// If the recipe has no cover of this kind, or the world fails.
pub fn paint(
    world: &World,
    coloring: &Coloring,
    heights: &Grid,
    land: &Grid,
    progress: &Progress,
) -> Result<(Vec<u8>, Legend)> {
    let recipe = world.recipe();
    match coloring {
        Coloring::Classes => {
            let classes = recipe.classes().iter().enumerate();
            let classes: Vec<(&str, Rgb)> = classes.map(|(k, class)| (class.name.as_str(), class.color(k))).collect();
            codes(world, CLASS, &classes, heights, progress)
        }
        Coloring::Biomes => {
            let (output, classes) = biome_cover::classes(recipe)
                .ok_or_else(|| Error::new(ErrorKind::Request, "no output of this recipe is the layer of a `biome`"))?;
            codes(world, output, &classes, heights, progress)
        }
        _ => surfaces(world, heights, land, progress),
    }
}

/// The colors of an output of codes. The legend counts land only.
fn codes(
    world: &World,
    output: &str,
    classes: &[(&str, Rgb)],
    heights: &Grid,
    progress: &Progress,
) -> Result<(Vec<u8>, Legend)> {
    let codes = world.grids(&[output], heights.window(), progress)?.pop();
    let codes = codes.ok_or_else(failure::nothing)?;
    let sea_level = world.recipe().world.sea_level as f32;
    let colors: Vec<Rgb> = classes.iter().map(|(_, color)| *color).collect();
    let mut counts = vec![0; classes.len()];
    for (code, height) in codes.data().iter().zip(heights.data()) {
        if *height > sea_level
            && let Some(count) = counts.get_mut((*code + 0.5) as usize)
        {
            *count += 1;
        }
    }
    Ok((Colors::Numbers(colors).paint(&codes), Legend::of_counts(classes, &counts)))
}

/// The albedo of the surfaces; the sea has the colors of its depth.
fn surfaces(world: &World, heights: &Grid, land: &Grid, progress: &Progress) -> Result<(Vec<u8>, Legend)> {
    let sea_level = world.recipe().world.sea_level;
    let cover = sheet_cover::of(world, heights, Some(sea_level), progress).map_err(failure::of_stream)?;
    let [red, green, blue] = &cover.albedo;
    let (encoder, tint) = (Encoder::new(), Tint::fit(land, sea_level as f32));
    let mut bytes = Vec::with_capacity(4 * heights.data().len());
    let albedo = red.data().iter().zip(green.data()).zip(blue.data());
    for (height, ((red, green), blue)) in heights.data().iter().zip(albedo) {
        let is_land = *height > sea_level as f32;
        let light =
            if is_land { [*red, *green, *blue].map(|part| (part * BRIGHTER).min(1.0)) } else { tint.at(*height) };
        let [red, green, blue] = if height.is_finite() { encoder.bytes(light) } else { number(&[], f32::NAN) };
        bytes.extend_from_slice(&[red, green, blue, 255]);
    }
    let entries = cover.entries.into_iter().filter_map(|entry| {
        let color = entry
            .colors
            .first()?
            .map(|byte| encoder.bytes([orogen::io::palette::color::decode(byte) * BRIGHTER; 3])[0]);
        Some(Entry { name: entry.name, color, share: entry.share })
    });
    let mut entries: Vec<Entry> = entries.collect();
    entries.sort_by(|a, b| b.share.total_cmp(&a.share));
    Ok((bytes, Legend::Entries(entries)))
}

/// Factor for the albedo of the ground, which is dark; maps show it in more light.
const BRIGHTER: f32 = 1.8;
