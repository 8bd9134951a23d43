// Hillshade, as in orogen-grid's `analysis/hillshade.rs`: 1 / (8 cell), the direction of the light (east, north, up),
// and the factor of heights.
fn hillshade(base: u32, at: vec2<i32>) {
    let rise = number(base, 4u) * gradient(0u, at, number(base, 0u));
    if (is_missing(rise.x + rise.y)) {
        set_plane(1u, at, 0.0);
        return;
    }
    let light = number(base, 3u) - rise.x * number(base, 1u) - rise.y * number(base, 2u);
    set_plane(1u, at, clamp(light / sqrt(1.0 + dot(rise, rise)), 0.0, 1.0));
}
