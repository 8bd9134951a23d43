//! Folded fractal noise.

use orogen_noise::Kind;

op! {
    /// Ping-pong noise: a sum of octaves of folded noise, in -1 ..= 1. It gives contour bands like those of agate or of
    /// rice terraces.
    ///
    /// t = strength (n_i + 1) is folded into 0 ..= 1 as a triangle wave. The result is the sum of gain^i (2 t - 1),
    /// divided by the sum of the amplitudes.
    pub struct PingPong = "ping-pong", field, revision 1;
    octaves |op| Kind::PingPong { strength: op.strength };
    params {
        /// How often the noise's range is folded (2 strength - 1 times): 0.5 gives plain fBm, 1 gives `ridged`, 2 is
        /// typical, 4 gives many bands.
        strength: f64 = 2.0, range 0.5 to 64.0;
    }
}
