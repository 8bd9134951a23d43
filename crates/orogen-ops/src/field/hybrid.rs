//! Musgrave's hybrid multifractal.

use orogen_noise::Kind;

op! {
    /// Hybrid multifractal: each octave is scaled by the product of those before it, so valleys stay smooth and high
    /// ground is rough. In -1 ..= 1.
    ///
    /// s_i = gain^i (n_i + offset); height += w s_i; w = clamp(w s_i, 0, 1), starting at 1. The result is divided by
    /// the largest possible sum, which is rarely approached: use `normalise` or `remap` after it. Musgrave in Ebert et
    /// al., "Texturing and Modeling" (1994).
    pub struct Hybrid = "hybrid", field, revision 1;
    octaves |op| Kind::Hybrid { offset: op.offset };
    params {
        /// Value added to the noise. With 0.7 lowlands are plains; with higher values detail is everywhere.
        offset: f64 = 0.7, range -4.0 to 4.0;
    }
}
