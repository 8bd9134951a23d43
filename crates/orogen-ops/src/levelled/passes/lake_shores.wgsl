// The smallest heights of land around lakes with an outlet, as in `lake_shores.rs`. The lower eight bits of
// `frame.step` are the plane that is read, the next eight bits the plane that is written, and the bits from 16 on the
// number of the step.

fn rim_fall(base: u32) -> f32 {
    return 0.2 * cell(base);
}

fn begin_rims(base: u32, at: vec2<i32>) {
    var least = -UNKNOWN;
    if (plane(FIXED, at) == WATER && plane(RECEIVER, at) < WATER) {
        least = plane(frame.step & 0xffu, at) + 0.1 + rim_fall(base);
    }
    set_plane((frame.step >> 8u) & 0xffu, at, least);
}

fn widen_rims(base: u32, at: vec2<i32>) {
    let is_first = (frame.step >> 16u) == 0u;
    var least = plane(frame.step & 0xffu, at);
    for (var code = 0u; code < 8u; code += 1u) {
        // All cells at the shore are as high, so that no water leaves over them.
        let distance = select(1.0, 1.4142135, !is_first && (code & 1u) != 0u);
        least = max(least, plane(frame.step & 0xffu, at + step_of(code)) - rim_fall(base) * distance);
    }
    set_plane((frame.step >> 8u) & 0xffu, at, least);
}
