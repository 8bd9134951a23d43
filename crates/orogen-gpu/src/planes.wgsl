// Common functions of all passes: planes of one size, one after the other in `samples`, followed by the planes of the
// level above with half the columns and rows. It is used together with `own_words.wgsl` or `shared_words.wgsl`.
//
// The words at `frame.base` are the first column and row of this dispatch, and the index of the words of the passes.
// Before these words are the `HEADER` words of `passes.rs`, which also defines the functions that read them.

// Columns and rows of the planes.
fn size() -> vec2<i32> {
    return vec2<i32>(i32(frame.columns), i32(frame.rows));
}

// Number of cells of a plane, and the cell at a column and row.
fn cells() -> u32 {
    return frame.columns * frame.rows;
}

fn cell_at(at: vec2<i32>) -> u32 {
    return u32(at.y) * frame.columns + u32(at.x);
}

fn index_of(k: u32, at: vec2<i32>) -> u32 {
    return frame.first + (k * frame.rows + u32(at.y)) * frame.columns + u32(at.x);
}

// A sample of plane `k`; positions beyond the border are clamped to it.
fn plane(k: u32, at: vec2<i32>) -> f32 {
    return samples[index_of(k, clamp(at, vec2<i32>(0), size() - vec2<i32>(1)))];
}

fn set_plane(k: u32, at: vec2<i32>, value: f32) {
    samples[index_of(k, at)] = value;
}

// The same samples by their cells, for passes that read and write words.
fn word_index(k: u32, cell: u32) -> u32 {
    return frame.first + k * cells() + cell;
}

fn sample(k: u32, cell: u32) -> f32 {
    return bitcast<f32>(word(k, cell));
}

fn set_sample(k: u32, cell: u32, value: f32) {
    set_word(k, cell, bitcast<u32>(value));
}

// Whether a value is infinite or NaN. Shader compilers may assume that there are no such values, so the bits are
// compared.
fn is_missing(value: f32) -> bool {
    return is_missing_word(bitcast<u32>(value));
}

fn is_missing_word(word: u32) -> bool {
    return (word & 0x7f800000u) == 0x7f800000u;
}

// NaN. The sum hides it from compilers that reject such a constant.
fn missing() -> f32 {
    return bitcast<f32>(0x7fc00000u + min(frame.width, 0u));
}

// Columns and rows of the planes of the level above.
fn above_size() -> vec2<i32> {
    return size() / 2;
}

fn index_above(k: u32, at: vec2<i32>) -> u32 {
    let columns_and_rows = vec2<u32>(above_size());
    let first = frame.first + plane_count() * cells();
    return first + (k * columns_and_rows.y + u32(at.y)) * columns_and_rows.x + u32(at.x);
}

// A sample of plane `k` of the level above; positions beyond the border are clamped to it.
fn above(k: u32, at: vec2<i32>) -> f32 {
    return samples[index_above(k, clamp(at, vec2<i32>(0), above_size() - vec2<i32>(1)))];
}

fn set_above(k: u32, at: vec2<i32>, value: f32) {
    samples[index_above(k, at)] = value;
}

// Copies a plane of the level above from the planes in which that level was made.
fn take_over(base: u32, at: vec2<i32>) {
    let size = vec2<u32>(made_columns(), made_rows());
    let place = vec2<u32>(at) + vec2<u32>(made_left(), made_top());
    set_above(frame.step, at, samples[made_first() + (frame.step * size.y + place.y) * size.x + place.x]);
}

// Column and row of the first sample on the lattice, as whole numbers of 64 bits, the lower part first.
fn first_column() -> vec2<u32> {
    return vec2<u32>(column_low(), column_high());
}

fn first_row() -> vec2<u32> {
    return vec2<u32>(row_low(), row_high());
}

// The position of the window in the planes, and its columns and rows.
fn window_first() -> vec2<i32> {
    return vec2<i32>(vec2<u32>(window_left(), window_top()));
}

fn window_size() -> vec2<i32> {
    return vec2<i32>(vec2<u32>(window_columns(), window_rows()));
}
