// 1 inside a range, falling smoothly to 0 below and above it: the range, and the widths of both transitions.
fn selected(base: u32, value: f32) -> f32 {
    let low = number(base, 0u);
    let high = number(base, 1u);
    let beyond = select(value - high, low - value, value < low);
    let width = select(number(base, 3u), number(base, 2u), value < low);
    if (beyond <= 0.0) {
        return 1.0;
    }
    if (!(beyond < width)) {
        return 0.0;
    }
    let t = 1.0 - beyond / width;
    return t * t * (3.0 - 2.0 * t);
}
