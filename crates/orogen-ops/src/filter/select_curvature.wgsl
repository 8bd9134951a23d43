// A mask by curvature: samples between the heights, their distance in metres, the kind, the range.
fn select_curvatures(base: u32, at: vec2<i32>) {
    let bend = curvature(0u, at, i32(number(base, 0u)), number(base, 1u), number(base, 2u));
    if (is_missing(bend)) {
        set_plane(1u, at, 0.0);
        return;
    }
    set_plane(1u, at, selected(base + 3u, bend));
}
