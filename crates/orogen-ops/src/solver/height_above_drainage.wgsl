// Height above nearest drainage, after `routing.wgsl`.
const SOURCE = 0u;
const HEIGHT = 1u;
const FLOW_DISTANCE = 2u;
const DISTANCE = 3u;
const FILLED = 12u;
// The cell up to which the path of each cell is known, and the length of that path in metres; two planes each.
const END = 13u;
const LENGTH = 15u;
// Distance to the nearest stream in the same column, in cells.
const DOWN_COLUMN = 17u;
// Cells are not displaced, so there is no plane of points.
const POINT = SOURCE;

const FAR = 0x7fffffffu;

fn fill(base: u32, at: vec2<i32>) {
    set_word(FILLED, cell_at(at), filled_bits(cell_at(at), step_number()));
}

fn is_stream(base: u32, cell: u32) -> bool {
    return drained_cells(cell) >= stream(base);
}

// Paths end at streams and outlets.
fn begin_paths(base: u32, at: vec2<i32>) {
    let cell = cell_at(at);
    let receiver = word(RECEIVER, cell);
    if (receiver == NONE || is_stream(base, cell)) {
        set_word(END, cell, cell);
        set_sample(LENGTH, cell, 0.0);
        return;
    }
    let is_diagonal = (code_between(cell, receiver) & 1u) == 1u;
    set_word(END, cell, receiver);
    set_sample(LENGTH, cell, cell_length(base) * select(1.0, 1.41421356, is_diagonal));
}

// Follows the paths downstream. The number of the step alternates between 0 and 1.
fn follow_paths(base: u32, at: vec2<i32>) {
    let cell = cell_at(at);
    let turn = step_number();
    var end = word(END + turn, cell);
    var length = sample(LENGTH + turn, cell);
    for (var k = 0; k < HOPS; k += 1) {
        let next = word(END + turn, end);
        if (next == end) {
            break;
        }
        length += sample(LENGTH + turn, end);
        end = next;
    }
    set_word(END + 1u - turn, cell, end);
    set_sample(LENGTH + 1u - turn, cell, length);
}

// Distances to streams along each column, in a pass down and a pass up.
fn scan_columns(base: u32, at: vec2<i32>) {
    if (at.y != 0) {
        return;
    }
    var distance = FAR;
    for (var y = 0; y < size().y; y += 1) {
        let cell = cell_at(vec2<i32>(at.x, y));
        distance = select(min(distance + 1u, FAR), 0u, is_stream(base, cell));
        set_word(DOWN_COLUMN, cell, distance);
    }
    for (var y = size().y - 1; y >= 0; y -= 1) {
        let cell = cell_at(vec2<i32>(at.x, y));
        distance = min(min(distance + 1u, FAR), word(DOWN_COLUMN, cell));
        set_word(DOWN_COLUMN, cell, distance);
    }
}

// The square of the distance in cells, from the number of columns across and the distance in that column.
fn square_of(across: u32, down: u32) -> u32 {
    return select(across * across + down * down, NONE, down == FAR);
}

// Writes the layers. The number of the step is the number of the last pass that followed paths.
fn finish(base: u32, at: vec2<i32>) {
    let cell = cell_at(at);
    let end = word(END + step_number(), cell);
    let filled = word(FILLED, cell);
    let height = bitcast<u32>(bitcast<f32>(filled) - sample(FILLED, end));
    set_word(HEIGHT, cell, select(height, 0x7fc00000u, is_missing_word(filled)));
    set_word(FLOW_DISTANCE, cell, word(LENGTH + step_number(), cell));
    var nearest = square_of(0u, word(DOWN_COLUMN, cell));
    for (var x = 1u; x < frame.columns && x * x < nearest; x += 1u) {
        if (u32(at.x) >= x) {
            nearest = min(nearest, square_of(x, word(DOWN_COLUMN, cell - x)));
        }
        if (u32(at.x) + x < frame.columns) {
            nearest = min(nearest, square_of(x, word(DOWN_COLUMN, cell + x)));
        }
    }
    let diagonal = length(vec2<f32>(size()));
    set_sample(DISTANCE, cell, min(sqrt(f32(nearest)), diagonal) * cell_length(base));
}
