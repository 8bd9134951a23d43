// Masks of ranges with smooth ends, as orogen-grid's `Selection`. The numbers from `base` on are low, high, and the
// widths of the ends below and above.

fn selection_fall(beyond: f32, width: f32) -> f32 {
    if (beyond < width) {
        let t = 1.0 - beyond / width;
        return t * t * (3.0 - 2.0 * t);
    }
    return 0.0;
}

fn selected(base: u32, value: f32) -> f32 {
    let low = number(base, 0u);
    let high = number(base, 1u);
    if (value >= low && value <= high) {
        return 1.0;
    }
    if (value < low) {
        return selection_fall(low - value, number(base, 2u));
    }
    return selection_fall(value - high, number(base, 3u));
}
