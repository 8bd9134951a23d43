//! Simplex noise.

use orogen_noise::Basis;

op! {
    /// Perlin's Simplex noise (2001), in -1 ..= 1: gradients at the corners of a triangular lattice. It has no
    /// artifacts along the axes.
    ///
    /// Features are about 0.7 times as wide as those of `perlin` at the same wavelength. Gustavson, "Simplex noise
    /// demystified" (2005).
    pub struct Simplex = "simplex", field, revision 1;
    params {
        /// Seed of the node, hashed with the world's seed. Two nodes with equal seeds make the same noise.
        seed: u64 = 0;
        /// Side of the squares that are skewed into the triangular lattice.
        wavelength: f64 = 1000.0, unit "m", range 1e-3 to 1e9, alias "scale";
    }
    noise |op, world_params| orogen_noise::Simplex::new(world_params.seed_of(op.seed), op.wavelength);
    cost |_| Basis::Simplex.cost();
}
