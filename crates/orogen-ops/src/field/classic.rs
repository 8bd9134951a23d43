//! Classic Perlin noise, as in textbooks.

choice! {
    /// The gradient set of classic Perlin noise in 2D.
    pub enum ClassicVariant as orogen_noise::ClassicVariant {
        /// Four diagonals, each listed twice, as in most textbook implementations.
        Diagonal = "diagonal",
        /// Four diagonals and four axis directions.
        Eight = "eight",
        /// Unit vectors at 256 angles, times the square root of 2.
        Angle = "angle",
    }
}

op! {
    /// Perlin's improved noise with the permutation table of his 2002 reference implementation. It repeats every 256
    /// lattice points.
    pub struct Classic = "classic", field, revision 1;
    params {
        /// Seed of the node, hashed with the world's seed. If both are 0, the permutation table is used as published.
        seed: u64 = 0;
        /// Distance between lattice points.
        wavelength: f64 = 1000.0, unit "m", range 1e-3 to 1e9, alias "scale";
        /// The gradient set.
        variant: ClassicVariant = ClassicVariant::Diagonal;
    }
    noise |op, world_params| {
        let seed = if world_params.seed == 0 && op.seed == 0 { 0 } else { world_params.seed_of(op.seed) };
        orogen_noise::Classic::new(seed, op.wavelength).with_variant(op.variant.into())
    };
    cost |_| [1.0, 0.15];
}
