// Slopes by Horn's method, as in orogen-grid's `analysis/slope.rs`.

// The height of a neighbor; the height of the center if it is missing.
fn neighbor(k: u32, at: vec2<i32>, center: f32) -> f32 {
    let height = plane(k, at);
    return select(height, center, is_missing(height));
}

// The rise per metre to the east and to the north, of heights in plane `k`; missing where the height is. `scale` is 1 /
// (8 cell).
fn gradient(k: u32, at: vec2<i32>, scale: f32) -> vec2<f32> {
    let center = plane(k, at);
    if (is_missing(center)) {
        return vec2<f32>(missing());
    }
    let nw = neighbor(k, at + vec2<i32>(-1, -1), center);
    let n = neighbor(k, at + vec2<i32>(0, -1), center);
    let ne = neighbor(k, at + vec2<i32>(1, -1), center);
    let w = neighbor(k, at + vec2<i32>(-1, 0), center);
    let e = neighbor(k, at + vec2<i32>(1, 0), center);
    let sw = neighbor(k, at + vec2<i32>(-1, 1), center);
    let s = neighbor(k, at + vec2<i32>(0, 1), center);
    let se = neighbor(k, at + vec2<i32>(1, 1), center);
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
