// Stream power with local rules: an iteration of orogen-grid's `erosion/local_stream_power.rs` as two passes. The
// numbers are the fields of its `Constants`.
//
// The lower eight bits of `frame.step` are the plane of heights that is read, the next eight bits the plane that is
// written.
const SOURCE = 0u;
const FLOW = 1u;
const AREA = 4u;
const SEDIMENT = 5u;
const GIVEN_AREA = 6u;
const GIVEN_SEDIMENT = 7u;

fn positive(x: f32) -> f32 {
    return max(x, 0.0);
}

fn start(base: u32, at: vec2<i32>) {
    set_plane(frame.step >> 8u, at, plane(SOURCE, at));
    set_plane(AREA, at, max(plane(FLOW, at), cell_area(base)));
}

// The weight of a slope: its fourth power, 0 uphill.
fn weight(drop: f32, per: f32) -> f32 {
    let slope = positive(drop) * per;
    let square = slope * slope;
    return square * square;
}

// The area and sediment that a cell gives per unit of weight.
fn give(base: u32, at: vec2<i32>) {
    let heights = frame.step & 0xffu;
    let h = plane(heights, at);
    var all = 0.0;
    for (var y = -1; y <= 1; y += 1) {
        for (var x = -1; x <= 1; x += 1) {
            let per = select(per_side(base), per_corner(base), x * y != 0);
            all += weight(h - plane(heights, at + vec2<i32>(x, y)), per);
        }
    }
    // A pit gives nothing.
    var share = 0.0;
    if (all > 1e-24) {
        share = 1.0 / all;
    }
    set_plane(GIVEN_AREA, at, plane(AREA, at) * share);
    set_plane(GIVEN_SEDIMENT, at, plane(SEDIMENT, at) * share);
}

// Adds the inflow to a cell, and erodes and deposits.
fn take(base: u32, at: vec2<i32>) {
    let heights = frame.step & 0xffu;
    let side = per_side(base);
    let h = plane(heights, at);
    var inflow = vec2<f32>(0.0);
    var lowest = h;
    // The sums of the differences to the neighbors at the sides and the corners.
    var sides = 0.0;
    var corners = 0.0;
    for (var y = -1; y <= 1; y += 1) {
        for (var x = -1; x <= 1; x += 1) {
            let there_at = at + vec2<i32>(x, y);
            let there = plane(heights, there_at);
            let is_corner = x * y != 0;
            let given = weight(there - h, select(side, per_corner(base), is_corner));
            inflow += given * vec2<f32>(plane(GIVEN_AREA, there_at), plane(GIVEN_SEDIMENT, there_at));
            lowest = min(lowest, there);
            corners += select(0.0, there - h, is_corner);
            sides += select(there - h, 0.0, is_corner);
        }
    }
    let n = plane(heights, at - vec2<i32>(0, 1));
    let s = plane(heights, at + vec2<i32>(0, 1));
    let w = plane(heights, at - vec2<i32>(1, 0));
    let e = plane(heights, at + vec2<i32>(1, 0));
    let drained = cell_area(base) + inflow.x;
    let came = inflow.y;
    let across = positive(h - min(w, e)) * side;
    let down = positive(h - min(n, s)) * side;
    let steep = sqrt(across * across + down * down);
    var rate = cut_rate(base) * power(drained, area_exponent(base));
    if (slope_exponent(base) != 0.0) {
        rate *= power(max(steep, 1e-12), slope_exponent(base));
    }
    let cut = min(rate * steep / (1.0 + rate * side), h - lowest);
    // Deposits at most the inflow, and nothing on cells above their surroundings.
    let years = step_years(base);
    let all = came * years / cell_area(base);
    let hollow = positive(0.25 * sides + cut);
    let laid = min(min(laid_rate(base) * came / drained, all), hollow + cut);
    let crept = spread(base) * (4.0 * sides + corners);
    let settled = (h - cut) + ((laid + crept) + risen(base));
    set_plane((frame.step >> 8u) & 0xffu, at, select(h, settled, h > sea_level(base)));
    set_plane(AREA, at, drained);
    set_plane(SEDIMENT, at, positive(came + (cut - laid) * cell_area(base) / years));
}
