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

// Adds the top bit of a word to the sign of a direction.
fn noise_turned(direction: vec2<f32>, sign: u32) -> vec2<f32> {
    return select(direction, -direction, (sign & 0x80000000u) != 0u);
}

// One of sixteen directions, by the upper four bits of a hash.
fn noise_sixteenth(hash: u32) -> vec2<f32> {
    let index = (hash >> 28u) & 7u;
    // The directions 4 to 7 are the mirror images of 3 to 0.
    let folded = select(index, 7u - index, index > 3u);
    let odd = (folded & 1u) != 0u;
    let outer = select(1.41048455, 1.19575107, odd);
    let inner = select(0.798975348, 0.280562818, odd);
    let near = select(0.280562818, 0.798975348, odd);
    let far = select(1.19575107, 1.41048455, odd);
    let upper = folded > 1u;
    let x = select(outer, inner, upper);
    let y = select(near, far, upper);
    return noise_turned(vec2<f32>(select(x, -x, index > 3u), y), hash);
}

// 6 t^5 - 15 t^4 + 10 t^3 and its slope, written around the centre.
fn noise_quintic(t: f32) -> vec2<f32> {
    let s = t - 0.5;
    let q = s * s;
    let bump = t * (t - 1.0);
    return vec2<f32>(s * (q * (q * 6.0 - 5.0) + 1.875) + 0.5, bump * bump * 30.0);
}
