// A mask by aspect: 1 / (8 cell), the direction, the range of angles to it, the range of slopes.

// Downhill, in degrees clockwise from north.
fn aspect(rise: vec2<f32>) -> f32 {
    let east = -rise.x;
    let north = -rise.y;
    // The angle to the nearer axis is computed, so that the quotient is at most 1.
    let x = abs(east);
    let y = abs(north);
    var angle = arc_tangent(min(x, y) / max(x, y)) * 57.29578;
    angle = select(angle, 90.0 - angle, x > y);
    angle = select(angle, 180.0 - angle, north < 0.0);
    angle = select(angle, 360.0 - angle, east < 0.0);
    return select(angle, 0.0, angle >= 360.0);
}

fn select_aspects(base: u32, at: vec2<i32>) {
    let rise = gradient(0u, at, number(base, 0u));
    if (is_missing(rise.x) || (rise.x == 0.0 && rise.y == 0.0)) {
        set_plane(1u, at, 0.0);
        return;
    }
    var off = abs(aspect(rise) - number(base, 1u)) % 360.0;
    off = select(off, 360.0 - off, off > 180.0);
    set_plane(1u, at, selected(base + 2u, off) * selected(base + 6u, slope_degrees(rise)));
}
