// The words of a noise: its head, its octaves, the words of its source, and the lattices of its octaves.
//
// Head: number of octaves, number of words of the source, skew of the lattice, and three parameters of the combination.
// Octave: two words of the hash for each axis, amplitude, slope, gain, and the factors of displacements and of slopes in swiss and jordan noise.

// A value and its slopes along x and y.
struct NoiseSloped {
    value: f32,
    slope: vec2<f32>,
}

// Index of the words of the source.
fn noise_source(base: u32) -> u32 {
    return base + NOISE_OCTAVES + NOISE_OCTAVE * data[base];
}

// Index of the lattice of the first octave.
fn noise_lattice(base: u32) -> u32 {
    return noise_source(base) + data[base + NOISE_SOURCE_WORDS];
}

// A sample of an octave with its factors.
fn noise_scaled(octave: u32, raw: vec3<f32>) -> NoiseSloped {
    return NoiseSloped(number(octave, NOISE_AMPLITUDE) * raw.x, number(octave, NOISE_SLOPE) * raw.yz);
}

fn noise_moved_along(cell: Cell, by: f32) -> Cell {
    let whole = floor(by);
    return carried(stepped(Cell(cell.low, cell.high, cell.t + (by - whole)), i32(whole)));
}

// The cell of a sample that earlier octaves have displaced by this number of cells.
fn noise_moved(base: u32, cell: Cell, axis: u32, shift: vec2<f32>) -> Cell {
    let moved = noise_moved_along(cell, shift[axis]);
    let skew = number(base, NOISE_SKEW);
    if (skew == 0.0) {
        return moved;
    }
    return noise_moved_along(moved, skew * (shift.x + shift.y));
}

// A displacement in cells; huge ones and NaN are ignored.
fn noise_shift(displacement: vec2<f32>, factor: f32) -> vec2<f32> {
    let shift = displacement * factor;
    return select(vec2<f32>(0.0), shift, abs(shift) < vec2<f32>(1048576.0));
}
