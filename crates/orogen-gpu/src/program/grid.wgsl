// Grids at any position. A grid's block: the index of its first sample, its width and height, and a lattice whose cells
// are its samples.

fn grid_sample(base: u32, i: i32, j: i32) -> f32 {
    let column = u32(clamp(i, 0, i32(data[base + GRID_COLUMNS]) - 1));
    let row = u32(clamp(j, 0, i32(data[base + GRID_ROWS]) - 1));
    return samples[data[base] + row * data[base + GRID_COLUMNS] + column];
}

// Index of a sample along an axis. Windows are at most 2^31 samples wide, and positions beyond them are clamped to the
// border.
fn grid_index(cell: Cell) -> i32 {
    let high = bitcast<i32>(cell.high);
    let low = bitcast<i32>(cell.low);
    if (high > 0 || (high == 0 && low < 0)) {
        return 1073741824;
    }
    if (high < -1 || (high == -1 && low >= 0)) {
        return -1073741824;
    }
    return clamp(low, -1073741824, 1073741824);
}

// The cubic of Catmull and Rom (1974) through four samples.
fn catmull_rom(p: vec4<f32>, t: f32) -> f32 {
    return p.y + 0.5 * t * ((p.z - p.x) + t * ((2.0 * p.x - 5.0 * p.y + 4.0 * p.z - p.w) + t * (3.0 * (p.y - p.z) + p.w - p.x)));
}

fn grid_row(base: u32, i: i32, j: i32, u: f32) -> f32 {
    let taps = vec4<f32>(grid_sample(base, i - 1, j), grid_sample(base, i, j), grid_sample(base, i + 1, j), grid_sample(base, i + 2, j));
    return catmull_rom(taps, u);
}

fn grid_height(base: u32, place: Placement) -> f32 {
    let x = cell_at(base + GRID_LATTICE, 0u, place);
    let y = cell_at(base + GRID_LATTICE, 1u, place);
    let i = grid_index(x);
    let j = grid_index(y);
    let rows = vec4<f32>(grid_row(base, i, j - 1, x.t), grid_row(base, i, j, x.t), grid_row(base, i, j + 1, x.t), grid_row(base, i, j + 2, x.t));
    return catmull_rom(rows, y.t);
}

fn grid_label(base: u32, place: Placement) -> f32 {
    let x = cell_at(base + GRID_LATTICE, 0u, place);
    let y = cell_at(base + GRID_LATTICE, 1u, place);
    return grid_sample(base, grid_index(x) + select(0, 1, x.t >= 0.5), grid_index(y) + select(0, 1, y.t >= 0.5));
}

// Linear in the logarithms of the four surrounding samples; the nearest sample if one of them is not positive.
fn grid_flow(base: u32, place: Placement) -> f32 {
    let x = cell_at(base + GRID_LATTICE, 0u, place);
    let y = cell_at(base + GRID_LATTICE, 1u, place);
    let i = grid_index(x);
    let j = grid_index(y);
    let north = vec2<f32>(grid_sample(base, i, j), grid_sample(base, i + 1, j));
    let south = vec2<f32>(grid_sample(base, i, j + 1), grid_sample(base, i + 1, j + 1));
    if (min(min(north.x, north.y), min(south.x, south.y)) <= 0.0) {
        return grid_label(base, place);
    }
    // Relative to one of them, so that large numbers keep their precision.
    let above = mix(0.0, log2(north.y / north.x), x.t);
    let below = mix(log2(south.x / north.x), log2(south.y / north.x), x.t);
    return north.x * exp2(mix(above, below, y.t));
}

// A grid with the same samples as the block. Its data are the index of the sample at the block's corner, and the width.
fn grid_copy(base: u32, place: Placement) -> f32 {
    return samples[data[base] + place.row * data[base + GRID_COLUMNS] + place.column];
}
