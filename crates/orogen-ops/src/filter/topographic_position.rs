//! Topographic position index.

use crate::budget::memory;
use crate::lower::{Lowering, Passes};
use crate::op::{Context, Filter, GridInputs, WorldParams, wrong_layers};
use orogen_grid::analysis::position::{class, half_widths, positions_with};
use orogen_grid::analysis::slope::slope_degrees;
use orogen_grid::error::Result;
use orogen_grid::grid::{Grid, Window};
use orogen_grid::parallel;

op! {
    /// Topographic position index (TPI): the height above the mean of a surrounding disc, and the slope position
    /// derived from it (Weiss 2001).
    ///
    /// The disc holds all samples within `radius`, including the center; a radius below one cell counts as one cell.
    /// Weiss divides the index by its standard deviation over the map. Here it is divided by the standard deviation of
    /// the heights in the disc (Wilson and Gallant 2000), so that each sample depends only on the ground within the
    /// radius. Heights are rounded to 1/256 m. The time grows with the radius.
    pub struct TopographicPosition = "topographic-position", filter, revision 1;
    inputs {
        /// The heights.
        source: required,
    }
    params {
        /// Radius of the disc.
        radius: f64 = 300.0, unit "m", range 0.0 to 1e6;
    }
    layers {
        /// Height above the mean of the disc.
        position: height, unit "m";
        /// Height above the mean in standard deviations of the heights in the disc; 0 on level ground.
        deviation: height;
        /// Slope position: 1 ridge (deviation above 1), 2 upper slope (above 0.5), 3 middle slope, 4 flat (deviation as
        /// for 3, but a slope of up to 5 degrees), 5 lower slope (below -0.5), 6 valley (below -1).
        class: label;
    }
}

/// Maximum radius in samples.
const FARTHEST: f64 = 1024.0;

/// Rows whose slopes are computed together.
const BAND: usize = 64;

const CODE: &str = concat!(
    include_str!("../lower/horn.wgsl"),
    include_str!("../lower/product.wgsl"),
    include_str!("topographic_position.wgsl")
);

impl Filter for TopographicPosition {
    fn halo(&self, cell: f64) -> usize {
        (self.radius / cell).floor().clamp(1.0, FARTHEST) as usize
    }

    fn scratch(&self, window: &Window) -> u64 {
        let grown = window.grown(self.halo(window.cell));
        memory(&Window { width: grown.width + 1, ..grown }, 16).saturating_add(memory(window, 16))
    }

    fn apply(&self, inputs: &GridInputs, window: &Window, out: &mut [Option<Grid>], context: &Context) -> Result<()> {
        let source = inputs.required("source")?;
        let [position, deviation, classes] = out else { return Err(wrong_layers()) };
        let found = positions_with(source, self.halo(window.cell), context.progress)?;
        let width = window.width.max(1);
        for (layer, value) in [(position, 0), (deviation, 1)] {
            let Some(layer) = layer else { continue };
            for (row, found) in layer.data_mut().chunks_mut(width).zip(found.data().chunks(width)) {
                context.progress.check()?;
                for (out, found) in row.iter_mut().zip(found) {
                    *out = if value == 0 { found.above_mean } else { found.deviation };
                }
            }
        }
        if let Some(classes) = classes {
            // Computes slopes of a few rows at a time.
            let found = found.data().chunks(BAND * width);
            parallel::try_for_each(
                classes.data_mut().chunks_mut(BAND * width).zip(found).enumerate(),
                |(b, (out, found))| {
                    context.progress.check()?;
                    let band = Window { y: window.y + (b * BAND) as i64, height: out.len() / width, ..*window };
                    let slopes = source.crop(&band.grown(1)).map(|around| slope_degrees(&around));
                    let slopes = slopes.as_ref().map_or(&[][..], Grid::data);
                    for ((out, found), slope) in out.iter_mut().zip(found).zip(slopes) {
                        *out = f32::from(class(found.deviation, *slope));
                    }
                    Ok(())
                },
            )?;
        }
        Ok(())
    }

    fn lower(&self, cell: f64, _: &WorldParams) -> Lowering<Passes> {
        let radius = self.halo(cell);
        // The disc is unchanged by a turn of 90 degrees.
        let halves = half_widths(radius);
        let count: usize = halves.iter().map(|half| 2 * half + 1).sum();
        let passes = Passes::new(CODE, &[])
            .with_numbers([("gradient_scale", (1.0 / (8.0 * cell)) as f32)])
            .with_named_words([("radius", radius as u32), ("disc_samples", count as u32)])
            .with_table("half_width", halves.into_iter().map(|half| half as u32))
            .with_scratch(5);
        let passes = passes.then("add_up", 0, [0; 2]).then("compare", 0, [radius; 2]).reading(20 * radius);
        Lowering::Shader(passes)
    }

    fn cost(&self, cell: f64) -> f64 {
        4.0 * self.halo(cell) as f64
    }
}
