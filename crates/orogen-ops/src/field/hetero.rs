//! Musgrave's heterogeneous terrain.

use orogen_noise::Kind;

op! {
    /// Heterogeneous terrain: each octave is scaled by the height so far, so low ground is smooth and high ground is
    /// rough. In -1 ..= 1.
    ///
    /// h = n_0 + offset; h += h gain^i (n_i + offset). The result is divided by the largest possible product, which is
    /// rarely approached: use `normalise` or `remap` after it. Musgrave in Ebert et al., "Texturing and Modeling"
    /// (1994).
    pub struct Hetero = "hetero", field, revision 1;
    octaves |op| Kind::Hetero { offset: op.offset };
    params {
        /// Value added to the noise. Ground is smooth where the sum of both is small.
        offset: f64 = 0.7, range -4.0 to 4.0;
    }
}
