// Drainage: receivers by steepest descent, the spills of basins, paths out of depressions, and drainage areas. After
// orogen-grid's `hydrology`.
//
// Cells are numbered in row order. `routing.rs` declares before this text: `ROUTING`, the first of the planes below;
// `COUNTERS`, the plane of the counters; other constants; and functions that read the words. The lower eight bits of
// `frame.step` are the plane of heights, the next eight bits another plane, and the next 15 bits a number.
const OUTLET = ROUTING;
const RECEIVER = ROUTING + 1u;
const LABEL = ROUTING + 2u;
const COMPONENT = ROUTING + 3u;
const NEXT = ROUTING + 4u;
const LOWEST = ROUTING + 5u;
const EDGE = ROUTING + 6u;
const WAY_OUT = ROUTING + 7u;
// These share planes with the ones above, before basins are found and after the water has been routed out.
const TOWARD = ROUTING + 5u;
const AWAY = ROUTING + 6u;
const ANCESTOR = ROUTING + 3u;
const AREA = ROUTING + 5u;
const SPILL_NEXT = ROUTING + 3u;
const SPILL_LEVEL = ROUTING + 5u;

// No cell; as a label, all cells that drain to an outlet.
const NONE = 0xffffffffu;
// Counters of passes that had work: rounds over basins, steps of the accumulation, steps of the solver, and steps over
// flats.
const ROUNDS = 0u;
const GATHERED = 1u;
const CHANGED = 2u;
const SPREAD = 3u;

fn heights_plane() -> u32 { return frame.step & 0xffu; }
fn other_plane() -> u32 { return (frame.step >> 8u) & 0xffu; }
fn step_number() -> u32 { return (frame.step >> 16u) & 0x7fffu; }
fn is_last() -> bool { return (frame.step & LAST) != 0u; }

fn is_scattered(base: u32) -> bool { return descent(base) == SCATTERED; }
fn is_between_points(base: u32) -> bool { return descent(base) == BETWEEN_POINTS; }

fn counter(k: u32) -> u32 { return word(COUNTERS, k); }
fn raise_counter(k: u32, value: u32) { raise_word(COUNTERS, k, value); }

// The offset of a direction, clockwise from the east.
fn offset_of(code: u32) -> vec2<i32> {
    let east = select(select(0, -1, code >= 3u && code <= 5u), 1, code == 0u || code == 1u || code == 7u);
    let south = select(select(0, -1, code >= 5u), 1, code >= 1u && code <= 3u);
    return vec2<i32>(east, south);
}

// The neighbor in a direction of a cell that is not on the border.
fn neighbor(cell: u32, code: u32) -> u32 {
    let offset = offset_of(code);
    return cell + u32(offset.y) * frame.columns + u32(offset.x);
}

// The direction from a cell to a neighbor.
fn code_between(cell: u32, to: u32) -> u32 {
    for (var code = 0u; code < 8u; code += 1u) {
        if (neighbor(cell, code) == to) {
            return code;
        }
    }
    return 8u;
}

// An integer in the order of the heights; 0 and -0 are equal.
fn ordered(bits: u32) -> u32 {
    if (bits == 0x80000000u) {
        return 0x80000000u;
    }
    return select(~bits, bits | 0x80000000u, (bits >> 31u) == 0u);
}

// The bits of a height, from its ordered integer.
fn height_bits(key: u32) -> u32 {
    return select(~key, key & 0x7fffffffu, (key >> 31u) == 1u);
}

// The upper word of a product.
fn upper_product(a: u32, b: u32) -> u32 {
    let low = (a & 0xffffu) * (b & 0xffffu);
    let first = (a >> 16u) * (b & 0xffffu) + (low >> 16u);
    let second = (a & 0xffffu) * (b >> 16u) + (first & 0xffffu);
    return (a >> 16u) * (b >> 16u) + (first >> 16u) + (second >> 16u);
}

// The product of two numbers of 64 bits, lower word first.
fn product(a: vec2<u32>, b: vec2<u32>) -> vec2<u32> {
    return vec2<u32>(a.x * b.x, upper_product(a.x, b.x) + a.x * b.y + a.y * b.x);
}

// A number of 64 bits shifted right by less than 32 bits.
fn shifted(a: vec2<u32>, by: u32) -> vec2<u32> {
    return vec2<u32>((a.x >> by) | (a.y << (32u - by)), a.y >> by);
}

// A hash of a cell's position on the lattice of the world and a salt, as in `hydrology/direction.rs`.
fn hashed(base: u32, cell: u32, with_salt: u32) -> u32 {
    let at = vec2<u32>(cell % frame.columns, cell / frame.columns);
    let column = first_column();
    let row = first_row();
    let low = vec2<u32>(column.x, row.x) + at;
    let carry = select(vec2<u32>(0u), vec2<u32>(1u), low < at);
    let high = vec2<u32>(column.y, row.y) + carry;
    var z = product(vec2<u32>(low.x, high.x), vec2<u32>(0x7f4a7c15u, 0x9e3779b9u))
        ^ product(vec2<u32>(low.y, high.y ^ with_salt), vec2<u32>(0xd192ed03u, 0xd1b54a32u));
    z = product(z ^ shifted(z, 30u), vec2<u32>(0x1ce4e5b9u, 0xbf58476du));
    z = product(z ^ shifted(z, 27u), vec2<u32>(0x133111ebu, 0x94d049bbu));
    return z.y;
}

// The displacement of a cell's point, in cells.
fn point_of(base: u32, hash: u32) -> vec2<f32> {
    let bits = vec2<f32>(f32(hash & 0xffffu), f32(hash >> 16u));
    return (bits * (2.0 / 65535.0) - vec2<f32>(1.0)) * reach(base);
}

// The vector between the points of a cell and its neighbor in a direction, in cells.
fn between_points(base: u32, cell: u32, code: u32) -> vec2<f32> {
    let there = point_of(base, word(POINT, neighbor(cell, code)));
    return vec2<f32>(offset_of(code)) + there - point_of(base, word(POINT, cell));
}

// Marks outlets: the border, the sea, cells whose height is not finite, and their neighbors.
fn outlets(base: u32, at: vec2<i32>) {
    let here = word(heights_plane(), cell_at(at));
    var is_outlet = any(at == vec2<i32>(0)) || any(at == size() - vec2<i32>(1)) || bitcast<f32>(here) <= sea_level(base);
    for (var y = -1; y <= 1; y += 1) {
        for (var x = -1; x <= 1; x += 1) {
            let there = clamp(at + vec2<i32>(x, y), vec2<i32>(0), size() - vec2<i32>(1));
            if (is_missing_word(word(heights_plane(), cell_at(there)))) {
                is_outlet = true;
            }
        }
    }
    set_word(OUTLET, cell_at(at), select(0u, 1u, is_outlet));
}

// The direction of steepest descent; 8 without a lower neighbor.
fn steepest(base: u32, cell: u32) -> u32 {
    let h = sample(heights_plane(), cell);
    let on_lattice = is_last() || !is_between_points(base);
    var diagonal = 0.70710678;
    if (on_lattice && !is_last() && is_scattered(base)) {
        let share = f32(hashed(base, cell, salt(base) + step_number()) >> 8u) * (1.0 / 16777216.0);
        diagonal = 1.0 / (2.0 - share);
    }
    var most = 1.1754944e-38;
    var found = 0u;
    for (var code = 0u; code < 8u; code += 1u) {
        let drop = h - sample(heights_plane(), neighbor(cell, code));
        var per = select(1.0, diagonal, (code & 1u) == 1u);
        if (!on_lattice) {
            let away = between_points(base, cell, code);
            per = 1.0 / sqrt(away.x * away.x + away.y * away.y);
        }
        let fall = drop * per;
        if (fall > most) {
            most = fall;
            found = 1u << code;
        } else if (fall == most) {
            found |= 1u << code;
        }
    }
    return one_of(base, cell, found);
}

// Chooses one direction of a set by a hash of the cell; 8 for an empty set.
fn one_of(base: u32, cell: u32, directions: u32) -> u32 {
    if (directions == 0u) {
        return 8u;
    }
    var rest = directions;
    let count = countOneBits(directions);
    if (count > 1u) {
        let skip = upper_product(hashed(base, cell, 0u), count);
        for (var k = 0u; k < skip; k += 1u) {
            rest &= rest - 1u;
        }
    }
    return firstTrailingBit(rest);
}

// Receivers by steepest descent. Pits, outlets and cells of flats have none.
fn receive(base: u32, at: vec2<i32>) {
    let cell = cell_at(at);
    if (cell == 0u) {
        for (var k = 0u; k < ALL_COUNTERS; k += 1u) {
            set_word(COUNTERS, k, 0u);
        }
    }
    var receiver = NONE;
    var label = NONE;
    if (word(OUTLET, cell) == 0u) {
        let code = steepest(base, cell);
        if (code < 8u) {
            receiver = neighbor(cell, code);
        }
        label = select(receiver, cell, receiver == NONE);
    }
    set_word(RECEIVER, cell, receiver);
    set_word(LABEL, cell, label);
    begin_basins(base, at);
}

// Each cell without a receiver is a basin.
fn begin_basins(base: u32, at: vec2<i32>) {
    let cell = cell_at(at);
    set_word(COMPONENT, cell, cell);
    set_word(NEXT, cell, cell);
    set_word(LOWEST, cell, NONE);
    set_word(EDGE, cell, NONE);
    set_word(WAY_OUT, cell, NONE);
}

// Flats as in `hydrology/flats.rs`: steps away from higher ground, and steps towards the lower rim. Cells of flats
// without a rim, or farther from it than the passes reach, remain separate basins. A cell of a flat has its number of
// steps away, or NONE until it is known; other cells have 0.
fn begin_flats(base: u32, at: vec2<i32>) {
    let cell = cell_at(at);
    var away = 0u;
    var toward = 0u;
    if (word(OUTLET, cell) == 0u && word(RECEIVER, cell) == NONE) {
        away = NONE;
        let height = ordered(word(heights_plane(), cell));
        for (var code = 0u; code < 8u; code += 1u) {
            let there = neighbor(cell, code);
            let height_there = ordered(word(heights_plane(), there));
            if (height_there > height) {
                away = 1u;
            } else if (height_there == height && (word(RECEIVER, there) != NONE || word(OUTLET, there) == 1u)) {
                toward = 1u;
            }
        }
        raise_counter(SPREAD, 1u);
    }
    set_word(AWAY, cell, away);
    set_word(TOWARD, cell, toward);
}

// Whether a neighbor belongs to the same flat.
fn is_level(cell: u32, there: u32) -> bool {
    return word(AWAY, there) != 0u && ordered(word(heights_plane(), there)) == ordered(word(heights_plane(), cell));
}

// Neighbors of cells with this number of steps get one more. Values that other calls write at the same time are larger,
// so they do not matter.
fn spread_flats(base: u32, at: vec2<i32>) {
    let steps = step_number();
    let cell = cell_at(at);
    if (counter(SPREAD) < steps || word(AWAY, cell) == 0u) {
        return;
    }
    var is_away = false;
    var is_toward = false;
    for (var code = 0u; code < 8u; code += 1u) {
        let there = neighbor(cell, code);
        if (is_level(cell, there)) {
            is_away = is_away || word(AWAY, there) == steps;
            is_toward = is_toward || word(TOWARD, there) == steps;
        }
    }
    if (is_away && word(AWAY, cell) == NONE) {
        set_word(AWAY, cell, steps + 1u);
        raise_counter(SPREAD, steps + 1u);
    }
    if (is_toward && word(TOWARD, cell) == 0u) {
        set_word(TOWARD, cell, steps + 1u);
        raise_counter(SPREAD, steps + 1u);
    }
}

// Twice the steps towards the rim, minus the steps away from higher ground. The number of the step is greater than all
// counted steps.
fn slope_of_flat(cell: u32) -> i32 {
    return 2 * i32(word(TOWARD, cell)) - i32(min(word(AWAY, cell), step_number()));
}

// Receivers of the cells of flats with a rim.
fn drain_flats(base: u32, at: vec2<i32>) {
    let cell = cell_at(at);
    let toward = word(TOWARD, cell);
    if (toward == 0u) {
        return;
    }
    let height = ordered(word(heights_plane(), cell));
    var directions = 0u;
    var least = slope_of_flat(cell);
    for (var code = 0u; code < 8u; code += 1u) {
        let there = neighbor(cell, code);
        if (ordered(word(heights_plane(), there)) != height) {
            continue;
        }
        if (toward == 1u) {
            // At the rim: to a cell that drains.
            if (word(AWAY, there) == 0u) {
                directions |= 1u << code;
            }
        } else if (word(AWAY, there) != 0u && word(TOWARD, there) != 0u) {
            let slope = slope_of_flat(there);
            if (slope < least) {
                least = slope;
                directions = 1u << code;
            } else if (slope == least && directions != 0u) {
                directions |= 1u << code;
            }
        }
    }
    let receiver = neighbor(cell, one_of(base, cell, directions));
    set_word(RECEIVER, cell, receiver);
    set_word(LABEL, cell, receiver);
}

// Moves the label of each cell towards its pit or outlet. Other calls may move the labels that this call reads, which
// only shortens the path.
fn find_pit(base: u32, at: vec2<i32>) {
    let cell = cell_at(at);
    var label = word(LABEL, cell);
    if (label == cell) {
        raise_counter(ROUNDS, 1u);
        return;
    }
    for (var k = 0; k < HOPS && label != NONE; k += 1) {
        let next = word(LABEL, label);
        if (next == label) {
            break;
        }
        label = next;
    }
    set_word(LABEL, cell, label);
}

// Basins that are known to spill into each other form components. The component of a cell: its root pit, or NONE
// outside.
fn component_of(cell: u32) -> u32 {
    let label = word(LABEL, cell);
    if (label == NONE) {
        return NONE;
    }
    return word(COMPONENT, label);
}

// The ends of an edge: two neighbors. Edges are numbered by their first cell and the direction of the other one, which
// is below or to the east.
fn edge_between(a: u32, b: u32) -> u32 {
    return 4u * min(a, b) + code_between(min(a, b), max(a, b));
}

fn edge_ends(edge: u32) -> vec2<u32> {
    return vec2<u32>(edge >> 2u, neighbor(edge >> 2u, edge & 3u));
}

// The height of the pass between two cells, as an ordered integer.
fn pass_key(a: u32, b: u32) -> u32 {
    return max(ordered(word(heights_plane(), a)), ordered(word(heights_plane(), b)));
}

// Finds the lowest pass out of each component.
fn offer_pass(base: u32, at: vec2<i32>) {
    if (counter(ROUNDS) < step_number()) {
        return;
    }
    let cell = cell_at(at);
    let mine = component_of(cell);
    if (mine == NONE) {
        return;
    }
    var lowest = NONE;
    for (var code = 0u; code < 8u; code += 1u) {
        let there = neighbor(cell, code);
        if (component_of(there) != mine) {
            lowest = min(lowest, pass_key(cell, there));
        }
    }
    if (lowest != NONE) {
        lower_word(LOWEST, mine, lowest);
    }
}

// Of equally low passes, the first edge.
fn choose_pass(base: u32, at: vec2<i32>) {
    if (counter(ROUNDS) < step_number()) {
        return;
    }
    let cell = cell_at(at);
    let mine = component_of(cell);
    if (mine == NONE) {
        return;
    }
    let lowest = word(LOWEST, mine);
    // A pass is at least as high as both cells.
    if (ordered(word(heights_plane(), cell)) > lowest) {
        return;
    }
    for (var code = 0u; code < 8u; code += 1u) {
        let there = neighbor(cell, code);
        if (component_of(there) != mine && pass_key(cell, there) == lowest) {
            lower_word(EDGE, mine, edge_between(cell, there));
        }
    }
}

// Joins each component to the one beyond its pass. If two components choose the same edge, the one with the smaller
// root waits.
fn join(base: u32, at: vec2<i32>) {
    let cell = cell_at(at);
    if (counter(ROUNDS) < step_number() || word(LABEL, cell) != cell || word(COMPONENT, cell) != cell) {
        return;
    }
    let edge = word(EDGE, cell);
    if (edge == NONE) {
        return;
    }
    let ends = edge_ends(edge);
    let is_first = component_of(ends.x) == cell;
    let theirs = component_of(select(ends.x, ends.y, is_first));
    if (theirs != NONE && word(EDGE, theirs) == edge && cell < theirs) {
        return;
    }
    set_word(NEXT, cell, theirs);
    // The basins from the pass to the root spilled towards the root. From now on they spill towards the pass.
    var basin = word(LABEL, select(ends.y, ends.x, is_first));
    var way = edge;
    for (var k = 0u; k < cells(); k += 1u) {
        let before = word(WAY_OUT, basin);
        set_word(WAY_OUT, basin, way);
        if (before == NONE) {
            break;
        }
        let old = edge_ends(before);
        let first = word(LABEL, old.x);
        basin = select(first, word(LABEL, old.y), first == basin);
        way = before;
    }
}

// The new root of each basin.
fn find_root(base: u32, at: vec2<i32>) {
    let cell = cell_at(at);
    if (counter(ROUNDS) < step_number() || word(LABEL, cell) != cell) {
        return;
    }
    var root = word(COMPONENT, cell);
    for (var k = 0u; k < cells() && root != NONE; k += 1u) {
        let next = word(NEXT, root);
        if (next == root) {
            break;
        }
        root = next;
    }
    set_word(COMPONENT, cell, root);
    set_word(LOWEST, cell, NONE);
    set_word(EDGE, cell, NONE);
    if (root == cell) {
        raise_counter(ROUNDS, step_number() + 1u);
    }
}

// Reverses the path from the pass to the pit, so that water flows from the pit to the pass and out.
fn lead_out(base: u32, at: vec2<i32>) {
    let pit = cell_at(at);
    let edge = word(WAY_OUT, pit);
    if (word(LABEL, pit) != pit || edge == NONE) {
        return;
    }
    let ends = edge_ends(edge);
    let is_first = word(LABEL, ends.x) == pit;
    var cell = select(ends.y, ends.x, is_first);
    var to = select(ends.x, ends.y, is_first);
    for (var k = 0u; k < cells(); k += 1u) {
        let next = word(RECEIVER, cell);
        set_word(RECEIVER, cell, to);
        if (next == NONE) {
            break;
        }
        to = cell;
        cell = next;
    }
}

// The basin that each basin spills into, and the height of the pass.
fn begin_spill(base: u32, at: vec2<i32>) {
    let pit = cell_at(at);
    let edge = word(WAY_OUT, pit);
    if (word(LABEL, pit) != pit || edge == NONE) {
        return;
    }
    let ends = edge_ends(edge);
    let first = word(LABEL, ends.x);
    set_word(SPILL_NEXT, pit, select(first, word(LABEL, ends.y), first == pit));
    set_word(SPILL_LEVEL, pit, pass_key(ends.x, ends.y));
}

// Raises the spill levels to the levels of the basins downstream. The number of the step alternates between 0 and 1.
fn raise_spill(base: u32, at: vec2<i32>) {
    let pit = cell_at(at);
    if (word(LABEL, pit) != pit) {
        return;
    }
    let turn = step_number();
    var next = word(SPILL_NEXT + turn, pit);
    var level = word(SPILL_LEVEL + turn, pit);
    for (var k = 0; k < HOPS && next != NONE; k += 1) {
        level = max(level, word(SPILL_LEVEL + turn, next));
        next = word(SPILL_NEXT + turn, next);
    }
    set_word(SPILL_NEXT + 1u - turn, pit, next);
    set_word(SPILL_LEVEL + 1u - turn, pit, level);
}

// The rain on a cell in units of 1/4096, as two parts, so that the sum of each over all cells fits into a word. A unit
// of the first part is 1024 units of the second.
fn rain_on(base: u32, cell: u32) -> vec2<u32> {
    let bits = word(rain_plane(base), cell);
    var factor = clamp(bitcast<f32>(bits), 0.01, 100.0);
    if (is_missing_word(bits)) {
        // Not a number counts as 1.
        factor = select(select(1.0, 0.01, bits == 0xff800000u), 100.0, bits == 0x7f800000u);
    }
    let weight = u32(factor * 4096.0 + 0.5);
    return vec2<u32>(weight >> 10u, weight & 1023u);
}

// Each cell drains itself.
fn begin_areas(base: u32, at: vec2<i32>) {
    let cell = cell_at(at);
    set_word(ANCESTOR, cell, word(RECEIVER, cell));
    set_word(AREA, cell, 1u);
    set_word(AREA + 1u, cell, 0u);
    let sums = rain_sums(base);
    if (sums != 0u) {
        let rain = rain_on(base, cell);
        set_word(sums, cell, rain.x);
        set_word(sums + 1u, cell, 0u);
        set_word(sums + 3u, cell, rain.y);
        set_word(sums + 4u, cell, 0u);
    }
}

// Adds the number of cells that drain through each cell within 8^k steps to the cells downstream. Afterwards the
// numbers within 8^(k + 1) steps are known.
fn gather_areas(base: u32, at: vec2<i32>) {
    if (counter(GATHERED) < step_number()) {
        return;
    }
    gather_plane(AREA, cell_at(at));
    let sums = rain_sums(base);
    if (sums != 0u) {
        gather_plane(sums, cell_at(at));
        gather_plane(sums + 3u, cell_at(at));
    }
}

// Of three planes, the first is read, the second is added to, and the third is cleared for the next pass.
fn gather_plane(first: u32, cell: u32) {
    let k = step_number();
    let sum = word(first + k % 3u, cell);
    let to = first + (k + 1u) % 3u;
    set_word(first + (k + 2u) % 3u, cell, 0u);
    add_word(to, cell, sum);
    var ancestor = word(ANCESTOR + (k & 1u), cell);
    for (var hop = 1; hop < GATHERED_HOPS && ancestor != NONE; hop += 1) {
        add_word(to, ancestor, sum);
        ancestor = word(ANCESTOR + (k & 1u), ancestor);
    }
    set_word(ANCESTOR + 1u - (k & 1u), cell, ancestor);
    if (ancestor != NONE) {
        raise_counter(GATHERED, k + 1u);
    }
}

// Number of cells that drain through a cell, once all passes have run.
fn drained_cells(cell: u32) -> u32 {
    return word(AREA + (counter(GATHERED) + 1u) % 3u, cell);
}

// The number of cells that drain through a cell, weighted by the rain.
fn discharge(base: u32, cell: u32) -> f32 {
    let sums = rain_sums(base);
    if (sums == 0u) {
        return f32(drained_cells(cell));
    }
    let turn = sums + (counter(GATHERED) + 1u) % 3u;
    return f32(word(turn, cell)) * 0.25 + f32(word(turn + 3u, cell)) * (1.0 / 4096.0);
}

// The level to which water fills the basin of a cell, as an ordered integer; 0 outside. `turn` is the number of the
// last pass that raised the levels.
fn spill_level(cell: u32, turn: u32) -> u32 {
    let label = word(LABEL, cell);
    if (label == NONE) {
        return 0u;
    }
    return word(SPILL_LEVEL + turn, label);
}

// The bits of a height raised to the spill level.
fn filled_bits(cell: u32, turn: u32) -> u32 {
    let height = word(heights_plane(), cell);
    let level = spill_level(cell, turn);
    return select(height, height_bits(level), ordered(height) < level);
}
