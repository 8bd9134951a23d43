// Slopes by Horn's method, as in orogen-grid's `analysis/slope.rs`.

// Whether a value is infinite or not a number. Shader compilers may assume that there are none, so the bits are compared.
fn is_missing(value: f32) -> bool {
    return (bitcast<u32>(value) & 0x7f800000u) == 0x7f800000u;
}

// Not a number. The sum hides it from compilers that refuse such a constant.
fn missing() -> f32 {
    return bitcast<f32>(0x7fc00000u + min(frame.width, 0u));
}

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

// The arc tangent of x from 0, in radians, to some 2e-7 (as in the Cephes library): WGSL allows its own to be off by 4096 units in the last place.
fn arc_tangent(x: f32) -> f32 {
    var start = 0.0;
    var t = x;
    if (x > 2.4142135) {
        start = 1.5707964;
        t = -1.0 / x;
    } else if (x > 0.41421357) {
        start = 0.78539816;
        t = (x - 1.0) / (x + 1.0);
    }
    let z = t * t;
    let series = ((8.05374449538e-2 * z - 1.38776856032e-1) * z + 1.99777106478e-1) * z - 3.33329491539e-1;
    return start + (series * z * t + t);
}

// The slope in degrees.
fn slope_degrees(rise: vec2<f32>) -> f32 {
    return arc_tangent(steepness(rise)) * 57.29578;
}
