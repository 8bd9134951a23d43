// Rivers at nodes of detail levels, as in `channels.rs`.
const WIDEST = 20.0;
const SMOOTHED = 3.0;
const MIN_SMOOTHED = 8.0;
const MAX_SMOOTHED = 24.0;
const NARROW = vec2<f32>(1.0, 2.0);

// The direction to the donor with the largest area, the first one of equal areas; NONE at sources.
fn main_donor(at: vec2<i32>) -> u32 {
    var best = 8u;
    var most = 0.0;
    for (var code = 0u; code < 8u; code += 1u) {
        let donor = at + step_of(code);
        let area = plane(AREA, donor);
        if (plane(RECEIVER, donor) == f32((code + 4u) & 7u) && area > most) {
            best = code;
            most = area;
        }
    }
    return best;
}

// The direction downstream, or to the main donor; 8 if there is none.
fn towards(at: vec2<i32>, is_upstream: bool) -> u32 {
    if (is_upstream) {
        return main_donor(at);
    }
    return u32(min(plane(RECEIVER, at), NONE));
}

fn is_river(base: u32, at: vec2<i32>) -> bool {
    return plane(AREA, at) * square_metres(base) >= stream(base);
}

// Whether a bed ends or begins at a node.
fn has_bed(base: u32, at: vec2<i32>) -> bool {
    if (is_river(base, at)) {
        return true;
    }
    for (var code = 0u; code < 8u; code += 1u) {
        let donor = at + step_of(code);
        if (plane(RECEIVER, donor) == f32((code + 4u) & 7u) && is_river(base, donor)) {
            return true;
        }
    }
    return false;
}

// The river at a node: the average over links up and down the river.
fn find_river(base: u32, at: vec2<i32>) {
    set_plane(NODE_HALF, at, 0.0);
    if (!has_bed(base, at)) {
        return;
    }
    let area = plane(AREA, at) * square_metres(base);
    let width = width_of(base, area) / cell(base);
    let reach = i32(clamp(SMOOTHED * 0.5 * width, MIN_SMOOTHED, MAX_SMOOTHED));
    var weight = f32(reach + 1);
    var sums = weight * vec3<f32>(plane(EAST, at), plane(SOUTH, at), plane(HEIGHT, at));
    for (var way = 0; way < 2; way += 1) {
        var place = at;
        for (var link = 0; link < reach; link += 1) {
            let code = towards(place, way == 1);
            if (code >= 8u) {
                break;
            }
            place += step_of(code);
            let by = vec2<f32>(place - at);
            let share = f32(reach - link);
            sums += share * vec3<f32>(plane(EAST, place) + by.x, plane(SOUTH, place) + by.y, plane(HEIGHT, place));
            weight += share;
        }
    }
    let share = clamp((width - NARROW.x) / (NARROW.y - NARROW.x), 0.0, 1.0);
    let node = sums / weight;
    set_plane(NODE_EAST, at, node.x);
    set_plane(NODE_SOUTH, at, node.y);
    set_plane(NODE_HEIGHT, at, node.z);
    set_plane(NODE_HALF, at, min(0.5 * width, WIDEST));
    set_plane(NODE_DEPTH, at, select(0.0, depth_of(base, area) * share, plane(RECEIVER, at) < NONE));
}
