// Heights and water at samples, as in `surface.rs`.
const RADIUS_SQUARED = 2.5;
const MIN_DEPTH = 0.5;

fn above_the_sea(bed: f32, surface: f32) -> f32 {
    return max(bed, 0.5 * min(surface, 1.0));
}

fn sea_bottom(distance: f32) -> f32 {
    let t = clamp((distance - 80.0) / 200.0, 0.0, 1.0);
    let shelf = 1.8 * min(distance, 80.0);
    let rise = min(max(distance - 280.0, 0.0) * 1.5, 1400.0);
    return -(shelf + 3400.0 * t * t * (3.0 - 2.0 * t) + rise);
}

// Height of the bottom of standing water.
fn bottom(at: vec2<i32>) -> f32 {
    let height = plane(HEIGHT, at);
    let distance = max(-plane(SHORE, at), 0.0);
    if (height > 0.0) {
        if (is_lake(plane(RECEIVER, at))) {
            return above_the_sea(height - min(80.0 * distance, 300.0), height);
        }
        return height - min(8.0 * distance, 120.0);
    }
    return sea_bottom(distance);
}

// Weighted sums for the least-squares plane through values: of x, y and the values; of x x, x y and y y; of x value and
// y value.
struct Sums {
    weight: f32,
    first: vec3<f32>,
    second: vec3<f32>,
    values: vec2<f32>,
}

fn added(sums: Sums, weight: f32, by: vec2<f32>, value: f32) -> Sums {
    let weighted = weight * by;
    return Sums(
        sums.weight + weight,
        sums.first + vec3<f32>(weighted, weight * value),
        sums.second + vec3<f32>(weighted.x * by.x, weighted.x * by.y, weighted.y * by.y),
        sums.values + weighted * value,
    );
}

fn mean(sums: Sums) -> f32 {
    return sums.first.z / max(sums.weight, 1e-6);
}

// The value of the plane at the sample.
fn at_origin(sums: Sums) -> f32 {
    let inverse = 1.0 / max(sums.weight, 1e-6);
    let first = sums.first * inverse;
    let second = sums.second * inverse;
    let values = sums.values * inverse;
    let a = second.x - first.x * first.x + 0.02;
    let b = second.y - first.x * first.y;
    let d = second.z - first.y * first.y + 0.02;
    let e = values.x - first.x * first.z;
    let f = values.y - first.y * first.z;
    let determinant = a * d - b * b;
    return first.z - (e * d - f * b) / determinant * first.x - (f * a - e * b) / determinant * first.y;
}

fn set_point(base: u32, at: vec2<i32>, height: f32, area: f32, lake: f32, water: f32, receiver: f32) {
    set_plane(LAYER_HEIGHT, at, height);
    set_plane(LAYER_FLOW, at, area * square_metres(base));
    set_plane(LAYER_LAKE, at, lake);
    set_plane(LAYER_RECEIVER, at, receiver);
    set_plane(WATER_LEVEL, at, water);
}

// A node of the finest level of valleys, which is at a sample.
fn at_node(base: u32, at: vec2<i32>) {
    let height = plane(HEIGHT, at);
    let area = plane(AREA, at);
    let receiver = plane(RECEIVER, at);
    if (receiver < NONE) {
        set_point(base, at, height, area, 0.0, missing(), receiver);
        return;
    }
    let bed = bottom(at);
    set_point(base, at, bed, area, select(0.0, height - bed, height > 0.0), height, receiver);
}

// The rise in metres from a node to its neighbor at the source of a river.
fn slope_of_one_cell(base: u32, logarithm: f32) -> f32 {
    let river = river_slope(base) * exponential(logarithm);
    let stable = stable_slope(base) * exponential(0.3 * logarithm);
    return river * stable / (river + stable) * cell(base);
}

fn surface(base: u32, at: vec2<i32>) {
    if (has(base, FINEST)) {
        at_node(base, at);
        return;
    }
    var land = Sums(0.0, vec3<f32>(0.0), vec3<f32>(0.0), vec2<f32>(0.0));
    var water = land;
    var shore = land;
    var nearest = at;
    var nearest_square = UNKNOWN;
    var nearest_water = at;
    var water_square = UNKNOWN;
    for (var row = -2; row < 2; row += 1) {
        for (var column = -2; column < 2; column += 1) {
            let by = vec2<i32>(column, row);
            let o = at + by;
            let place = vec2<f32>(plane(EAST, o), plane(SOUTH, o)) + vec2<f32>(by) - vec2<f32>(inside(base));
            let square = dot(place, place);
            let is_water = plane(RECEIVER, o) >= NONE;
            if (square < nearest_square) {
                nearest_square = square;
                nearest = o;
            }
            if (is_water && square < water_square) {
                water_square = square;
                nearest_water = o;
            }
            let share = 1.0 - square / RADIUS_SQUARED;
            if (share > 0.0) {
                let weight = share * share;
                shore = added(shore, weight, place, plane(SHORE, o));
                land = added(land, weight, place, plane(HEIGHT, o));
                if (is_water) {
                    water = added(water, weight, place, bottom(o));
                }
            }
        }
    }
    let area = plane(AREA, nearest);
    let has_water = water_square < KNOWN;
    if (has_water && mean(shore) < 0.0) {
        let level = plane(HEIGHT, nearest_water);
        let receiver = plane(RECEIVER, nearest_water);
        var bed = 0.0;
        if (water.weight > 0.0) {
            bed = mean(water);
        } else {
            bed = bottom(nearest_water);
        }
        bed = min(bed, level - MIN_DEPTH);
        if (is_lake(receiver)) {
            bed = above_the_sea(bed, level);
        }
        set_point(base, at, bed, area, select(0.0, level - bed, level > 0.0), level, receiver);
        return;
    }
    let change = mean_change(base) * slope_of_one_cell(base, plane(VARIATION, nearest) + plane(UPLIFT, nearest));
    var height = at_origin(land) + change;
    if (has_water) {
        // Land at a shore is not lower than the water.
        height = max(height, plane(HEIGHT, nearest_water));
    }
    set_point(base, at, height, area, 0.0, missing(), min(plane(RECEIVER, nearest), NONE));
}

// The layers that are computed from these.
fn finish_layers(base: u32, at: vec2<i32>) {
    let water = plane(WATER_LEVEL, at);
    let is_land = is_missing(water);
    let ground = plane(LAYER_HEIGHT, at);
    set_plane(LAYER_HEIGHT, at, ground + sea_level(base));
    set_plane(LAYER_SURFACE, at, select(water, ground, is_land) + sea_level(base));
    let receiver = plane(LAYER_RECEIVER, at);
    if (is_lake(receiver)) {
        set_plane(LAYER_RECEIVER, at, min(receiver - LAKE, NONE));
    }
    let area = plane(LAYER_FLOW, at);
    var size = vec2<f32>(0.0);
    if (is_land && area >= stream(base)) {
        size = vec2<f32>(width_of(base, area), depth_of(base, area));
    }
    set_plane(LAYER_WIDTH, at, size.x);
    set_plane(LAYER_DEPTH, at, size.y);
}
