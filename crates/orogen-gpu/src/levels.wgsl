// What the passes of all levels have in common: planes of the level above, with half the columns and rows, after those of the level.
//
// Before the level's own words are its number of planes; the column and the row of their first sample, each as a low and a high word; and where the planes of
// the level above are made on the card, too: the index of its first sample, its columns and rows, and the column and row of the first sample that is read.
const LEVEL_WORDS = 10u;

// A word before the level's own.
fn header(i: u32) -> u32 {
    return data[data[frame.base + 2u] - LEVEL_WORDS + i];
}

// Columns and rows of the planes of the level above.
fn above_size() -> vec2<i32> {
    return size() / 2;
}

fn index_above(k: u32, at: vec2<i32>) -> u32 {
    let columns_and_rows = vec2<u32>(above_size());
    let first = frame.first + header(0u) * frame.columns * frame.rows;
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
    return vec2<u32>(header(1u), header(2u));
}

fn first_row() -> vec2<u32> {
    return vec2<u32>(header(3u), header(4u));
}

// Takes a plane of the level above from where that level was made.
fn take_over(base: u32, at: vec2<i32>) {
    let size = vec2<u32>(header(6u), header(7u));
    let place = vec2<u32>(at) + vec2<u32>(header(8u), header(9u));
    set_above(frame.step, at, samples[header(5u) + (frame.step * size.y + place.y) * size.x + place.x]);
}
