// The law of slopes, and the last changes of rivers before growth, as in `law.rs` and in `free_rivers` of `detail.rs`.

// Rivers of detail levels keep slopes that are steeper than the law.
fn kept_slope(base: u32, at: vec2<i32>, slopes: vec2<f32>) -> vec2<f32> {
    let heights = frame.step & 0xffu;
    let code = plane(FIXED, at);
    let area = plane((frame.step >> 8u) & 0xffu, at);
    if (code < 0.0 || code >= NONE || area >= free_area(base)) {
        return slopes;
    }
    let direction = u32(code);
    let fall = plane(heights, at) - plane(heights, at + step_of(direction));
    let slope = fall / (distance_in(direction, at, base) * cell(base));
    let river = slopes.x * power(area, -0.45);
    if (slope > river * slopes.y / (river + slopes.y)) {
        // A river this steep is limited by the stable slope alone.
        return vec2<f32>(1e12, slope);
    }
    return slopes;
}

// The lower eight bits of `frame.step` are the plane of heights, the next eight bits the plane of areas.
fn set_law(base: u32, at: vec2<i32>) {
    let variation = plane(VARIATION, at);
    let uplift = plane(UPLIFT, at);
    var slopes = vec2<f32>(0.0);
    if (has(base, DETAIL)) {
        slopes = vec2<f32>(river_slope(base) * exponential(variation), exponential(uplift));
    } else {
        let logarithm = variation + uplift;
        slopes = vec2<f32>(river_slope(base) * exponential(logarithm), stable_slope(base) * exponential(0.3 * logarithm));
    }
    slopes.y *= factor(given_stability_factor(base), at, 0.01, 100.0);
    if (has(base, DETAIL)) {
        slopes = kept_slope(base, at, slopes);
    }
    set_plane(RIVER, at, slopes.x);
    set_plane(STABLE, at, slopes.y);
    let width = min(exponential(-(variation + uplift)), 4.0);
    set_plane(WIDTH, at, width * factor(given_floor_factor(base), at, 0.01, 100.0));
    set_plane(FIRST_FLOOR, at, 0.0);
    // Rivers of a small area choose their receivers again.
    let fixed = plane(FIXED, at);
    let is_freed = fixed < NONE && plane((frame.step >> 8u) & 0xffu, at) < free_area(base);
    let now = select(fixed, FREE, is_freed);
    set_plane(FIXED, at, now);
    if (has(base, LAKES) && now != FREE) {
        // Rivers and water keep their heights.
        set_plane(LEAST, at, -UNKNOWN);
    }
}
