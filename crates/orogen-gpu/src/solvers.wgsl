// What the passes of all solvers have in common: planes of words of one size, one after the other.
//
// The words at `frame.base` are those of filters: the first column and row of this pass, and where the solver's own words start.

// Columns and rows of the planes.
fn size() -> vec2<i32> {
    return vec2<i32>(i32(frame.columns), i32(frame.rows));
}

// Number of cells of a plane.
fn cells() -> u32 {
    return frame.columns * frame.rows;
}

// The cell at a column and row.
fn cell_at(at: vec2<i32>) -> u32 {
    return u32(at.y) * frame.columns + u32(at.x);
}

// A sample of plane `k`.
fn sample(k: u32, cell: u32) -> f32 {
    return bitcast<f32>(word(k, cell));
}

fn set_sample(k: u32, cell: u32, value: f32) {
    set_word(k, cell, bitcast<u32>(value));
}

// Whether the bits of a value are those of an infinite one or of one that is not a number. Shader compilers may assume that there are none.
fn is_missing(bits: u32) -> bool {
    return (bits & 0x7f800000u) == 0x7f800000u;
}
