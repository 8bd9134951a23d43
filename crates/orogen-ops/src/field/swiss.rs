//! Swiss turbulence.

use orogen_noise::Kind;

op! {
    /// Swiss turbulence: ridged noise whose slopes displace the finer octaves, so that crests branch into spurs. In -1
    /// ..= 1.
    ///
    /// n_i at p + warp d; height += a_i (1 - |n_i|); d -= a_i n_i grad n_i; a_i+1 = a_i gain clamp(height, 0, 1). Over
    /// `white` and the `worley` bases, which have no slope, nothing is displaced. De Carpentier, "Scape: procedural
    /// basics" (2011).
    pub struct Swiss = "swiss", field, revision 1;
    octaves |op| Kind::Swiss { warp: op.warp };
    params {
        /// How far slopes displace the later octaves, in wavelengths of the first octave: 0 is none, 0.15 is typical.
        warp: f64 = 0.15, range -4.0 to 4.0;
    }
}
