//! Value noise.

choice! {
    /// Interpolation between the lattice points of value noise.
    pub enum Fade as orogen_noise::Fade {
        /// 6 t^5 - 15 t^4 + 10 t^3: continuous first and second derivatives.
        Quintic = "quintic",
        /// 3 t^2 - 2 t^3: continuous first derivative.
        Cubic = "cubic",
        /// t: linear interpolation, with creases along the lattice lines.
        Linear = "linear",
    }
}

op! {
    /// Value noise: random values in -1 ..= 1 on a square lattice, interpolated between the lattice points.
    pub struct Value = "value", field, revision 1;
    params {
        /// Seed of the node, hashed with the world's seed. Two nodes with equal seeds make the same noise.
        seed: u64 = 0;
        /// Distance between lattice points.
        wavelength: f64 = 1000.0, unit "m", range 1e-3 to 1e9, alias "scale";
        /// Interpolation between lattice points.
        fade: Fade = Fade::Quintic;
    }
    noise |op, world_params| orogen_noise::Value::new(world_params.seed_of(op.seed), op.wavelength).with_fade(op.fade.into());
    cost |_| [1.0, 0.15];
}
