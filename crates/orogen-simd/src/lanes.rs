//! The operations of a body: the token's trait and the traits of its lane types.
//!
//! The operations give the same bits at every level, except for the payload and sign of NaN, which are unspecified.

use crate::{Body, Level, Stream};
use std::ops::{Add, BitAnd, BitOr, BitXor, Div, Mul, Neg, Not, Sub};

/// Proof that a level's instructions may be used, and access to its lanes. Lane values can only be created with a
/// token, so safe code never executes an instruction that the processor does not have.
///
/// Loads and stores panic if a slice is too short, as indexing does. The `_partial` forms accept any length.
pub trait Simd: Copy + Send + Sync + 'static {
    /// `LANES` f32.
    type F32: F32Lanes<Self>;
    /// `LANES` u32 with wrapping arithmetic; interpreted as i32 where a method says so.
    type U32: U32Lanes<Self>;
    /// `LANES` f64, in as many registers as they need.
    type F64: F64Lanes<Self>;
    /// One boolean per lane.
    type Mask: MaskLanes;
    /// A lookup table of eight f32 in registers.
    type Table8: Copy;
    /// A lookup table of sixteen f32 in registers.
    type Table16: Copy;

    /// Number of lanes of the types: 4, 8 or 16, or twice that ([`crate::Double`]).
    const LANES: usize;
    /// The level that this token proves.
    const LEVEL: Level;
    /// Whether [`Simd::lookup16`] is a single instruction, and thus faster than [`Simd::lookup8`] with a sign.
    const WIDE_LOOKUP: bool;

    /// Compiles `body` as a separate function for this level and calls it.
    fn run<B: Body>(self, body: B) -> B::Output;

    /// `value` in every lane.
    fn f32(self, value: f32) -> Self::F32;
    /// `value` in every lane.
    fn u32(self, value: u32) -> Self::U32;
    /// `value` in every lane.
    fn f64(self, value: f64) -> Self::F64;
    /// 0, 1, 2 ... in lane order.
    fn iota(self) -> Self::U32;

    /// The first `LANES` values of `from`.
    fn load(self, from: &[f32]) -> Self::F32;
    /// The first `LANES` values of `from`; lanes beyond its end hold `rest`.
    #[inline(always)]
    fn load_partial(self, from: &[f32], rest: f32) -> Self::F32 {
        if from.len() >= Self::LANES {
            return self.load(from);
        }
        let mut lanes = [rest; 32];
        lanes[..from.len()].copy_from_slice(from);
        self.load(&lanes)
    }
    /// The first `LANES` values of `from`.
    fn load_u32(self, from: &[u32]) -> Self::U32;
    /// The first `LANES` values of `from`; lanes beyond its end hold `rest`.
    #[inline(always)]
    fn load_u32_partial(self, from: &[u32], rest: u32) -> Self::U32 {
        if from.len() >= Self::LANES {
            return self.load_u32(from);
        }
        let mut lanes = [rest; 32];
        lanes[..from.len()].copy_from_slice(from);
        self.load_u32(&lanes)
    }
    /// The first `LANES` values of `from`.
    fn load_f64(self, from: &[f64]) -> Self::F64;
    /// The first `LANES` values of `from`; lanes beyond its end hold `rest`.
    #[inline(always)]
    fn load_f64_partial(self, from: &[f64], rest: f64) -> Self::F64 {
        if from.len() >= Self::LANES {
            return self.load_f64(from);
        }
        let mut lanes = [rest; 32];
        lanes[..from.len()].copy_from_slice(from);
        self.load_f64(&lanes)
    }

    /// A table for [`Simd::lookup8`].
    fn table8(self, entries: &[f32; 8]) -> Self::Table8;
    /// A table for [`Simd::lookup16`].
    fn table16(self, entries: &[f32; 16]) -> Self::Table16;
    /// The entry for each lane, selected by the low three bits of its index.
    fn lookup8(self, table: Self::Table8, index: Self::U32) -> Self::F32;
    /// The entry for each lane, selected by the low four bits of its index.
    fn lookup16(self, table: Self::Table16, index: Self::U32) -> Self::F32;

    /// The floor of each number, and the floor as an integer in two's complement: its low word, and its high word plus
    /// 0x4338_0000. Numbers must have an absolute value below 2^51; the sign of a zero is unspecified.
    #[inline(always)]
    fn whole(self, number: Self::F64) -> (Self::F64, Self::U32, Self::U32) {
        // After adding 1.5 * 2^52, an integer is in the low bits of the sum.
        let whole = number.floor();
        let (low, high) = (whole + self.f64(FAR)).words();
        (whole, low, high)
    }
    /// The floor of each number, and its index among the `count` integers that start at `from`. The last result is zero
    /// in all lanes if all floors are in that range. Otherwise at least one lane is not zero, not necessarily the lane
    /// of the number outside the range, and the indices are unspecified. `from` is an integer with an absolute value
    /// below 2^50, `count` is a power of two up to 2^31. The numbers can have any value.
    #[inline(always)]
    fn place(self, number: Self::F64, from: f64, count: u32) -> (Self::F64, Self::U32, Self::U32) {
        // A sum with this absolute value is exact, and no other sum has its high word.
        let whole = number.floor();
        let (low, high) = (whole + self.f64(FAR - from)).words();
        let elsewhere = self.u32((FAR.to_bits() >> 32) as u32) ^ high;
        (whole, low, elsewhere | (low & self.u32(!(count - 1))))
    }

    /// `from[index]` per lane, with unsigned indices. An index beyond the end reads the last entry; an empty slice
    /// gives 0.
    #[inline(always)]
    fn gather(self, from: &[f32], index: Self::U32) -> Self::F32 {
        self.load(&picked(from, index))
    }
    /// `from[index]` per lane, with unsigned indices. An index beyond the end reads the last entry; an empty slice
    /// gives 0.
    #[inline(always)]
    fn gather_u32(self, from: &[u32], index: Self::U32) -> Self::U32 {
        self.load_u32(&picked(from, index))
    }
}

/// 1.5 * 2^52. The sum with an integer whose absolute value is below 2^51 has that integer in its low bits.
pub(crate) const FAR: f64 = 6_755_399_441_055_744.0;

/// `from[index]` per lane, for levels without a gather instruction.
#[inline(always)]
fn picked<S: Simd, I: U32Lanes<S>, T: Copy + Default>(from: &[T], index: I) -> [T; 32] {
    let mut lanes = [0; 32];
    index.store(&mut lanes);
    let last = from.last().copied().unwrap_or_default();
    let mut entries = [T::default(); 32];
    for (entry, index) in entries.iter_mut().zip(lanes).take(S::LANES) {
        *entry = from.get(index as usize).copied().unwrap_or(last);
    }
    entries
}

/// `S::LANES` f32. `+ - * /`, [`sqrt`](Self::sqrt) and [`mul_add`](Self::mul_add) are rounded correctly (to nearest,
/// ties to even). Subnormals are kept.
pub trait F32Lanes<S: Simd>:
    Copy
    + Send
    + Sync
    + 'static
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
{
    /// Writes the lanes to the first `LANES` elements of `to`.
    fn store(self, to: &mut [f32]);
    /// Writes as many lanes as `to` has elements.
    #[inline(always)]
    fn store_partial(self, to: &mut [f32]) {
        if to.len() >= S::LANES {
            return self.store(to);
        }
        let mut lanes = [0.0; 32];
        self.store(&mut lanes);
        let room = to.len();
        to.copy_from_slice(&lanes[..room]);
    }
    /// Writes as many lanes as `to` has elements. Uses non-temporal stores if `to` is aligned to a register and the
    /// level supports them; otherwise it works like [`store_partial`](Self::store_partial).
    #[inline(always)]
    fn stream(self, to: &mut [f32], stream: &Stream) {
        let _ = stream;
        self.store_partial(to);
    }
    /// `self * factor + term`, rounded once.
    fn mul_add(self, factor: Self, term: Self) -> Self;
    /// `term - self * factor`, rounded once.
    fn neg_mul_add(self, factor: Self, term: Self) -> Self;
    /// `self < other ? self : other`, which is `other` if either is NaN or both are zero.
    fn min(self, other: Self) -> Self;
    /// `self > other ? self : other`, which is `other` if either is NaN or both are zero.
    fn max(self, other: Self) -> Self;
    /// The absolute value (clears the sign bit).
    fn abs(self) -> Self;
    /// The square root; NaN for negative numbers.
    fn sqrt(self) -> Self;
    /// The floor; keeps the sign of zero.
    fn floor(self) -> Self;
    /// `self < other`; false for NaN.
    fn lt(self, other: Self) -> S::Mask;
    /// `self <= other`; false for NaN.
    fn le(self, other: Self) -> S::Mask;
    /// `self == other`; false for NaN.
    fn eq(self, other: Self) -> S::Mask;
    /// `self` where the mask is set, otherwise `other`.
    fn select(self, mask: S::Mask, other: Self) -> Self;
    /// Truncation to i32; NaN and values out of range give `i32::MIN`.
    fn to_i32(self) -> S::U32;
    /// The bit patterns.
    fn bits(self) -> S::U32;
    /// Conversion to f64, which is exact.
    fn widen(self) -> S::F64;
    /// Permutes the lanes: lane i gets lane `index[i] % LANES`.
    fn permute(self, index: S::U32) -> Self;
}

/// `S::LANES` u32. `+ - *` wrap around.
pub trait U32Lanes<S: Simd>:
    Copy
    + Send
    + Sync
    + 'static
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + BitAnd<Output = Self>
    + BitOr<Output = Self>
    + BitXor<Output = Self>
    + Not<Output = Self>
{
    /// Writes the lanes to the first `LANES` elements of `to`.
    fn store(self, to: &mut [u32]);
    /// Writes as many lanes as `to` has elements.
    #[inline(always)]
    fn store_partial(self, to: &mut [u32]) {
        if to.len() >= S::LANES {
            return self.store(to);
        }
        let mut lanes = [0; 32];
        self.store(&mut lanes);
        let room = to.len();
        to.copy_from_slice(&lanes[..room]);
    }
    /// Shifted left by `count % 32` bits.
    fn shl(self, count: u32) -> Self;
    /// Shifted right by `count % 32` bits, filled with zeros.
    fn shr(self, count: u32) -> Self;
    /// Arithmetic shift right by `count % 32` bits, as i32.
    fn sar(self, count: u32) -> Self;
    /// `self == other`.
    fn eq(self, other: Self) -> S::Mask;
    /// `self < other`, as i32.
    fn lt_i32(self, other: Self) -> S::Mask;
    /// `self` where the mask is set, otherwise `other`.
    fn select(self, mask: S::Mask, other: Self) -> Self;
    /// Conversion of the lanes, interpreted as i32, rounded to nearest.
    fn i32_to_f32(self) -> S::F32;
    /// The lanes as bit patterns of f32.
    fn as_f32(self) -> S::F32;
    /// Permutes the lanes: lane i gets lane `index[i] % LANES`.
    fn permute(self, index: S::U32) -> Self;
}

/// `S::LANES` f64, for positions. Arithmetic is rounded correctly.
pub trait F64Lanes<S: Simd>:
    Copy + Send + Sync + 'static + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self>
{
    /// Writes the lanes to the first `LANES` elements of `to`.
    fn store(self, to: &mut [f64]);
    /// `self < other ? self : other`.
    fn min(self, other: Self) -> Self;
    /// `self > other ? self : other`.
    fn max(self, other: Self) -> Self;
    /// The floor; keeps the sign of zero.
    fn floor(self) -> Self;
    /// Rounded to the nearest f32.
    fn narrow(self) -> S::F32;
    /// The low and the high half of each bit pattern.
    fn words(self) -> (S::U32, S::U32);
}

/// One boolean per lane.
pub trait MaskLanes:
    Copy + Send + Sync + 'static + BitAnd<Output = Self> + BitOr<Output = Self> + Not<Output = Self>
{
    /// Number of lanes.
    const LANES: usize;

    /// The lanes as bits: lane i is bit i, and higher bits are 0.
    fn to_bits(self) -> u32;
    /// Whether any lane is true.
    #[inline(always)]
    fn any(self) -> bool {
        self.to_bits() != 0
    }
}
