//! White noise.

op! {
    /// White noise: an independent value in -1 ..= 1 for each square of side `wavelength`.
    pub struct White = "white", field, revision 1;
    params {
        /// Seed of the node, hashed with the world's seed. Two nodes with equal seeds make the same noise.
        seed: u64 = 0;
        /// Side of a square.
        wavelength: f64 = 10.0, unit "m", range 1e-3 to 1e9, alias "scale";
    }
    noise |op, world_params| orogen_noise::White::new(world_params.seed_of(op.seed), op.wavelength);
    cost |_| [1.0, 0.15];
}
