//! A round hill, the simplest island.

use super::positions::{each, smoothstep};
use crate::lower::Lowering;
use crate::op::{Field, Inputs, WorldParams};
use orogen_grid::error::Result;
use orogen_noise::Points;
use orogen_noise::shader::function::Shader;
use orogen_noise::shader::lattice::Lattice;

op! {
    /// A round hill: 1 at the center, falling smoothly to 0 at `radius`.
    ///
    /// The falloff is the smoothstep 3t^2 - 2t^3 of t = (radius - distance) / (radius - inner).
    pub struct Radial = "radial", field, revision 1;
    params {
        /// Position of the center: metres east, metres south.
        center: [f64; 2] = [0.0, 0.0], unit "m", range -1e12 to 1e12;
        /// Distance from the center beyond which the value is 0.
        radius: f64 = 1000.0, unit "m", range 1e-3 to 1e9;
        /// Distance from the center up to which the value is 1; it must be less than `radius`.
        inner: f64 = 0.0, unit "m", range 0.0 to 1e9;
    }
    check |op| match op.inner < op.radius {
        true => Ok(()),
        false => Err(("inner", format!("`inner` ({}) must be less than `radius` ({})", op.inner, op.radius))),
    };
}

/// The radius and positions are in units of the falloff's width.
const RADIAL: &str = "fn radial(base: u32, place: Placement) -> f32 {
    let at = vec2<f32>(coordinate(base + 1u, 0u, place), coordinate(base + 1u, 1u, place));
    let t = clamp(number(base, 0u) - length(at), 0.0, 1.0);
    return t * t * (3.0 - 2.0 * t);
}";

impl Field for Radial {
    fn eval(&self, at: &Points, _: &Inputs, _: &WorldParams, out: &mut [f32]) -> Result<()> {
        let [x0, y0] = self.center;
        let span = self.radius - self.inner;
        each(at, out, |x, y| {
            let (dx, dy) = (x - x0, y - y0);
            smoothstep((self.radius - (dx * dx + dy * dy).sqrt()) / span) as f32
        });
        Ok(())
    }

    fn cost(&self) -> f64 {
        2.0
    }

    fn lower(&self, _: usize, _: &WorldParams) -> Lowering<Shader> {
        let span = self.radius - self.inner;
        let shader = Shader::new("radial", RADIAL, &[(self.radius / span) as f32]);
        Lowering::Shader(shader.on(Lattice::metres(span, self.center)))
    }
}
