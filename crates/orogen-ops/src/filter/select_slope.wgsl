// A mask by slope: 1 / (8 cell), then the range.
fn select_slopes(base: u32, at: vec2<i32>) {
    let rise = gradient(0u, at, number(base, 0u));
    if (is_missing(rise.x)) {
        set_plane(1u, at, 0.0);
        return;
    }
    set_plane(1u, at, selected(base + 1u, slope_degrees(rise)));
}
