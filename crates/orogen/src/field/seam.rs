//! Rounding the seam where two surfaces meet.

/// The smaller of a and b, with their seam rounded where they differ by less than `smooth`:
/// min(a, b) - h^2 smooth / 4 with h = max(0, smooth - |a - b|) / smooth (Quilez, "Smooth minimum", the quadratic polynomial).
/// With `sign` -1 instead of 1 it is the greater, by the same rule upside down.
pub(super) fn rounded(out: &mut [f32], a: &[f32], b: &[f32], smooth: f32, sign: f32) {
    let pairs = a.iter().zip(b);
    let extreme = |a: f32, b: f32| if sign * a < sign * b { a } else { b };
    if smooth <= 0.0 {
        for (sample, (a, b)) in out.iter_mut().zip(pairs) {
            *sample = extreme(*a, *b);
        }
        return;
    }
    let depth = sign * smooth * 0.25;
    for (sample, (a, b)) in out.iter_mut().zip(pairs) {
        let h = (smooth - (a - b).abs()).max(0.0) / smooth;
        *sample = extreme(*a, *b) - h * h * depth;
    }
}
