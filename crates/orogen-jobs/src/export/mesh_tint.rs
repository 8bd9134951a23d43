//! The tint of meshes: the same for every window of a world.

use std::io;

use super::layer_source::LayerSource;
use crate::options::{OptionSpec, Options, ValueKind};
use orogen_engine::world::World;
use orogen_grid::error::Result;
use orogen_grid::grid::{Grid, Window};
use orogen_io::palette::tint::Tint;

/// `--color-range`.
pub const COLOR_RANGE: OptionSpec = OptionSpec::new("color-range", "LOW,HIGH", ValueKind::Range).with_about(
    "Heights at the ends of the color scale [default: approximate minimum and maximum of the world, the same \
             for all its windows]",
);

/// Samples along the longer side of the overview of a world.
const OVERVIEW: usize = 256;

/// Side of the overview of an unbounded world, in cells around its origin.
const CELLS: f64 = 4096.0;

/// The requested tint: over a range of heights, otherwise fitted to an overview of the whole world.
///
/// Fails if the source fails.
pub fn of(source: &LayerSource, options: &Options) -> io::Result<Tint> {
    let world = source.world();
    let sea_level = world.recipe().world.sea_level as f32;
    match options.pair(COLOR_RANGE.name) {
        Some([low, high]) => Ok(Tint::hypsometric(low as f32, high as f32, sea_level)),
        None => Ok(Tint::fit(&overview(source)?, sea_level)),
    }
}

/// The layer over the whole world, or around the origin of an unbounded one.
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
        // Not finer than the world itself.
        Some([width, height]) => {
            world.window_fitting(OVERVIEW.min((width.max(height) / spec.cell).round().max(1.0) as usize))
        }
        None => {
            let half = OVERVIEW as i64 / 2;
            Ok(Window::new(OVERVIEW, OVERVIEW, CELLS / OVERVIEW as f64 * spec.cell).at(-half, -half))
        }
    }
}
