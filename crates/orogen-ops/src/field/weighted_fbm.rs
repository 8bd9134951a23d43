//! Gradient-weighted fractal noise.

use orogen_noise::Kind;

choice! {
    /// How slope damps an octave of weighted fBm. m is the squared slope of the octaves so far (dimensionless).
    pub enum Falloff as orogen_noise::Falloff {
        /// 1 / (1 + k m).
        Reciprocal = "reciprocal",
        /// e^(-k m).
        Exponential = "exponential",
        /// 1 / (1 + k sqrt m).
        SquareRoot = "square-root",
        /// 1 - smoothstep(k m): 0 beyond k m = 1.
        Smoothstep = "smoothstep",
    }
}

op! {
    /// Weighted fBm: octaves of noise, each damped by the slope of the octaves before it. Steep ground stays smooth;
    /// detail concentrates on flats and crests. In -1 ..= 1.
    ///
    /// d += (gain lacunarity)^i grad n_i; height += gain^i n_i falloff(k |d|^2), divided by the sum of the amplitudes.
    /// Quilez, "Value noise derivatives" (2008).
    pub struct WeightedFbm = "weighted-fbm", field, revision 1;
    octaves |op| Kind::Weighted { k: op.k, falloff: op.falloff.into() };
    params {
        /// How strongly slope damps later octaves: 0 gives plain fBm, 1 is typical, 10 leaves bare pyramids.
        k: f64 = 1.0, range 0.0 to 1e6;
        /// Damping function, with m the squared slope.
        falloff: Falloff = Falloff::Reciprocal;
    }
}
