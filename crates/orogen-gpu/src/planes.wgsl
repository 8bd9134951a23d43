// What all passes have in common: planes of one size, one after the other in `samples`, and after them those of the level above, with half the columns and rows.
// `own_words.wgsl` or `shared_words.wgsl` stands beside it.
//
// The words at `frame.base` are the first column and row of this dispatch, and where the words of the passes start. Before these are those that `passes.rs`
// names `HEADER`, with what reads them.

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

// A sample of plane `k`; beyond the border, that of the border.
fn plane(k: u32, at: vec2<i32>) -> f32 {
    return samples[index_of(k, clamp(at, vec2<i32>(0), size() - vec2<i32>(1)))];
}

fn set_plane(k: u32, at: vec2<i32>, value: f32) {
    samples[index_of(k, at)] = value;
}

// The same samples by their cells, of passes that read and write words.
fn word_index(k: u32, cell: u32) -> u32 {
    return frame.first + k * cells() + cell;
}

fn sample(k: u32, cell: u32) -> f32 {
    return bitcast<f32>(word(k, cell));
}

fn set_sample(k: u32, cell: u32, value: f32) {
    set_word(k, cell, bitcast<u32>(value));
}

// Whether a value is infinite or not a number. Shader compilers may assume that there are none, so the bits are compared.
fn is_missing(value: f32) -> bool {
    return is_missing_word(bitcast<u32>(value));
}

fn is_missing_word(word: u32) -> bool {
    return (word & 0x7f800000u) == 0x7f800000u;
}

// Not a number. The sum hides it from compilers that refuse such a constant.
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

// A sample of plane `k` of the level above; beyond the border, that of the border.
fn above(k: u32, at: vec2<i32>) -> f32 {
    return samples[index_above(k, clamp(at, vec2<i32>(0), above_size() - vec2<i32>(1)))];
}

fn set_above(k: u32, at: vec2<i32>, value: f32) {
    samples[index_above(k, at)] = value;
}

// Takes a plane of the level above from where that level was made.
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

// Where the window begins among the planes, and its columns and rows.
fn window_first() -> vec2<i32> {
    return vec2<i32>(vec2<u32>(window_left(), window_top()));
}

fn window_size() -> vec2<i32> {
    return vec2<i32>(vec2<u32>(window_columns(), window_rows()));
}
