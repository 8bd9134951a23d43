//! Helpers for stencils over rows. Explicit comparisons compile to one instruction each; the functions of the standard
//! library, which handle NaN, compile to three.

/// `x`, or 0 if it is negative or NaN.
#[inline(always)]
#[must_use]
pub fn positive(x: f32) -> f32 {
    if x > 0.0 { x } else { 0.0 }
}

/// The minimum; the second argument if either is NaN.
#[inline(always)]
#[must_use]
pub fn least(a: f32, b: f32) -> f32 {
    if a < b { a } else { b }
}

/// The maximum; the second argument if either is NaN.
#[inline(always)]
#[must_use]
pub fn most(a: f32, b: f32) -> f32 {
    if a > b { a } else { b }
}

/// A row plus the flows over the sides of its cells. `sides` flows east between the columns (one more than there are
/// cells); `above` and `below` flow south over the two edges of the row.
#[inline(always)]
pub fn settle(here: &[f32], [sides, above, below]: [&[f32]; 3], out: &mut [f32]) {
    let n = out.len();
    let [west, east] = [&sides[..n], &sides[1..=n]];
    let (here, above, below) = (&here[..n], &above[..n], &below[..n]);
    for i in 0..n {
        out[i] = here[i] + ((west[i] - east[i]) + (above[i] - below[i]));
    }
}
