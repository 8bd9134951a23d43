// The downhill direction: 1 / (8 cell).
fn aspects(base: u32, at: vec2<i32>) {
    let rise = gradient(0u, at, number(base, 0u));
    if (is_missing(rise.x) || (rise.x == 0.0 && rise.y == 0.0)) {
        set_plane(1u, at, missing());
        return;
    }
    set_plane(1u, at, aspect(rise));
}
