// Slope: 1 / (8 cell), and 1 for degrees or 0 for rise over run.
fn slopes(base: u32, at: vec2<i32>) {
    let rise = gradient(0u, at, gradient_scale(base));
    if (is_missing(rise.x)) {
        set_plane(1u, at, rise.x);
        set_plane(2u, at, rise.x);
        set_plane(3u, at, rise.x);
        return;
    }
    set_plane(1u, at, select(steepness(rise), slope_degrees(rise), is_angle(base) > 0.0));
    set_plane(2u, at, rise.x);
    set_plane(3u, at, -rise.y);
}
