//! The eight directions of a grid.
//!
//! Codes run clockwise from the east: 0 east, 1 south-east, 2 south, 3 south-west, 4 west, 5 north-west, 6 north, 7
//! north-east.

/// The code of a cell without a receiver.
pub const NONE: u8 = 8;

/// The offset of each direction: columns to the east and rows to the south.
pub const STEPS: [(isize, isize); 8] = [(1, 0), (1, 1), (0, 1), (-1, 1), (-1, 0), (-1, -1), (0, -1), (1, -1)];

/// The offset of each direction in a row-major grid with `width` columns.
#[must_use]
pub fn strides(width: usize) -> [isize; 8] {
    STEPS.map(|(east, south)| south * width as isize + east)
}

/// The index of the sample at the offset `stride` from sample `index`. Only valid for samples that have all eight
/// neighbors, which those on the border of the grid do not.
#[inline(always)]
#[must_use]
pub fn neighbor(index: usize, stride: isize) -> usize {
    index.wrapping_add_signed(stride)
}

/// The opposite direction.
#[must_use]
pub fn opposite(code: u8) -> u8 {
    (code + 4) & 7
}

/// Whether a direction is diagonal; its distance is then sqrt(2) cells.
#[must_use]
pub fn is_diagonal(code: u8) -> bool {
    code & 1 == 1
}

/// Distance to the neighbor in each direction, in cells.
pub const DISTANCES: [f64; 8] = [
    1.0,
    std::f64::consts::SQRT_2,
    1.0,
    std::f64::consts::SQRT_2,
    1.0,
    std::f64::consts::SQRT_2,
    1.0,
    std::f64::consts::SQRT_2,
];

/// The numbers that another program uses for the eight directions and for "no direction", in the order of our codes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Convention([u8; 9]);

impl Convention {
    /// Powers of two clockwise from the east: ArcGIS, pysheds.
    pub const ESRI: Convention = Convention([1, 2, 4, 8, 16, 32, 64, 128, 0]);
    /// 1 to 8 counter-clockwise from the north-east.
    pub const GRASS: Convention = Convention([8, 7, 6, 5, 4, 3, 2, 1, 0]);
    /// 1 to 8 counter-clockwise from the east.
    pub const TAUDEM: Convention = Convention([1, 8, 7, 6, 5, 4, 3, 2, 0]);
    /// Powers of two clockwise from the north-east.
    pub const WHITEBOX: Convention = Convention([2, 4, 8, 16, 32, 64, 128, 1, 0]);
    /// The keys of a numeric keypad.
    pub const PCRASTER: Convention = Convention([6, 3, 2, 1, 4, 7, 8, 9, 5]);

    /// The number for one of our codes; any other value gives the number for [`NONE`].
    #[must_use]
    pub fn of(self, code: u8) -> u8 {
        self.0[usize::from(code.min(NONE))]
    }
}

/// A hash of a sample's position on the lattice, to choose between equal candidates. Such choices have no directional
/// bias and do not depend on the window. The multiplication and xor-shifts are those of splitmix64's finalizer (Steele,
/// Lea and Flood 2014).
#[inline]
#[must_use]
pub fn hashed(x: i64, y: i64) -> u32 {
    let mut z = (x as u64).wrapping_mul(0x9E37_79B9_7F4A_7C15) ^ (y as u64).wrapping_mul(0xD1B5_4A32_D192_ED03);
    z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
    (z >> 32) as u32
}

/// Chooses one direction of a set with a hash. Bit k of `set` stands for direction k. [`NONE`] for an empty set.
#[inline]
#[must_use]
pub fn one_of(set: u8, hash: u32) -> u8 {
    if set & set.wrapping_sub(1) == 0 {
        // At most one direction, so there is no choice.
        return set.trailing_zeros() as u8;
    }
    let mut rest = set;
    let skip = (u64::from(hash) * u64::from(set.count_ones())) >> 32;
    for _ in 0..skip {
        rest &= rest - 1;
    }
    rest.trailing_zeros() as u8
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_direction_has_its_way_back() {
        for code in 0..8u8 {
            let ((x, y), (bx, by)) = (STEPS[usize::from(code)], STEPS[usize::from(opposite(code))]);
            assert_eq!((x + bx, y + by), (0, 0));
            assert_eq!(is_diagonal(code), x != 0 && y != 0);
            assert_eq!(DISTANCES[usize::from(code)], ((x * x + y * y) as f64).sqrt());
        }
    }

    #[test]
    fn choices_are_members_and_even() {
        assert_eq!(one_of(0, 12345), NONE);
        for set in 1..=255u8 {
            let mut counts = [0u32; 8];
            for x in 0..400 {
                let code = one_of(set, hashed(x, 7));
                assert!(set & (1 << code) != 0);
                counts[usize::from(code)] += 1;
            }
            let expect = 400 / set.count_ones();
            for code in (0..8).filter(|k| set & (1 << k) != 0) {
                assert!(counts[code] * 2 > expect && counts[code] < expect * 2, "{set:b} {counts:?}");
            }
        }
    }
}
