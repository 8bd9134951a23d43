//! Strokes of a brush on the map.

use super::positions::{SEGMENT_COST, change};
use crate::declare::{Stroke, StrokeMode, Strokes};
use crate::lower::Lowering;
use crate::op::{Field, Inputs, WorldParams};
use orogen_grid::error::Result;
use orogen_grid::polylines::buffers::Buffers;
use orogen_noise::Points;
use orogen_noise::shader::function::Shader;

op! {
    /// Strokes of a brush on the map: a painted mask, or heights that are raised, lowered and levelled by hand.
    ///
    /// A stroke is the area within `radius` of a line of `points`, in metres of the world, with x to the east and y to
    /// the south; one point is a dab. It has full effect up to `hardness` times the radius from the line, and falls
    /// smoothly to none at the radius. Within one stroke the effect does not add up where its line crosses itself.
    ///
    /// Strokes are applied in the order of the list, on top of the background. `add` adds `value`, for heights. `set`
    /// mixes with `value`, for masks (1 paints, 0 clears) and for level ground. `erase` mixes with the background, so
    /// it removes strokes before it.
    ///
    /// Time per sample depends on the strokes nearby, not on their total number.
    pub struct Paint = "paint", field, revision 1;
    inputs {
        /// Values below the strokes. Default: 0.
        background: optional,
    }
    params {
        /// Strokes in the order in which they are applied, with at most 100 000 points in all.
        strokes: Strokes = Strokes::default();
    }
}

/// The mix of two values: exactly the first one at 0 and the second one at 1.
fn mix(from: f64, to: f64, share: f64) -> f64 {
    if share >= 1.0 { to } else { from + (to - from) * share }
}

/// The value after a stroke, at a distance from its line.
fn applied(stroke: &Stroke, distance: f64, value: f64, background: f64) -> f64 {
    let share = stroke.strength * stroke.falloff(distance);
    match stroke.mode {
        _ if share == 0.0 => value,
        StrokeMode::Add => value + stroke.value * share,
        StrokeMode::Set => mix(value, stroke.value, share),
        StrokeMode::Erase => mix(value, background, share),
    }
}

impl Field for Paint {
    fn eval(&self, at: &Points, inputs: &Inputs, _: &WorldParams, out: &mut [f32]) -> Result<()> {
        match inputs.get("background") {
            Some(background) => out.copy_from_slice(background),
            None => out.fill(0.0),
        }
        let strokes = self.strokes.list();
        self.strokes.with_buffers(|buffers| {
            change(at, out, |x, y, background| {
                let background = f64::from(background);
                let mut value = background;
                buffers.visit([x, y], |k, distance| value = applied(&strokes[k], distance, value, background));
                value as f32
            });
        });
        Ok(())
    }

    fn cost(&self) -> f64 {
        (SEGMENT_COST * self.strokes.with_buffers(Buffers::visits)).max(100.0)
    }

    fn cost_in_rows(&self) -> f64 {
        self.cost()
    }

    fn memory(&self) -> u64 {
        self.strokes.memory()
    }

    fn lower(&self, _: usize, _: &WorldParams) -> Lowering<Shader> {
        Lowering::Processor("strokes are searched in a tree of boxes")
    }
}
