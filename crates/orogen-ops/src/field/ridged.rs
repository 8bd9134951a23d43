//! Ridged fractal noise.

use orogen_noise::Kind;

op! {
    /// Ridged noise: the sum of octaves of 1 - 2 |noise|, in -1 ..= 1. It gives sharp crests and round valleys.
    /// Musgrave 1994.
    pub struct Ridged = "ridged", field, revision 1;
    octaves |_| Kind::Ridged;
}
