//! A plane that rises in one direction.

use super::positions::each;
use crate::lower::Lowering;
use crate::op::{Field, Inputs, WorldParams};
use orogen_grid::error::Result;
use orogen_noise::Points;
use orogen_noise::shader::function::Shader;
use orogen_noise::shader::lattice::Lattice;

op! {
    /// An inclined plane: 0 at `origin`, rising by 1 every `length` metres in the direction `azimuth`.
    ///
    /// With `azimuth = 90` the value is x / length (rising to the east), with 180 it is y / length (rising to the
    /// south).
    pub struct Ramp = "ramp", field, revision 1;
    params {
        /// Direction of the rise, clockwise from north.
        azimuth: f64 = 90.0, unit "deg", range -360.0 to 360.0;
        /// Distance over which the value rises by 1.
        length: f64 = 1000.0, unit "m", range 1e-3 to 1e9;
        /// Position where the value is 0: metres east, metres south.
        origin: [f64; 2] = [0.0, 0.0], unit "m", range -1e12 to 1e12;
    }
}

/// Sine and cosine of an angle in degrees, exact at the right angles so that axes stay axes.
pub(super) fn sin_cos_degrees(degrees: f64) -> (f64, f64) {
    let turn = degrees.rem_euclid(360.0);
    if turn == 0.0 {
        (0.0, 1.0)
    } else if turn == 90.0 {
        (1.0, 0.0)
    } else if turn == 180.0 {
        (0.0, -1.0)
    } else if turn == 270.0 {
        (-1.0, 0.0)
    } else {
        libm::sincos(turn.to_radians())
    }
}

impl Field for Ramp {
    fn eval(&self, at: &Points, _: &Inputs, _: &WorldParams, out: &mut [f32]) -> Result<()> {
        // North is up and y grows south: azimuth 0 rises towards -y.
        let (sin, cos) = sin_cos_degrees(self.azimuth);
        let [x0, y0] = self.origin;
        each(at, out, |x, y| (((x - x0) * sin - (y - y0) * cos) / self.length) as f32);
        Ok(())
    }

    fn lower(&self, _: usize, _: &WorldParams) -> Lowering<Shader> {
        const CODE: &str = "fn ramp(base: u32, place: Placement) -> f32 { return coordinate(base, 0u, place); }";
        let (sin, cos) = sin_cos_degrees(self.azimuth);
        let [along_x, along_y] = [sin / self.length, -cos / self.length];
        let [x0, y0] = self.origin;
        // The rise is a coordinate along one axis.
        let lattice = Lattice {
            matrix: [[along_x, along_y], [0.0, 0.0]],
            offset: [-(x0 * along_x + y0 * along_y), 0.0],
            limit: f64::MAX,
        };
        Lowering::Shader(Shader::new("ramp", CODE, &[]).on(lattice))
    }
}
