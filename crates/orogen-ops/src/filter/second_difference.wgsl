// Second differences of heights far above zero. The rounding errors of the first differences are added, because they
// are not negligible compared with the result.

// The rounding error of `difference`, which is a - b.
fn rounding(a: f32, b: f32, difference: f32) -> f32 {
    let back = difference - a;
    return (a - (difference - back)) - (b + back);
}

// (a - b) + (c - d).
fn sum_of_differences(a: f32, b: f32, c: f32, d: f32) -> f32 {
    let first = a - b;
    let second = c - d;
    return (first + second) + (rounding(a, b, first) + rounding(c, d, second));
}
