// A curve: the number of its segments, its ends, and for each segment the start and the coefficients of a cubic.
fn curve(base: u32, place: Placement, source: f32) -> f32 {
    let x = source;
    if (x <= number(base, 1u)) {
        return number(base, 2u);
    }
    if (x >= number(base, 3u)) {
        return number(base, 4u);
    }
    // The last segment that starts at or before x.
    var low = 0u;
    var high = data[base];
    while (low < high) {
        let middle = (low + high) / 2u;
        if (number(base, 5u + 5u * middle) <= x) {
            low = middle + 1u;
        } else {
            high = middle;
        }
    }
    let at = 5u + 5u * (max(low, 1u) - 1u);
    let t = x - number(base, at);
    return number(base, at + 1u) + t * (number(base, at + 2u) + t * (number(base, at + 3u) + t * number(base, at + 4u)));
}
