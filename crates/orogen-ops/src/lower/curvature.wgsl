// The curvature at a sample of plane `k`, as in orogen-grid's `analysis/curvature.rs`, from heights `apart` samples and
// `c` metres apart; missing if one of the nine heights is missing. The kind is 0 for total curvature, 1 along the
// slope, 2 along the contour.
fn curvature(k: u32, at: vec2<i32>, apart: i32, c: f32, kind: f32) -> f32 {
    let nw = plane(k, at + vec2<i32>(-apart, -apart));
    let n = plane(k, at + vec2<i32>(0, -apart));
    let ne = plane(k, at + vec2<i32>(apart, -apart));
    let w = plane(k, at + vec2<i32>(-apart, 0));
    let z = plane(k, at);
    let e = plane(k, at + vec2<i32>(apart, 0));
    let sw = plane(k, at + vec2<i32>(-apart, apart));
    let s = plane(k, at + vec2<i32>(0, apart));
    let se = plane(k, at + vec2<i32>(apart, apart));
    let r = sum_of_differences(w, z, e, z) / (c * c);
    let t = sum_of_differences(n, z, s, z) / (c * c);
    let d = sum_of_differences(nw, ne, se, sw) / (4.0 * c * c);
    let p = (e - w) / (2.0 * c);
    let q = (s - n) / (2.0 * c);
    let steep = p * p + q * q;
    var bend = 0.0;
    if (kind == 0.0) {
        bend = -(r + t);
    } else if (steep == 0.0) {
        bend = 0.0;
    } else if (kind == 1.0) {
        let one = 1.0 + steep;
        bend = -(r * p * p + 2.0 * d * p * q + t * q * q) / (steep * one * sqrt(one));
    } else {
        bend = -(r * q * q - 2.0 * d * p * q + t * p * p) / (steep * sqrt(steep));
    }
    // The corners enter only through d, so d also shows whether a corner is missing where its value does not matter.
    return select(bend, missing(), is_missing(bend) || is_missing(d));
}
