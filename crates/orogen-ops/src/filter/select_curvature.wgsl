// A mask by curvature: samples between the heights, their distance in metres, the kind, the range.
fn select_curvatures(base: u32, at: vec2<i32>) {
    let apart = i32(number(base, 0u));
    let c = number(base, 1u);
    let kind = number(base, 2u);
    let nw = plane(0u, at + vec2<i32>(-apart, -apart));
    let n = plane(0u, at + vec2<i32>(0, -apart));
    let ne = plane(0u, at + vec2<i32>(apart, -apart));
    let w = plane(0u, at + vec2<i32>(-apart, 0));
    let z = plane(0u, at);
    let e = plane(0u, at + vec2<i32>(apart, 0));
    let sw = plane(0u, at + vec2<i32>(-apart, apart));
    let s = plane(0u, at + vec2<i32>(0, apart));
    let se = plane(0u, at + vec2<i32>(apart, apart));
    // As in orogen-grid's `analysis/curvature.rs`.
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
    // All nine heights must be known, also where the corners do not matter.
    if (is_missing(bend) || is_missing(d)) {
        set_plane(1u, at, 0.0);
        return;
    }
    set_plane(1u, at, selected(base + 3u, bend));
}
