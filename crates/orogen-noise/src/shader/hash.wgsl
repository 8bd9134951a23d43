// Hashes of lattice points: the bits of the processor's kernels.

// The key of a cell along an axis. `words` is the index of the axis' two words of the seed.
fn noise_key(words: u32, cell: Cell) -> u32 {
    let here = cell.low * 0x915f77f5u + data[words];
    // The processor's kernels read the words of a cell from an f64, whose exponent is in the high one.
    let high = cell.high + 0x43380000u;
    let key = (here ^ (here >> 15u) ^ (high ^ data[words + 1u])) * 0x93d765ddu;
    return key ^ (key >> 15u);
}

// The keys of a cell and of the next one.
fn noise_keys(words: u32, cell: Cell) -> vec2<u32> {
    return vec2<u32>(noise_key(words, cell), noise_key(words, stepped(cell, 1)));
}

// A cell along an axis by its key and that of the next one, with the fraction.
struct Keyed {
    keys: vec2<u32>,
    t: f32,
}

fn keyed(words: u32, cell: Cell) -> Keyed {
    return Keyed(noise_keys(words, cell), cell.t);
}

// The cell of a sample that is not displaced, from a table of keys of columns or rows.
fn keyed_at(lattice: u32, axis: u32, place: Placement) -> Keyed {
    let columns = data[lattice + LATTICE_TABLES + 2u * axis];
    let rows = data[lattice + LATTICE_TABLES + 2u * axis + 1u];
    let at = select(rows + TABLED_WORDS * place.row, columns + TABLED_WORDS * place.column, columns != 0u);
    return Keyed(vec2<u32>(data[at], data[at + 1u]), bitcast<f32>(data[at + 2u]));
}

// The hash of the point with these keys along x and y.
fn noise_hash(x: u32, y: u32) -> u32 {
    return (x ^ y) * 0xadb4a92du;
}

// A hash as a number in -1 ..= 1, a millionth inside the ends.
fn noise_signed(hash: u32) -> f32 {
    return f32(bitcast<i32>(hash)) * 4.65660843e-10;
}

// A hash as a number in 0 .. 1.
fn noise_unit(hash: u32) -> f32 {
    return f32(hash >> 8u) * 5.9604644775390625e-8;
}

// A number whose sign is turned by the top bit of a word.
fn noise_turned(number: f32, sign: u32) -> f32 {
    return bitcast<f32>(bitcast<u32>(number) ^ (sign & 0x80000000u));
}

// One of sixteen directions, by the upper four bits of a hash. Each bit of their Gray code tells on which side of an axis or a diagonal a direction is.
fn noise_sixteenth(hash: u32) -> vec2<f32> {
    let gray = hash ^ (hash << 1u);
    let is_diagonal = (gray & 0x20000000u) != 0u;
    let longer = select(1.41048455, 1.19575107, is_diagonal);
    let shorter = select(0.280562818, 0.798975348, is_diagonal);
    let is_steep = (gray & 0x40000000u) != 0u;
    return vec2<f32>(
        noise_turned(select(longer, shorter, is_steep), gray),
        noise_turned(select(shorter, longer, is_steep), hash),
    );
}

// 6 t^5 - 15 t^4 + 10 t^3 and its slope, written around the center.
fn noise_quintic(t: f32) -> vec2<f32> {
    let s = t - 0.5;
    let q = s * s;
    let bump = t * (t - 1.0);
    return vec2<f32>(s * (q * (q * 6.0 - 5.0) + 1.875) + 0.5, bump * bump * 30.0);
}
