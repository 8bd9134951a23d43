//! Numbers at lattice points: hashes, values and gradients.

#![allow(clippy::needless_range_loop)] // see kernel/mod.rs

use crate::choices::ClassicVariant;
use crate::kernel::cell::Cell;
use crate::program::{Octave, Source};
use crate::tables::{directions, reference};
use orogen_simd::{F32Lanes, Simd, U32Lanes};

/// A lattice whose points have hashes. The hash of a point is computed from one key per axis, so on a lattice of
/// samples keys are computed only once per lattice column and row.
pub(crate) trait Lattice<S: Simd>: Copy {
    /// The keys of a cell and of the next cell.
    fn keys(self, simd: S, axis: usize, cell: &Cell<S>) -> [S::U32; 2];
    /// The hash of a point with these keys along its first `DIMS` axes. The quality of the top bits is the best.
    fn hash<const DIMS: usize>(self, simd: S, keys: [S::U32; 4]) -> S::U32;
    /// The same lattice and hashes with different keys, which cost more to compute and less to combine. Useful if keys
    /// are stored.
    #[inline(always)]
    fn folded(self) -> Self {
        self
    }
}

/// A lattice whose points have gradients.
pub(crate) trait Gradients<S: Simd>: Lattice<S> {
    /// The lattice for an octave.
    fn new(simd: S, source: Source, octave: &Octave) -> Self;
    /// The gradient of a hash in `DIMS` dimensions; other components are undefined.
    fn gradient<const DIMS: usize>(self, simd: S, hash: S::U32) -> [S::F32; 4];
}

/// The hashed lattice. A 64-bit cell number and 64 bits of seed per axis give a 32-bit key, and the keys give a 32-bit
/// hash.
///
/// A key consists of two rounds of xorshift-multiply: the first of the low word, the second of the high word and the
/// second half of the seed. Keys are combined with xor and a third round, whose top bits depend on every bit of each
/// key. The xorshift of that round distributes over xor, so folded keys already contain it. The constants are odd
/// numbers with good spectral properties modulo 2^32 (G. Steele and S. Vigna, "Computationally easy, spectrally good
/// multipliers", 2021).
#[derive(Clone, Copy)]
pub(crate) struct Hashed<S: Simd> {
    words: [[S::U32; 2]; 4],
    period: [f64; 4],
    folded: bool,
}

const ROUND_1: u32 = 0x915F_77F5;
const ROUND_2: u32 = 0x93D7_65DD;
const ROUND_3: u32 = 0xADB4_A92D;

impl<S: Simd> Hashed<S> {
    #[inline(always)]
    pub(crate) fn new(simd: S, octave: &Octave) -> Hashed<S> {
        let mut words = [[simd.u32(0); 2]; 4];
        for axis in 0..4 {
            words[axis] = [simd.u32(octave.words[axis][0]), simd.u32(octave.words[axis][1])];
        }
        Hashed { words, period: octave.period, folded: false }
    }

    /// The hash of keys that were combined with xor.
    #[inline(always)]
    fn finish(simd: S, joined: S::U32) -> S::U32 {
        Self::finish_folded(simd, joined ^ joined.shr(15))
    }

    /// The hash of folded keys that were combined with xor.
    #[inline(always)]
    pub(crate) fn finish_folded(simd: S, joined: S::U32) -> S::U32 {
        joined * simd.u32(ROUND_3)
    }

    #[inline(always)]
    fn key(self, key: S::U32) -> S::U32 {
        if self.folded { key ^ key.shr(15) } else { key }
    }
}

impl<S: Simd> Lattice<S> for Hashed<S> {
    #[inline(always)]
    fn keys(self, simd: S, axis: usize, cell: &Cell<S>) -> [S::U32; 2] {
        let [first, second] = self.words[axis];
        if self.period[axis] > 0.0 {
            let [here, next] = cell.around(simd, self.period[axis]);
            let (here_low, next_low) = (here[0] * simd.u32(ROUND_1) + first, next[0] * simd.u32(ROUND_1) + first);
            let round = simd.u32(ROUND_2);
            return [
                self.key((here_low ^ here_low.shr(15) ^ (here[1] ^ second)) * round),
                self.key((next_low ^ next_low.shr(15) ^ (next[1] ^ second)) * round),
            ];
        }
        let here = cell.low * simd.u32(ROUND_1) + first;
        let next = here + simd.u32(ROUND_1);
        let round = simd.u32(ROUND_2);
        [
            self.key((here ^ here.shr(15) ^ (cell.high ^ second)) * round),
            self.key((next ^ next.shr(15) ^ (cell.next_high(simd) ^ second)) * round),
        ]
    }
    #[inline(always)]
    fn hash<const DIMS: usize>(self, simd: S, keys: [S::U32; 4]) -> S::U32 {
        let mut joined = keys[0];
        for axis in 1..DIMS {
            joined = joined ^ keys[axis];
        }
        if self.folded { Self::finish_folded(simd, joined) } else { Self::finish(simd, joined) }
    }
    #[inline(always)]
    fn folded(self) -> Self {
        Hashed { folded: true, ..self }
    }
}

/// A hash as a number in -1 ..= 1. It is a millionth inside the ends, so that interpolation cannot round past them.
#[inline(always)]
pub(crate) fn value<S: Simd>(simd: S, hash: S::U32) -> S::F32 {
    const UNIT: f32 = (1.0 - 1.0 / 1_048_576.0) / 2_147_483_648.0;
    hash.i32_to_f32() * simd.f32(UNIT)
}

/// Hashed gradients.
#[derive(Clone, Copy)]
pub(crate) struct PerlinSource<S: Simd> {
    lattice: Hashed<S>,
    // The same directions twice: as a table of sixteen for levels that look it up with one instruction, and as a table
    // of eight with a sign for the others.
    wide: [S::Table16; 2],
    half: [S::Table8; 2],
    space: [S::Table16; 3],
    time: [S::Table16; 4],
}

impl<S: Simd> Lattice<S> for PerlinSource<S> {
    #[inline(always)]
    fn keys(self, simd: S, axis: usize, cell: &Cell<S>) -> [S::U32; 2] {
        self.lattice.keys(simd, axis, cell)
    }
    #[inline(always)]
    fn hash<const DIMS: usize>(self, simd: S, keys: [S::U32; 4]) -> S::U32 {
        self.lattice.hash::<DIMS>(simd, keys)
    }
    #[inline(always)]
    fn folded(self) -> Self {
        PerlinSource { lattice: self.lattice.folded(), ..self }
    }
}

impl<S: Simd> Gradients<S> for PerlinSource<S> {
    #[inline(always)]
    fn new(simd: S, _: Source, octave: &Octave) -> PerlinSource<S> {
        const fn both(half: [f32; 8]) -> [f32; 16] {
            let [a, b, c, d, e, f, g, h] = half;
            [a, b, c, d, e, f, g, h, -a, -b, -c, -d, -e, -f, -g, -h]
        }
        const WIDE: [[f32; 16]; 2] = [both(directions::X_2D), both(directions::Y_2D)];
        PerlinSource {
            lattice: Hashed::new(simd, octave),
            wide: [simd.table16(&WIDE[0]), simd.table16(&WIDE[1])],
            half: [simd.table8(&directions::X_2D), simd.table8(&directions::Y_2D)],
            space: [simd.table16(&directions::X_3D), simd.table16(&directions::Y_3D), simd.table16(&directions::Z_3D)],
            time: [
                simd.table16(&directions::X_4D),
                simd.table16(&directions::Y_4D),
                simd.table16(&directions::Z_4D),
                simd.table16(&directions::W_4D),
            ],
        }
    }
    #[inline(always)]
    fn gradient<const DIMS: usize>(self, simd: S, hash: S::U32) -> [S::F32; 4] {
        let mut gradient = [simd.f32(0.0); 4];
        if DIMS == 2 && S::WIDE_LOOKUP {
            let index = hash.shr(28);
            gradient[0] = simd.lookup16(self.wide[0], index);
            gradient[1] = simd.lookup16(self.wide[1], index);
            return gradient;
        }
        // The top bit is the sign; the next bits select a direction of the upper half.
        let sign = hash & simd.u32(0x8000_0000);
        let index = hash.shr(if DIMS == 2 { 28 } else { 27 });
        for axis in 0..DIMS {
            let upper = match DIMS {
                2 => simd.lookup8(self.half[axis & 1], index),
                3 => simd.lookup16(self.space[axis % 3], index),
                _ => simd.lookup16(self.time[axis], index),
            };
            gradient[axis] = (upper.bits() ^ sign).as_f32();
        }
        gradient
    }
}

/// The lattice of Perlin's 2002 reference: a permutation of 0 ..= 255 that is looked up once per axis.
#[derive(Clone, Copy)]
pub(crate) struct ClassicSource<S: Simd> {
    shift: [S::U32; 4],
    period: [f64; 4],
    variant: ClassicVariant,
}

impl<S: Simd> ClassicSource<S> {
    #[inline(always)]
    fn permuted(simd: S, number: S::U32) -> S::U32 {
        simd.gather_u32(&reference::TABLE, number & simd.u32(255))
    }
}

impl<S: Simd> Lattice<S> for ClassicSource<S> {
    #[inline(always)]
    fn keys(self, simd: S, axis: usize, cell: &Cell<S>) -> [S::U32; 2] {
        let mut here = cell.low + self.shift[axis];
        let mut next = here + simd.u32(1);
        if self.period[axis] > 0.0 {
            let [[low, _], [next_low, _]] = cell.around(simd, self.period[axis]);
            (here, next) = (low + self.shift[axis], next_low + self.shift[axis]);
        }
        if axis == 0 { [Self::permuted(simd, here), Self::permuted(simd, next)] } else { [here, next] }
    }
    #[inline(always)]
    fn hash<const DIMS: usize>(self, simd: S, keys: [S::U32; 4]) -> S::U32 {
        let mut hash = keys[0];
        for axis in 1..DIMS {
            hash = Self::permuted(simd, hash + keys[axis]);
        }
        hash
    }
}

impl<S: Simd> Gradients<S> for ClassicSource<S> {
    #[inline(always)]
    fn new(simd: S, source: Source, octave: &Octave) -> ClassicSource<S> {
        let variant = if let Source::Classic(variant) = source { variant } else { ClassicVariant::Diagonal };
        let mut shift = [simd.u32(0); 4];
        for axis in 0..4 {
            shift[axis] = simd.u32(octave.words[axis][0]);
        }
        ClassicSource { shift, period: octave.period, variant }
    }
    #[inline(always)]
    fn gradient<const DIMS: usize>(self, simd: S, hash: S::U32) -> [S::F32; 4] {
        let none = simd.f32(0.0);
        match DIMS {
            2 => {
                let [x, y] = self.plane(simd, hash);
                [x, y, none, none]
            }
            3 => [
                simd.lookup16(simd.table16(&reference::REFERENCE_X), hash),
                simd.lookup16(simd.table16(&reference::REFERENCE_Y), hash),
                simd.lookup16(simd.table16(&reference::REFERENCE_Z), hash),
                none,
            ],
            _ => {
                let index = hash & simd.u32(31);
                [
                    simd.gather(&reference::REFERENCE_4D_X, index),
                    simd.gather(&reference::REFERENCE_4D_Y, index),
                    simd.gather(&reference::REFERENCE_4D_Z, index),
                    simd.gather(&reference::REFERENCE_4D_W, index),
                ]
            }
        }
    }
}

impl<S: Simd> ClassicSource<S> {
    #[inline(always)]
    fn plane(self, simd: S, hash: S::U32) -> [S::F32; 2] {
        let [x, y] = match self.variant {
            ClassicVariant::Diagonal => [&reference::DIAGONAL_X, &reference::DIAGONAL_Y],
            ClassicVariant::Eight => [&reference::EIGHT_X, &reference::EIGHT_Y],
            ClassicVariant::Angle => {
                let quarter = hash + simd.u32(64);
                return [
                    simd.gather(&reference::SINE, quarter & simd.u32(255)),
                    simd.gather(&reference::SINE, hash & simd.u32(255)),
                ];
            }
        };
        [simd.lookup8(simd.table8(x), hash), simd.lookup8(simd.table8(y), hash)]
    }
}
