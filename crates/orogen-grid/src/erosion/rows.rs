//! What stencils over rows have in common. Comparisons written out become one instruction each; the library's, which
//! look after NaN, three.

/// What is above 0 of it.
#[inline(always)]
pub fn positive(x: f32) -> f32 {
    if x > 0.0 { x } else { 0.0 }
}

/// The lesser; the second where either is NaN.
#[inline(always)]
pub fn least(a: f32, b: f32) -> f32 {
    if a < b { a } else { b }
}

/// The greater; the second where either is NaN.
#[inline(always)]
pub fn most(a: f32, b: f32) -> f32 {
    if a > b { a } else { b }
}

/// A row with what came in over its cells' sides and what went out: `sides` moves east between the columns, one more
/// than there are cells, `above` and `below` south over the row's two edges.
#[inline(always)]
pub fn settle(here: &[f32], [sides, above, below]: [&[f32]; 3], out: &mut [f32]) {
    let n = out.len();
    let [west, east] = [&sides[..n], &sides[1..=n]];
    let (here, above, below) = (&here[..n], &above[..n], &below[..n]);
    for i in 0..n {
        out[i] = here[i] + ((west[i] - east[i]) + (above[i] - below[i]));
    }
}
