// Steady-state soil depth: cell, critical slope, creep, decay, density ratio times production, deepest.
//
// The depth follows from the difference of the fluxes through opposite sides, which is much smaller than the fluxes.
// With the slopes S across the two sides and s = |slope|^2 / critical^2 there, it is
//
//   creep ((S1 - S0) (1 - s0) + S0 (s1 - s0)) / ((1 - s0) (1 - s1))
//
// where the differences of slopes are second differences of heights.

// The difference of the fluxes through two sides, for a creep of 1, from the slopes `across` and `along` each side and
// the differences of the slopes. The second part of the result is 1 if a side is at the critical slope or above it,
// otherwise 0.
fn flux_difference(across: vec2<f32>, along: vec2<f32>, difference: vec2<f32>, critical: f32) -> vec2<f32> {
    let square = critical * critical;
    let share = (across * across + along * along) / square;
    if (share.x >= 1.0 || share.y >= 1.0) {
        return vec2<f32>(0.0, 1.0);
    }
    let left = 1.0 - share;
    let steeper = (difference.x * (across.x + across.y) + difference.y * (along.x + along.y)) / square;
    return vec2<f32>((difference.x * left.x + across.x * steeper) / (left.x * left.y), 0.0);
}

fn depths(base: u32, at: vec2<i32>) {
    let c = cell(base);
    let critical = critical_slope(base);
    let nw = plane(0u, at + vec2<i32>(-1, -1));
    let n = plane(0u, at + vec2<i32>(0, -1));
    let ne = plane(0u, at + vec2<i32>(1, -1));
    let w = plane(0u, at + vec2<i32>(-1, 0));
    let z = plane(0u, at);
    let e = plane(0u, at + vec2<i32>(1, 0));
    let sw = plane(0u, at + vec2<i32>(-1, 1));
    let s = plane(0u, at + vec2<i32>(0, 1));
    let se = plane(0u, at + vec2<i32>(1, 1));
    // A difference with a missing height is missing, and so is the sum of the absolute differences.
    let all = (abs(nw - z) + abs(n - z) + abs(ne - z)) + (abs(w - z) + abs(e - z)) + (abs(sw - z) + abs(s - z) + abs(se - z));
    if (is_missing(all)) {
        set_plane(1u, at, missing());
        return;
    }
    let corners = sum_of_differences(ne, nw, sw, se) / (4.0 * c);
    let columns = flux_difference(
        vec2<f32>(w - z, z - e) / c,
        vec2<f32>((nw - sw) + (n - s), (n - s) + (ne - se)) / (4.0 * c),
        vec2<f32>(sum_of_differences(z, e, z, w) / c, corners),
        critical,
    );
    let rows = flux_difference(
        vec2<f32>(n - z, z - s) / c,
        vec2<f32>((nw - ne) + (w - e), (w - e) + (sw - se)) / (4.0 * c),
        vec2<f32>(sum_of_differences(z, s, z, n) / c, corners),
        critical,
    );
    let carried = creep(base) * (columns.x + rows.x) / c;
    let deepest = deepest(base);
    var depth = deepest;
    if (columns.y + rows.y > 0.0) {
        depth = 0.0;
    } else if (carried > 0.0) {
        depth = clamp(decay(base) * log(made(base) / carried), 0.0, deepest);
    }
    set_plane(1u, at, depth);
}
