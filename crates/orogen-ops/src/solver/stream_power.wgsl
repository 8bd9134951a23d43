// Stream power: the steps of orogen-grid's `hydrology/stream_power.rs`, `erosion.rs`, `creep.rs` and `points.rs`, after
// `routing.wgsl`.
//
// The heights use three planes in turn. The planes of layers have other data until the last pass.
const ERODIBILITY = 1u;
const UPLIFT = 2u;
const FLOW = 6u;
const CHANGE = 7u;
const SEDIMENT = 8u;
const POINT = 17u;
// The piece of the law that applies to each cell.
const PIECE = CHANGE;
// The factor and the offset of a piece; two sets of planes.
const AFFINE = 20u;

const FREE = 1u;
const LIMITED = 2u;
const RAISED = 3u;

// The law's numbers for a cell.
struct Law {
    // The minimum and maximum height above the receiver.
    least: f32,
    most: f32,
    // Uplift of the step, in metres.
    risen: f32,
    // Coefficient of the equation for the drop x to the receiver that remains of a drop: x + cut x^n = drop.
    cut: f32,
}

// Draws the points of the cells.
fn draw_points(base: u32, at: vec2<i32>) {
    set_word(POINT, cell_at(at), hashed(base, cell_at(at), salt(base)));
}

// The inverse distance from a cell to its receiver, in cells.
fn inverse_distance(base: u32, cell: u32, receiver: u32) -> f32 {
    let code = code_between(cell, receiver);
    if (is_last() || !is_between_points(base)) {
        return select(1.0, 0.70710678, (code & 1u) == 1u);
    }
    let away = between_points(base, cell, code);
    return 1.0 / sqrt(away.x * away.x + away.y * away.y);
}

fn law_of(base: u32, cell: u32, receiver: u32) -> Law {
    let near = inverse_distance(base, cell, receiver);
    let most = select(max_drop(base), last_max_drop(base), is_last());
    var law = Law(min_drop(base) / near, most / near, 0.0, 0.0);
    if (is_last()) {
        return law;
    }
    law.risen = raised(base);
    if (has_uplift(base) == 1u) {
        law.risen *= sample(UPLIFT, cell);
        if (is_missing_word(word(UPLIFT, cell))) {
            law.risen = 1e30;
        }
    }
    let n = slope_exponent(base);
    let per_distance = select(power(near, n), near, n == 1.0);
    law.cut = cut_of_cell(base) * per_distance * power(discharge(base, cell), area_exponent(base));
    if (has_erodibility(base) == 1u) {
        let factor = word(ERODIBILITY, cell);
        law.cut *= max(select(bitcast<f32>(factor), 0.0, is_missing_word(factor)), 0.0);
    }
    law.cut = min(law.cut, 1e30);
    return law;
}

// The remaining drop without limits, and its derivative by the drop. Newton's method starts above the root of a convex
// form, in units of the drop: of s + c s^n = 1 for n > 1, and of t^(1/n) + c t = 1 with t = s^n for n < 1.
fn left_of(base: u32, law: Law, drop: f32) -> vec2<f32> {
    let n = slope_exponent(base);
    if (n == 1.0) {
        return vec2<f32>(drop, 1.0) / (1.0 + law.cut);
    }
    if (drop <= 0.0) {
        return vec2<f32>(drop, 1.0);
    }
    let c = clamp(law.cut * power(max(drop, 1e-30), n - 1.0), 1e-30, 1e30);
    let exponent = max(n, 1.0 / n);
    let linear = select(c, 1.0, n > 1.0);
    let bent = select(1.0, c, n > 1.0);
    var root = min(1.0, select(1.0 / c, power(c, -1.0 / n), n > 1.0));
    for (var k = 0; k < 12; k += 1) {
        let bend = bent * power(max(root, 1e-30), exponent - 1.0);
        root -= (linear * root + bend * root - 1.0) / (linear + exponent * bend);
        root = clamp(root, 0.0, 1.0);
    }
    let s = select(power(max(root, 1e-30), 1.0 / n), root, n > 1.0);
    return vec2<f32>(drop * s, 1.0 / (1.0 + n * c * power(max(s, 1e-30), n - 1.0)));
}

// Lower bounds of the changes of cells, for the first choice of pieces. A cell's change is at least max(a, b + x) for
// the receiver's change x: a is its change if the receiver does not change, and b + x keeps it above its raised
// receiver. Compositions of such functions have the same form. Without these bounds, filling a valley would take one
// choice of pieces per cell of its length.
fn begin_raise(base: u32, at: vec2<i32>) {
    let cell = cell_at(at);
    let receiver = word(RECEIVER, cell);
    set_word(ANCESTOR, cell, receiver);
    if (receiver == NONE) {
        set_sample(AFFINE, cell, 0.0);
        set_sample(AFFINE + 1u, cell, -1e30);
        return;
    }
    let law = law_of(base, cell, receiver);
    let drop = sample(heights_plane(), cell) - sample(heights_plane(), receiver);
    let left = left_of(base, law, drop + law.risen).x;
    set_sample(AFFINE, cell, max(min(left, law.most), law.least) - drop);
    set_sample(AFFINE + 1u, cell, law.least - drop);
}

// Composes the bounds from each cell downstream. The other plane of the step alternates between 0 and 1.
fn compose_raise(base: u32, at: vec2<i32>) {
    let cell = cell_at(at);
    let turn = other_plane();
    var ancestor = word(ANCESTOR + turn, cell);
    var least = sample(AFFINE + 2u * turn, cell);
    var above = sample(AFFINE + 2u * turn + 1u, cell);
    for (var k = 0; k < HOPS && ancestor != NONE; k += 1) {
        least = max(least, above + sample(AFFINE + 2u * turn, ancestor));
        above += sample(AFFINE + 2u * turn + 1u, ancestor);
        ancestor = word(ANCESTOR + turn, ancestor);
    }
    set_word(ANCESTOR + 1u - turn, cell, ancestor);
    set_sample(AFFINE + 2u - 2u * turn, cell, least);
    set_sample(AFFINE + 3u - 2u * turn, cell, max(above, -1e30));
}

// Takes the bounds as the changes so far.
fn end_raise(base: u32, at: vec2<i32>) {
    let cell = cell_at(at);
    set_sample(AFFINE + 3u, cell, sample(AFFINE + 2u, cell));
}

// The change of a cell's height is a function of its receiver's change with three pieces. Two pieces are affine, and so
// is the third one if the slope exponent is 1; otherwise its tangent is used. Chooses the piece from the changes that
// were computed with the previous choice. The first choice uses the pieces of the previous time step if the other plane
// of the step is 1, otherwise the lower bounds.
fn choose_piece(base: u32, at: vec2<i32>) {
    let iteration = step_number();
    if (counter(CHANGED) < iteration) {
        return;
    }
    let cell = cell_at(at);
    let receiver = word(RECEIVER, cell);
    set_word(ANCESTOR, cell, receiver);
    if (receiver == NONE) {
        set_sample(AFFINE, cell, 0.0);
        set_sample(AFFINE + 1u, cell, 0.0);
        return;
    }
    let law = law_of(base, cell, receiver);
    let drop = sample(heights_plane(), cell) - sample(heights_plane(), receiver);
    var below = 0.0;
    if (iteration > 0u || other_plane() == 0u) {
        below = sample(AFFINE + 3u, receiver);
    }
    let left = left_of(base, law, drop + law.risen - below);
    let before = word(PIECE, cell);
    var piece = FREE;
    if (left.x >= law.most) {
        piece = LIMITED;
    }
    if (left.x <= law.least || law.most <= law.least) {
        piece = RAISED;
    }
    if (iteration == 0u && other_plane() == 1u && before != 0u) {
        piece = before;
    }
    var is_changed = iteration == 0u || before != piece;
    var factor = 1.0;
    var offset = select(law.least, law.most, piece == LIMITED) - drop;
    if (piece == FREE && slope_exponent(base) == 1.0) {
        factor = law.cut * left.y;
        offset = law.risen * left.y - drop * factor;
    } else if (piece == FREE) {
        factor = 1.0 - left.y;
        offset = left.x - drop + below * left.y;
        if (iteration > 0u) {
            let tangent = sample(AFFINE + 3u, cell);
            is_changed = is_changed || abs(below + left.x - drop - tangent) > 1e-4 * (1.0 + abs(tangent));
        }
    }
    if (is_changed) {
        raise_counter(CHANGED, iteration + 1u);
    }
    set_word(PIECE, cell, piece);
    set_sample(AFFINE, cell, factor);
    set_sample(AFFINE + 1u, cell, offset);
}

// Composes the pieces from each cell downstream. The other plane of the step alternates between 0 and 1.
fn compose_pieces(base: u32, at: vec2<i32>) {
    if (counter(CHANGED) <= step_number()) {
        return;
    }
    let cell = cell_at(at);
    let turn = other_plane();
    var ancestor = word(ANCESTOR + turn, cell);
    var factor = sample(AFFINE + 2u * turn, cell);
    var offset = sample(AFFINE + 2u * turn + 1u, cell);
    for (var k = 0; k < HOPS && ancestor != NONE; k += 1) {
        offset += factor * sample(AFFINE + 2u * turn + 1u, ancestor);
        factor *= sample(AFFINE + 2u * turn, ancestor);
        ancestor = word(ANCESTOR + turn, ancestor);
    }
    set_word(ANCESTOR + 1u - turn, cell, ancestor);
    set_sample(AFFINE + 2u - 2u * turn, cell, factor);
    set_sample(AFFINE + 3u - 2u * turn, cell, offset);
}

// The heights after the step.
fn set_heights(base: u32, at: vec2<i32>) {
    let cell = cell_at(at);
    let receiver = word(RECEIVER, cell);
    let before = word(heights_plane(), cell);
    if (receiver == NONE) {
        set_word(other_plane(), cell, before);
        return;
    }
    let law = law_of(base, cell, receiver);
    let height_below = sample(heights_plane(), receiver);
    let change_below = sample(AFFINE + 3u, receiver);
    let above = (bitcast<f32>(before) - height_below) + law.risen - change_below;
    let below = height_below + change_below;
    let height = below + max(min(left_of(base, law, above).x, law.most), law.least);
    // The minimum slope may be lost by rounding, but the cell must drain.
    let least = height_bits(ordered(bitcast<u32>(below)) + 1u);
    set_word(other_plane(), cell, select(least, bitcast<u32>(height), height > below));
}

// A stage of soil creep. The third plane has the heights of the stage before the previous one.
fn creep(base: u32, at: vec2<i32>) {
    let cell = cell_at(at);
    let here = word(heights_plane(), cell);
    if (word(OUTLET, cell) == 1u) {
        set_word(other_plane(), cell, here);
        return;
    }
    let h = bitcast<f32>(here);
    var sides = 0.0;
    var corners = 0.0;
    for (var code = 0u; code < 8u; code += 2u) {
        sides += sample(heights_plane(), neighbor(cell, code)) - h;
        corners += sample(heights_plane(), neighbor(cell, code + 1u)) - h;
    }
    let stage = f32(step_number());
    let last = HEIGHT + 2u * SPARE + 1u - heights_plane() - other_plane();
    var again = 0.0;
    if (step_number() > 1u) {
        again = (stage - 1.0) / stage * (h - sample(last, cell));
    }
    let inflow = (2.0 * stage - 1.0) / stage * creep_share(base) * (4.0 * sides + corners);
    set_sample(other_plane(), cell, h + again + inflow);
}

// Interpolates the heights at the points to the lattice along the local slope, which is the slope of the least-squares
// plane through the point.
fn onto_lattice(base: u32, at: vec2<i32>) {
    let cell = cell_at(at);
    let here = word(heights_plane(), cell);
    if (word(OUTLET, cell) == 1u) {
        set_word(other_plane(), cell, here);
        return;
    }
    let h = bitcast<f32>(here);
    var squares = vec3<f32>(0.0);
    var rises = vec2<f32>(0.0);
    for (var code = 0u; code < 8u; code += 1u) {
        let away = between_points(base, cell, code);
        let rise = sample(heights_plane(), neighbor(cell, code)) - h;
        squares += vec3<f32>(away.x * away.x, away.x * away.y, away.y * away.y);
        rises += away * rise;
    }
    let scale = 1.0 / (squares.x * squares.z - squares.y * squares.y);
    let slope = vec2<f32>(rises.x * squares.z - rises.y * squares.y, rises.y * squares.x - rises.x * squares.y) * scale;
    set_sample(other_plane(), cell, h - dot(slope, point_of(base, word(POINT, cell))));
}

// The layers.
fn finish(base: u32, at: vec2<i32>) {
    let cell = cell_at(at);
    let height = word(heights_plane(), cell);
    set_word(HEIGHT, cell, height);
    set_sample(FLOW, cell, discharge(base, cell) * cell_area(base));
    set_sample(CHANGE, cell, bitcast<f32>(height) - sample(SOURCE, cell));
    set_sample(SEDIMENT, cell, 0.0);
}
