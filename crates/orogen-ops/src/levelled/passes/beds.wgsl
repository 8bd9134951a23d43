// Beds of rivers, cut along the links between their nodes, as in `channels.rs`. Several links may cut the same sample,
// so planes are read and written as words.

// Minimum width of rivers whose beds are cut, in cells.
const NARROW = 1.0;

struct Node {
    place: vec2<f32>,
    height: f32,
    half: f32,
    depth: f32,
}

// The node of the cell `by` cells from another.
fn node(at: vec2<i32>, by: vec2<i32>) -> Node {
    let o = at + by;
    let place = vec2<f32>(sample(NODE_EAST, cell_at(o)), sample(NODE_SOUTH, cell_at(o))) + vec2<f32>(by);
    return Node(place, sample(NODE_HEIGHT, cell_at(o)), sample(NODE_HALF, cell_at(o)), sample(NODE_DEPTH, cell_at(o)));
}

// Lowers the ground to a bed.
fn lower_ground(at: vec2<i32>, bed: f32) {
    let index = word_index(LAYER_HEIGHT, cell_at(at));
    var now = atomicLoad(&words[index]);
    while (bed < bitcast<f32>(now)) {
        let outcome = atomicCompareExchangeWeak(&words[index], now, bitcast<u32>(bed));
        if (outcome.exchanged) {
            break;
        }
        now = outcome.old_value;
    }
}

// Cuts the bed of the link from a node.
fn cut_bed(base: u32, at: vec2<i32>) {
    let area = sample(AREA, cell_at(at)) * square_metres(base);
    let receiver = sample(RECEIVER, cell_at(at));
    if (area < stream(base) || receiver >= NONE) {
        return;
    }
    let origin = node(at, vec2<i32>(0));
    let end = node(at, step_of(u32(receiver)));
    let half = max(origin.half, end.half);
    if (2.0 * half <= NARROW) {
        return;
    }
    let left_top = vec2<i32>(floor(min(origin.place, end.place) - half));
    let right_bottom = vec2<i32>(ceil(max(origin.place, end.place) + half));
    let first = window_first();
    let last = first + window_size() - vec2<i32>(1);
    let along = end.place - origin.place;
    let square = max(dot(along, along), 1e-6);
    let from_cell = max(at + left_top, first);
    let to_cell = min(at + right_bottom, last);
    for (var y = from_cell.y; y <= to_cell.y; y += 1) {
        for (var x = from_cell.x; x <= to_cell.x; x += 1) {
            let o = vec2<i32>(x, y);
            let there = vec2<f32>(o - at) - origin.place;
            let share = clamp(dot(there, along) / square, 0.0, 1.0);
            let beside = there - share * along;
            let wide = mix(origin.half, end.half, share);
            let across = dot(beside, beside) / (wide * wide);
            if (across < 1.0 && is_missing_word(word(WATER_LEVEL, cell_at(o)))) {
                let profile = 1.0 - across * across;
                let bed = origin.height + share * (end.height - origin.height) - (origin.depth + share * (end.depth - origin.depth)) * profile;
                lower_ground(o, bed);
            }
        }
    }
}
