// The distances from a node to its neighbors, as in `distances.rs`.
fn distance_in(code: u32, at: vec2<i32>, base: u32) -> f32 {
    if (has(base, FINEST)) {
        return select(1.0, 1.4142135, (code & 1u) != 0u);
    }
    if (code < 4u) {
        return plane(DISTANCE + code, at);
    }
    return plane(DISTANCE + code - 4u, at + step_of(code));
}

