// Drainage, after `routing.wgsl` and `numbering.wgsl`.
const SOURCE = 0u;
const FLOW = 2u;
const DIRECTION = 3u;
const WATERSHED = 4u;
const STRAHLER = 5u;
const ORDER = 15u;
const MARK = 16u;
const NUMBER = 17u;
// Cells are not displaced, so there is no plane of points.
const POINT = SOURCE;

// The layer of the filled heights.
fn fill(base: u32, at: vec2<i32>) {
    set_word(FILLED, cell_at(at), filled_bits(cell_at(at), step_number()));
}

// Starts labels that lead to outlets, and marks the outlets that drain other cells.
fn begin_watersheds(base: u32, at: vec2<i32>) {
    let cell = cell_at(at);
    let receiver = word(RECEIVER, cell);
    let area = drained_cells(cell);
    set_word(LABEL, cell, select(receiver, cell, receiver == NONE));
    set_word(MARK, cell, select(0u, 1u, receiver == NONE && area > 1u));
    let is_stream = select(area >= stream(base), discharge(base, cell) >= f32(stream(base)), rain_sums(base) != 0u);
    set_word(ORDER, cell, select(0u, 1u, is_stream));
}

// Finds streams of at least the order of the step: those downstream of a confluence of two streams of the previous
// order. Streams of the previous order keep it, whatever other calls write.
fn raise_order(base: u32, at: vec2<i32>) {
    let order = step_number();
    if (order > 2u && counter(CHANGED) < order - 1u) {
        return;
    }
    let cell = cell_at(at);
    if (word(ORDER, cell) + 1u < order) {
        return;
    }
    var inflows = 0;
    for (var y = max(at.y - 1, 0); y <= min(at.y + 1, size().y - 1); y += 1) {
        for (var x = max(at.x - 1, 0); x <= min(at.x + 1, size().x - 1); x += 1) {
            let there = cell_at(vec2<i32>(x, y));
            if (word(RECEIVER, there) == cell && word(ORDER, there) + 1u >= order) {
                inflows += 1;
            }
        }
    }
    if (inflows < 2) {
        return;
    }
    raise_counter(CHANGED, order);
    var downstream = cell;
    for (var k = 0u; k < cells() && downstream != NONE; k += 1u) {
        if (word(ORDER, downstream) >= order) {
            break;
        }
        raise_word(ORDER, downstream, order);
        downstream = word(RECEIVER, downstream);
    }
}

// The layers.
fn finish(base: u32, at: vec2<i32>) {
    let cell = cell_at(at);
    let receiver = word(RECEIVER, cell);
    var code = 8u;
    if (receiver != NONE) {
        code = code_between(cell, receiver);
    }
    let outlet = word(LABEL, cell);
    set_sample(FLOW, cell, discharge(base, cell) * cell_area(base));
    set_sample(DIRECTION, cell, f32(code));
    set_sample(WATERSHED, cell, select(0.0, f32(word(NUMBER, outlet)), word(MARK, outlet) == 1u));
    set_sample(STRAHLER, cell, f32(word(ORDER, cell)));
}
