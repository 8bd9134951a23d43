//! The altitude at which a layer is sampled.

use super::constant::CONSTANT;
use crate::lower::Lowering;
use crate::op::{Field, Inputs, WorldParams};
use orogen_grid::error::Result;
use orogen_noise::Points;
use orogen_noise::shader::function::Shader;

op! {
    /// The altitude at which the layer is sampled, in metres: 0 in the plane, where maps, meshes and points are made.
    ///
    /// With it a layer is a density in space: `height - altitude` is positive in the ground and negative in the air,
    /// and noise with `vertical` makes caves and overhangs. Programs sample such a layer at any altitude
    /// (`World::volume`). Filters, levelled ops and solvers cannot read it.
    pub struct Altitude = "altitude", field, revision 1;
}

impl Field for Altitude {
    fn eval(&self, _: &Points, inputs: &Inputs, _: &WorldParams, out: &mut [f32]) -> Result<()> {
        out.fill(inputs.altitude() as f32);
        Ok(())
    }

    fn reads_altitude(&self) -> bool {
        true
    }

    fn lower(&self, _: usize, _: &WorldParams) -> Lowering<Shader> {
        // Windows are in the plane.
        Lowering::Shader(Shader::new("constant", CONSTANT, &[0.0]))
    }
}
