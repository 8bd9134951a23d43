// Depression filling, after `routing.wgsl`.
const SOURCE = 0u;
const FILLED = 1u;
const DEPTH = 2u;
// Cells are not displaced, so there is no plane of points.
const POINT = SOURCE;

fn fill(base: u32, at: vec2<i32>) {
    let cell = cell_at(at);
    let height = word(SOURCE, cell);
    let filled = filled_bits(cell, step_number());
    set_word(FILLED, cell, filled);
    // An infinite height minus itself is not a number.
    let depth = bitcast<u32>(bitcast<f32>(filled) - bitcast<f32>(height));
    set_word(DEPTH, cell, select(depth, 0x7fc00000u, is_missing_word(height)));
}
