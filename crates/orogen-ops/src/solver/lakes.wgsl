// Lakes, after `routing.wgsl` and `numbering.wgsl`.
const SOURCE = 0u;
const BED = 1u;
const DEPTH = 2u;
const SURFACE = 3u;
const LAKE_NUMBER = 4u;
// By basin: its lake, identified by the number of one of the lake's basins.
const LAKE = 13u;
// By lake: the number of cells, the height of the deepest cell as an ordered integer, the first cell in row order, the
// deepest cell, and the dry cell over which it spills.
const COUNT = 14u;
const LOWEST_HEIGHT = 15u;
const FIRST = 16u;
const DEEPEST = 17u;
const OUTFLOW = 18u;
const MARK = 19u;
const NUMBER = 20u;
// The downstream cell of each cell. From the plane `SURFACES` on, there are two sets of three planes with the numbers
// of a function of the surface at that cell.
const DOWNSTREAM = 21u;
// Cells are not displaced, so there is no plane of points.
const POINT = SOURCE;
// A height above all ground.
const ABOVE_ALL = 3e38;

// Adjacent basins belong to one lake if the pass between them is under water.
fn begin_lakes(base: u32, at: vec2<i32>) {
    let cell = cell_at(at);
    set_word(COUNT, cell, 0u);
    set_word(LOWEST_HEIGHT, cell, NONE);
    set_word(FIRST, cell, NONE);
    set_word(DEEPEST, cell, NONE);
    set_word(LAKE, cell, cell);
    let edge = word(WAY_OUT, cell);
    if (word(LABEL, cell) != cell || edge == NONE) {
        return;
    }
    let ends = edge_ends(edge);
    if (pass_key(ends.x, ends.y) < spill_level(cell, step_number())) {
        let first = word(LABEL, ends.x);
        set_word(LAKE, cell, select(first, word(LABEL, ends.y), first == cell));
    }
}

// Finds the basin that identifies the lake of each basin.
fn find_lake(base: u32, at: vec2<i32>) {
    let cell = cell_at(at);
    var lake = word(LAKE, cell);
    for (var k = 0; k < HOPS; k += 1) {
        let next = word(LAKE, lake);
        if (next == lake) {
            break;
        }
        lake = next;
    }
    set_word(LAKE, cell, lake);
}

// The body of water over a cell, of any size; NONE on land. The number of the step is the number of the last pass that
// raised spill levels.
fn water_over(cell: u32) -> u32 {
    if (ordered(word(SOURCE, cell)) < spill_level(cell, step_number())) {
        return word(LAKE, word(LABEL, cell));
    }
    return NONE;
}

// The lake over a cell; NONE on land, and in depressions too small for a lake.
fn lake_over(base: u32, cell: u32) -> u32 {
    let lake = water_over(cell);
    if (lake == NONE) {
        return NONE;
    }
    return select(NONE, lake, word(COUNT, lake) >= smallest(base));
}

fn count_cells(base: u32, at: vec2<i32>) {
    let cell = cell_at(at);
    let lake = water_over(cell);
    if (lake != NONE) {
        add_word(COUNT, lake, 1u);
        lower_word(LOWEST_HEIGHT, lake, ordered(word(SOURCE, cell)));
        lower_word(FIRST, lake, cell);
    }
}

fn find_deepest(base: u32, at: vec2<i32>) {
    let cell = cell_at(at);
    let lake = lake_over(base, cell);
    set_word(MARK, cell, 0u);
    if (lake != NONE && word(LOWEST_HEIGHT, lake) == ordered(word(SOURCE, cell))) {
        lower_word(DEEPEST, lake, cell);
    }
}

// Follows the water from the deepest cell of a lake to the first dry cell.
fn find_outflow(base: u32, at: vec2<i32>) {
    let lake = cell_at(at);
    if (word(LAKE, lake) != lake || word(DEEPEST, lake) == NONE) {
        return;
    }
    set_word(MARK, word(FIRST, lake), 1u);
    var cell = word(DEEPEST, lake);
    for (var k = 0u; k < cells() && water_over(cell) == lake; k += 1u) {
        let receiver = word(RECEIVER, cell);
        if (receiver == NONE) {
            break;
        }
        cell = receiver;
    }
    set_word(OUTFLOW, lake, cell);
}

// The surface at a cell is a function of the surface downstream with three numbers: the second number if the surface
// downstream is below the first, otherwise the surface downstream plus the third. Compositions of such functions have
// the same form.
fn begin_surface(base: u32, at: vec2<i32>) {
    let cell = cell_at(at);
    let bits = word(SOURCE, cell);
    let height = bitcast<f32>(bits);
    let lake = lake_over(base, cell);
    var downstream = word(RECEIVER, cell);
    var below = height;
    var least = height;
    var rise = 0.0;
    if (downstream == NONE) {
        below = ABOVE_ALL;
        if (is_missing_word(bits)) {
            least = -ABOVE_ALL;
        }
    } else if (lake != NONE) {
        downstream = word(OUTFLOW, lake);
        below = bitcast<f32>(height_bits(spill_level(cell, step_number())));
        least = below;
    } else {
        let code = code_between(cell, downstream);
        // The rise may be less than the precision of the height, but the cell must drain.
        let up = abs(bitcast<f32>(height_bits(ordered(bits) + 1u)) - height);
        rise = max(rise_of_cell(base) * select(1.0, 1.41421356, (code & 1u) == 1u), up);
    }
    set_word(DOWNSTREAM, cell, downstream);
    set_sample(SURFACES, cell, below);
    set_sample(SURFACES + 1u, cell, least);
    set_sample(SURFACES + 2u, cell, rise);
}

// Composes the functions from each cell downstream. The number of the step alternates between 0 and 1.
fn compose_surface(base: u32, at: vec2<i32>) {
    let cell = cell_at(at);
    let turn = step_number();
    let read = SURFACES + 3u * turn;
    var downstream = word(DOWNSTREAM + turn, cell);
    var below = sample(read, cell);
    var least = sample(read + 1u, cell);
    var rise = sample(read + 2u, cell);
    for (var k = 0; k < HOPS && downstream != NONE; k += 1) {
        let their_least = sample(read + 1u, downstream);
        let their_rise = sample(read + 2u, downstream);
        if (their_least >= below) {
            least = their_least + rise;
        }
        below = max(sample(read, downstream), below - their_rise);
        rise += their_rise;
        downstream = word(DOWNSTREAM + turn, downstream);
    }
    let written = SURFACES + 3u - 3u * turn;
    set_word(DOWNSTREAM + 1u - turn, cell, downstream);
    set_sample(written, cell, below);
    set_sample(written + 1u, cell, least);
    set_sample(written + 2u, cell, rise);
}

// Writes the layers. The other plane of the step has the surface.
fn finish(base: u32, at: vec2<i32>) {
    let cell = cell_at(at);
    let height = word(SOURCE, cell);
    let lake = lake_over(base, cell);
    let is_outlet = word(RECEIVER, cell) == NONE;
    let surface = select(word(other_plane(), cell), height, is_outlet);
    let bed = select(surface, height, lake != NONE);
    var lake_number = 0u;
    if (lake != NONE) {
        lake_number = word(NUMBER, word(FIRST, lake));
    }
    set_word(BED, cell, bed);
    set_word(SURFACE, cell, surface);
    let depth = bitcast<u32>(bitcast<f32>(surface) - bitcast<f32>(bed));
    set_word(DEPTH, cell, select(depth, 0x7fc00000u, is_missing_word(height)));
    set_sample(LAKE_NUMBER, cell, f32(lake_number));
}
