// What the passes of all levels have in common: planes of the level above, with half the columns and rows, after those of the level.
//
// The first words of `data` are the number of planes of the level, and the column and the row of their first sample, each as a low and a high word.

// Columns and rows of the planes of the level above.
fn above_size() -> vec2<i32> {
    return size() / 2;
}

fn index_above(k: u32, at: vec2<i32>) -> u32 {
    let columns_and_rows = vec2<u32>(above_size());
    let first = data[0] * data[frame.base] * data[frame.base + 1u];
    return first + (k * columns_and_rows.y + u32(at.y)) * columns_and_rows.x + u32(at.x);
}

// A sample of plane `k` of the level above; beyond the border, that of the border.
fn above(k: u32, at: vec2<i32>) -> f32 {
    return samples[index_above(k, clamp(at, vec2<i32>(0), above_size() - vec2<i32>(1)))];
}

fn set_above(k: u32, at: vec2<i32>, value: f32) {
    samples[index_above(k, at)] = value;
}

// Column and row of the first sample, as whole numbers of 64 bits, the lower part first.
fn first_column() -> vec2<u32> {
    return vec2<u32>(data[1], data[2]);
}

fn first_row() -> vec2<u32> {
    return vec2<u32>(data[3], data[4]);
}
