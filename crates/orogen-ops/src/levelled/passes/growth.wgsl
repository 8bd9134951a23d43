// A pass of growth, as in `growth_row.rs`. The lowest eight bits of `frame.step` are the plane of heights that is read,
// followed by the plane of heights that is written and the plane of areas, with eight bits each. The next bit is 0 if
// the first plane of floors is read and the second one written.

// The data with which all neighbors of a node are compared, and the best neighbor so far.
struct Growing {
    rise: f32,
    flat_rise: f32,
    below: f32,
    fixed: f32,
    lowest: f32,
    best: f32,
    floor_left: f32,
}

fn begin(base: u32, at: vec2<i32>, height: f32, area: f32) -> Growing {
    let fixed = plane(FIXED, at);
    let slope = plane(RIVER, at) * power(area, -0.45);
    let stable = plane(STABLE, at);
    let rise = max(slope * stable / (slope + stable) * cell(base), least_rise(base));
    return Growing(rise, min(0.02 * cell(base), rise), select(-UNKNOWN, height, fixed == FREE), fixed, UNKNOWN, -1.0, 0.0);
}

// Takes the height over the neighbor in a direction if it is the lowest so far. A diagonal link must not cross a river
// between the two cells on its sides; `beside` are the fixed receivers of these cells.
fn offer(base: u32, at: vec2<i32>, code: u32, there: f32, beside: vec2<f32>, before: Growing) -> Growing {
    var growing = before;
    let near = at + step_of(code);
    let distance = distance_in(code, at, base);
    var left = 0.0;
    if (has(base, FLOORS)) {
        left = plane(FIRST_FLOOR + ((frame.step >> 24u) & 1u), near) - distance * cell(base);
    }
    let candidate = there + distance * select(growing.rise, growing.flat_rise, left > 0.0);
    let across = vec2<f32>(f32((code + 2u) & 7u), f32((code + 6u) & 7u));
    let crosses = (code & 1u) != 0u && any(beside == across);
    let possible = (there < growing.below && !crosses) || growing.fixed == f32(code);
    if (possible && candidate < growing.lowest) {
        growing.lowest = candidate;
        growing.best = f32(code);
        growing.floor_left = left;
    }
    return growing;
}

// Takes the height of a front that passes between a neighbor and the lower neighbor next to it, if it is the lowest so
// far.
fn front(here: f32, there: f32, corner: f32, beside: u32, before: Growing) -> Growing {
    var growing = before;
    let fall = there - corner;
    let candidate = there + sqrt(max(growing.rise * growing.rise - fall * fall, 0.0));
    if (fall > 0.0 && fall < growing.rise * 0.70710677 && corner < here && candidate < growing.lowest) {
        growing.lowest = candidate;
        growing.best = f32(beside);
        growing.floor_left = 0.0;
    }
    return growing;
}

fn grow(base: u32, at: vec2<i32>) {
    let height = plane(frame.step & 0xffu, at);
    let area = plane((frame.step >> 16u) & 0xffu, at);
    var growing = begin(base, at, height, area);
    var heights: array<f32, 8>;
    for (var code = 0u; code < 8u; code += 1u) {
        heights[code] = plane(frame.step & 0xffu, at + step_of(code));
    }
    // In the east, south, west and north.
    var fixed: array<f32, 4>;
    for (var side = 0u; side < 4u; side += 1u) {
        fixed[side] = plane(FIXED, at + step_of(2u * side));
    }
    for (var code = 0u; code < 8u; code += 1u) {
        let beside = vec2<f32>(fixed[code >> 1u], fixed[((code + 1u) & 7u) >> 1u]);
        growing = offer(base, at, code, heights[code], beside, growing);
    }
    if (has(base, FINEST) && growing.fixed == FREE && area < 30.0) {
        for (var code = 0u; code < 8u; code += 2u) {
            let last = (code + 7u) & 7u;
            growing = front(height, heights[code], heights[code + 1u], code + 1u, growing);
            growing = front(height, heights[code], heights[last], last, growing);
        }
    }
    var lowest = growing.lowest;
    if (has(base, LAKES)) {
        lowest = max(lowest, plane(LEAST, at));
    }
    set_plane((frame.step >> 8u) & 0xffu, at, min(lowest, height));
    if (growing.best >= 0.0) {
        set_plane(RECEIVER, at, growing.best);
    }
    if (has(base, FLOORS)) {
        // The distance over which a river's floor continues, from the river's size or from downstream.
        let share = area * floor_area(base);
        var own = 0.0;
        if (share > 1.0 && growing.fixed < WATER) {
            own = 75.0 * sqrt(share) * plane(WIDTH, at);
        }
        set_plane(SECOND_FLOOR - ((frame.step >> 24u) & 1u), at, max(growing.floor_left, own));
    }
}
