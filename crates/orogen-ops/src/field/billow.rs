//! Billowing fractal noise.

use orogen_noise::Kind;

op! {
    /// Billow noise: the sum of octaves of 2 |noise| - 1, in -1 ..= 1. It gives round hills with sharp valleys between
    /// them.
    pub struct Billow = "billow", field, revision 1;
    octaves |_| Kind::Billow;
}
