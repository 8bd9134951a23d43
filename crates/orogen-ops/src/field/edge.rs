//! Falloff towards the world's edges.

use super::constant::CONSTANT;
use super::positions::{each, smoothstep};
use crate::lower::Lowering;
use crate::op::{Field, Inputs, WorldParams};
use orogen_grid::error::Result;
use orogen_noise::Points;
use orogen_noise::shader::function::Shader;
use orogen_noise::shader::lattice::Lattice;

choice! {
    /// How two edges meet in a corner.
    pub enum Corners {
        /// Distance is measured to a rectangle with rounded corners.
        Round = "round",
        /// Distance is measured to the nearest edge.
        Square = "square",
    }
}

op! {
    /// A mask that is 0 at the world's edges and rises smoothly to 1 at the distance `width` from them.
    ///
    /// Multiply a height by it, or use it as a mask, to make an island of a bounded world.
    pub struct Edge = "edge", field, revision 1;
    params {
        /// Distance from the edges at which the mask reaches 1.
        width: f64 = 1000.0, unit "m", range 1e-3 to 1e9;
        /// How edges meet in the corners.
        corners: Corners = Corners::Round;
    }
}

impl Field for Edge {
    fn eval(&self, at: &Points, _: &Inputs, world_params: &WorldParams, out: &mut [f32]) -> Result<()> {
        let Some([w, h]) = world_params.size else {
            out.fill(1.0);
            return Ok(());
        };
        // Distance into the border strip, as a share of its width: 0 inside, 1 at the edge.
        let strip = |v: f64, extent: f64| (1.0 - v.min(extent - v) / self.width).max(0.0);
        each(at, out, |x, y| {
            let (sx, sy) = (strip(x, w), strip(y, h));
            let depth = match self.corners {
                Corners::Round => (sx * sx + sy * sy).sqrt(),
                Corners::Square => sx.max(sy),
            };
            smoothstep(1.0 - depth) as f32
        });
        Ok(())
    }

    fn needs_bounds(&self) -> bool {
        true
    }

    fn cost(&self) -> f64 {
        2.0
    }

    fn lower(&self, _: usize, world_params: &WorldParams) -> Lowering<Shader> {
        let Some([width, height]) = world_params.size else {
            return Lowering::Shader(Shader::new("constant", CONSTANT, &[1.0]));
        };
        let is_square = if self.corners == Corners::Square { 1.0 } else { 0.0 };
        // Distances from the western and northern edges, and from the eastern and southern ones, in widths of the
        // border.
        let shader = Shader::new("edge", include_str!("edge.wgsl"), &[is_square]);
        let lattices = [[0.0, 0.0], [width, height]].map(|origin| Lattice::metres(self.width, origin));
        Lowering::Shader(shader.on(lattices[0]).on(lattices[1]))
    }
}
