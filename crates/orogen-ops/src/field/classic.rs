//! Classic Perlin noise, as in textbooks.

use super::basis::{lower, sample};
use crate::lower::Lowering;
use crate::op::{Field, Inputs, WorldParams};
use orogen_noise::Points;
use orogen_noise::shader::function::Shader;

choice! {
    /// The gradient set of classic Perlin noise in 2D.
    pub enum ClassicVariant {
        /// Four diagonals, each listed twice, as in most textbook implementations.
        Diagonal = "diagonal",
        /// Four diagonals and four axis directions.
        Eight = "eight",
        /// Unit vectors at 256 angles, times the square root of 2.
        Angle = "angle",
    }
}

impl ClassicVariant {
    fn noise(self) -> orogen_noise::ClassicVariant {
        match self {
            ClassicVariant::Diagonal => orogen_noise::ClassicVariant::Diagonal,
            ClassicVariant::Eight => orogen_noise::ClassicVariant::Eight,
            ClassicVariant::Angle => orogen_noise::ClassicVariant::Angle,
        }
    }
}

op! {
    /// Perlin's improved noise with the permutation table of his 2002 reference implementation. It repeats every 256
    /// lattice points.
    pub struct Classic = "classic", field, revision 1;
    space;
    params {
        /// Seed of the node, hashed with the world's seed. If both are 0, the permutation table is used as published.
        seed: u64 = 0;
        /// Distance between lattice points.
        wavelength: f64 = 1000.0, unit "m", range 1e-3 to 1e9, alias "scale";
        /// The gradient set.
        variant: ClassicVariant = ClassicVariant::Diagonal;
    }
}

impl Classic {
    fn noise(&self, world_params: &WorldParams) -> orogen_noise::Classic {
        let seed = if world_params.seed == 0 && self.seed == 0 { 0 } else { world_params.seed_of(self.seed) };
        orogen_noise::Classic::new(seed, self.wavelength).with_variant(self.variant.noise())
    }
}

impl Field for Classic {
    fn eval(&self, at: &Points, inputs: &Inputs, world_params: &WorldParams, out: &mut [f32]) {
        sample(&self.noise(world_params), at, self.depth(inputs), out);
    }

    fn lower(&self, _: usize, world_params: &WorldParams) -> Lowering<Shader> {
        lower(&self.noise(world_params), self.vertical)
    }

    fn cost(&self) -> f64 {
        1.0
    }
}
