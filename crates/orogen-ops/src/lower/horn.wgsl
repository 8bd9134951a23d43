// Slopes by Horn's method, as in orogen-grid's `analysis/slope.rs`.

// A neighbour's height; level with the centre if it is missing.
fn neighbour(k: u32, at: vec2<i32>, centre: f32) -> f32 {
    let height = plane(k, at);
    return select(height, centre, is_missing(height));
}

// The rise per metre to the east and to the north, of heights in plane `k`; missing where the height is. `scale` is 1 / (8 cell).
fn gradient(k: u32, at: vec2<i32>, scale: f32) -> vec2<f32> {
    let centre = plane(k, at);
    if (is_missing(centre)) {
        return vec2<f32>(missing());
    }
    let nw = neighbour(k, at + vec2<i32>(-1, -1), centre);
    let n = neighbour(k, at + vec2<i32>(0, -1), centre);
    let ne = neighbour(k, at + vec2<i32>(1, -1), centre);
    let w = neighbour(k, at + vec2<i32>(-1, 0), centre);
    let e = neighbour(k, at + vec2<i32>(1, 0), centre);
    let sw = neighbour(k, at + vec2<i32>(-1, 1), centre);
    let s = neighbour(k, at + vec2<i32>(0, 1), centre);
    let se = neighbour(k, at + vec2<i32>(1, 1), centre);
    let east = ((ne - nw) + 2.0 * (e - w) + (se - sw)) * scale;
    let north = ((nw - sw) + 2.0 * (n - s) + (ne - se)) * scale;
    return vec2<f32>(east, north);
}

// The slope, rise over run.
fn steepness(rise: vec2<f32>) -> f32 {
    return sqrt(rise.x * rise.x + rise.y * rise.y);
}

// The slope in degrees.
fn slope_degrees(rise: vec2<f32>) -> f32 {
    return arc_tangent(steepness(rise)) * 57.29578;
}
