// Indices of wetness and erosion: 1 / (8 cell), the cell, the least slope.
fn indices(base: u32, at: vec2<i32>) {
    let cell = cell(base);
    let rise = gradient(0u, at, gradient_scale(base));
    if (is_missing(rise.x)) {
        set_plane(2u, at, rise.x);
        set_plane(3u, at, rise.x);
        set_plane(4u, at, rise.x);
        return;
    }
    let slope = max(steepness(rise), least_slope(base));
    let area = max(plane(1u, at) / cell, cell);
    let sine = slope / sqrt(1.0 + slope * slope);
    set_plane(2u, at, log(area / slope));
    set_plane(3u, at, area * slope);
    set_plane(4u, at, 1.4 * pow(area / 22.13, 0.4) * pow(sine / 0.0896, 1.3));
}
