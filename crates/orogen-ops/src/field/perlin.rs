//! Perlin noise.

op! {
    /// Perlin's gradient noise (2002) on a hashed lattice, in -1 ..= 1. It is smooth and has no period.
    pub struct Perlin = "perlin", field, revision 1;
    params {
        /// Seed of the node, hashed with the world's seed. Two nodes with equal seeds make the same noise.
        seed: u64 = 0;
        /// Distance between lattice points, which is about the distance between hills.
        wavelength: f64 = 1000.0, unit "m", range 1e-3 to 1e9, alias "scale";
    }
    noise |op, world_params| orogen_noise::Perlin::new(world_params.seed_of(op.seed), op.wavelength);
    cost |_| [1.0, 0.15];
}
