// A mask by aspect: 1 / (8 cell), the direction, the range of angles to it, the range of slopes.
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
