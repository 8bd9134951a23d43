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
