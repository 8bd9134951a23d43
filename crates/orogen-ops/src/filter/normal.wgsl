// The upward unit normal, as in orogen-grid's `analysis/slope.rs`: 1 / (8 cell).
fn normal(base: u32, at: vec2<i32>) {
    let rise = gradient(0u, at, number(base, 0u));
    if (is_missing(rise.x + rise.y)) {
        set_plane(1u, at, missing());
        set_plane(2u, at, missing());
        set_plane(3u, at, missing());
        return;
    }
    let length = sqrt(1.0 + dot(rise, rise));
    set_plane(1u, at, -rise.x / length);
    set_plane(2u, at, -rise.y / length);
    set_plane(3u, at, 1.0 / length);
}
