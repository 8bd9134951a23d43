//! The map's tint for the colors of a mesh: the same for every window of a world.

use std::io;

use super::layer_source::LayerSource;
use super::options::{OptionSpec, Options, ValueKind};
use orogen_engine::world::World;
use orogen_grid::error::Result;
use orogen_grid::grid::{Grid, Window};
use orogen_io::palette::tint::Tint;

/// `--color-range`.
pub const COLOR_RANGE: OptionSpec = OptionSpec {
    name: "color-range",
    value: "LOW,HIGH",
    about: "Heights at the ends of the color scale [default: approximate minimum and maximum of the world, the same for all its windows]",
    value_kind: ValueKind::Range,
};

/// How many samples the longer side of a world is looked at with.
const OVERVIEW: usize = 256;

/// A world without bounds is looked at over so many cells, around its origin.
const CELLS: f64 = 4096.0;

/// The tint that the options ask for: of a range of heights, else fitted to an overview of the whole world.
///
/// Fails as the subject does.
pub fn of(source: &LayerSource, options: &Options) -> io::Result<Tint> {
    let world = source.world();
    let sea_level = world.recipe().world.sea_level as f32;
    match options.range(COLOR_RANGE.name) {
        Some([low, high]) => Ok(Tint::hypsometric(low as f32, high as f32, sea_level)),
        None => Ok(Tint::fit(&overview(source)?, sea_level)),
    }
}

/// The layer over all of the world, or over the middle of one without bounds.
fn overview(source: &LayerSource) -> io::Result<Grid> {
    let window = window(source.world())?;
    let progress = source.progress().part(0.0);
    let mut overview = Grid::filled(window, f32::NAN);
    LayerSource::new(source.world(), source.layer(), window, &progress)?.rows(|band| {
        overview.paste(&band[0]);
        Ok(())
    })?;
    Ok(overview)
}

fn window(world: &World) -> Result<Window> {
    let spec = &world.recipe().world;
    match spec.size {
        // No finer than the world itself.
        Some([width, height]) => {
            world.window_fitting(OVERVIEW.min((width.max(height) / spec.cell).round().max(1.0) as usize))
        }
        None => {
            let half = OVERVIEW as i64 / 2;
            Ok(Window::new(OVERVIEW, OVERVIEW, CELLS / OVERVIEW as f64 * spec.cell).at(-half, -half))
        }
    }
}
