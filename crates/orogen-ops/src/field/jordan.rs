//! Jordan turbulence.

use orogen_noise::Kind;

op! {
    /// Jordan turbulence: squared noise, displaced and damped by the slopes of earlier octaves. It gives rounded
    /// massifs with worn flanks. In -1 ..= 1.
    ///
    /// n_i at p + warp d, in cells of octave i; height += a_i n_i^2; d += n_i grad n_i; a_0 = 1, a_i = gain^i (1 - 1 /
    /// (1 + |damp d|^2)). Over `white` and the `worley` bases, which have no slope, only the first octave remains. De
    /// Carpentier, "Scape: procedural basics" (2011).
    pub struct Jordan = "jordan", field, revision 1;
    octaves |op| Kind::Jordan { warp: op.warp, damp: op.damp };
    params {
        /// How far slopes displace the later octaves, in cells of those octaves: 0 is none, 0.35 is typical.
        warp: f64 = 0.35, range -4.0 to 4.0;
        /// How far slopes let later octaves through: with 0 only the first octave remains, 0.8 is typical.
        damp: f64 = 0.8, range 0.0 to 100.0;
    }
}
