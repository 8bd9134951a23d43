//! Derives the words that the kernels use from 64-bit seeds.

/// The finalizer of splitmix64. Every bit of the result depends on every bit of the argument, and different arguments
/// give different results (Steele, Lea, Flood, "Fast splittable pseudorandom number generators", OOPSLA 2014;
/// Stafford's variant 13).
pub(crate) const fn mix64(mut z: u64) -> u64 {
    z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
    z ^ (z >> 31)
}

/// The n-th word of a seed's sequence. The seed is mixed first, and the words are 2^64 / golden ratio apart, so seeds 0
/// and 1 are as unrelated as any two seeds.
pub(crate) const fn word(seed: u64, n: u64) -> u64 {
    mix64(mix64(seed ^ 0x6A09_E667_F3BC_C909).wrapping_add((n + 1).wrapping_mul(0x9E37_79B9_7F4A_7C15)))
}

/// The words of one octave's seed for the lattice hash, two per axis.
pub(crate) fn lattice_words(seed: u64) -> [[u32; 2]; 4] {
    [0, 1, 2, 3].map(|axis| {
        let word = word(seed, axis);
        [word as u32, (word >> 32) as u32]
    })
}

/// The words for the 2002 table, which has no seed: the displacement of the lattice in cells, per axis.
pub(crate) fn reference_words(seed: u64) -> [[u32; 2]; 4] {
    if seed == 0 { [[0; 2]; 4] } else { lattice_words(seed).map(|[word, _]| [word & 255, 0]) }
}

/// The seed of a fractal's octave.
pub(crate) const fn octave_seed(seed: u64, octave: u64) -> u64 {
    word(seed, 16 + octave)
}

/// Displacement of an octave's lattice in cells, from 0 (included) to 1 (excluded). It has 32 fractional bits, so that
/// large coordinates lose little precision.
pub(crate) fn offset(seed: u64, axis: u64) -> f64 {
    f64::from((word(seed, 8 + axis) >> 32) as u32) / 4_294_967_296.0
}
