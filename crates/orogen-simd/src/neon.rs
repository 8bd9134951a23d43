//! NEON: 4 lanes in one register, f64 in two. Part of every aarch64 target, so its token needs no check.

use crate::{Body, F32Lanes, F64Lanes, Level, MaskLanes, Simd, U32Lanes};
use core::arch::aarch64::*;
use std::ops::{Add, BitAnd, BitOr, BitXor, Div, Mul, Neg, Not, Sub};

/// The token of NEON.
#[derive(Clone, Copy, Debug, Default)]
pub struct Neon(());

/// 4 f32.
#[derive(Clone, Copy, Debug)]
pub struct F32x4(float32x4_t);
/// 4 u32.
#[derive(Clone, Copy, Debug)]
pub struct U32x4(uint32x4_t);
/// 4 f64.
#[derive(Clone, Copy, Debug)]
pub struct F64x4(float64x2_t, float64x2_t);
/// 4 truth values, each all ones or all zeros.
#[derive(Clone, Copy, Debug)]
pub struct Mask4(uint32x4_t);
/// 8 f32, as bytes to look up.
#[derive(Clone, Copy, Debug)]
pub struct Table8x128(uint8x16x2_t);
/// 16 f32, as bytes to look up.
#[derive(Clone, Copy, Debug)]
pub struct Table16x128(uint8x16x4_t);

impl Neon {
    /// The token.
    #[inline(always)]
    #[must_use]
    pub const fn new() -> Neon {
        Neon(())
    }
}

// SAFETY of every block in this file: NEON belongs to the aarch64 baseline, so the processor has the instructions. Loads and
// stores touch what a bounds-checked slice covers.

macro_rules! lanewise {
    ($type:ident: $($trait:ident $method:ident $op:ident;)*) => {$(
        impl $trait for $type {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                // SAFETY: see the head of the file.
                #[allow(unused_unsafe)] // which of these are unsafe changes with the compiler
                $type(unsafe { $op(self.0, other.0) })
            }
        }
    )*};
}
lanewise!(F32x4: Add add vaddq_f32; Sub sub vsubq_f32; Mul mul vmulq_f32; Div div vdivq_f32;);
lanewise!(U32x4: Add add vaddq_u32; Sub sub vsubq_u32; Mul mul vmulq_u32;
    BitAnd bitand vandq_u32; BitOr bitor vorrq_u32; BitXor bitxor veorq_u32;);
lanewise!(Mask4: BitAnd bitand vandq_u32; BitOr bitor vorrq_u32;);

macro_rules! lanewise_f64 {
    ($($trait:ident $method:ident $op:ident;)*) => {$(
        impl $trait for F64x4 {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                // SAFETY: see the head of the file.
                unsafe { F64x4($op(self.0, other.0), $op(self.1, other.1)) }
            }
        }
    )*};
}
lanewise_f64!(Add add vaddq_f64; Sub sub vsubq_f64; Mul mul vmulq_f64;);

impl Neg for F32x4 {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        // SAFETY: see the head of the file.
        F32x4(unsafe { vnegq_f32(self.0) })
    }
}
impl Not for U32x4 {
    type Output = Self;
    #[inline(always)]
    fn not(self) -> Self {
        // SAFETY: see the head of the file.
        U32x4(unsafe { vmvnq_u32(self.0) })
    }
}
impl Not for Mask4 {
    type Output = Self;
    #[inline(always)]
    fn not(self) -> Self {
        // SAFETY: see the head of the file.
        Mask4(unsafe { vmvnq_u32(self.0) })
    }
}

/// The byte indices of word `index` of a table: 4 * index in every byte, plus 0 to 3.
#[inline(always)]
fn byte_numbers(index: uint32x4_t) -> uint8x16_t {
    // SAFETY: see the head of the file.
    unsafe {
        let spread = vmulq_u32(index, vdupq_n_u32(0x0404_0404));
        vreinterpretq_u8_u32(vaddq_u32(spread, vdupq_n_u32(0x0302_0100)))
    }
}

/// 16 bytes of a table of f32.
#[inline(always)]
fn bytes(entries: &[f32]) -> uint8x16_t {
    let entries = &entries[..4];
    // SAFETY: see the head of the file.
    unsafe { vreinterpretq_u8_f32(vld1q_f32(entries.as_ptr())) }
}

impl Simd for Neon {
    type F32 = F32x4;
    type U32 = U32x4;
    type F64 = F64x4;
    type Mask = Mask4;
    type Table8 = Table8x128;
    type Table16 = Table16x128;
    const LANES: usize = 4;
    const LEVEL: Level = Level::Neon;
    const WIDE_LOOKUP: bool = true;

    #[inline(always)]
    fn run<B: Body>(self, body: B) -> B::Output {
        #[inline(never)]
        fn inner<B: Body>(token: Neon, body: B) -> B::Output {
            body.run(token)
        }
        inner(self, body)
    }
    #[inline(always)]
    fn f32(self, value: f32) -> F32x4 {
        // SAFETY: see the head of the file.
        F32x4(unsafe { vdupq_n_f32(value) })
    }
    #[inline(always)]
    fn u32(self, value: u32) -> U32x4 {
        // SAFETY: see the head of the file.
        U32x4(unsafe { vdupq_n_u32(value) })
    }
    #[inline(always)]
    fn f64(self, value: f64) -> F64x4 {
        // SAFETY: see the head of the file.
        unsafe { F64x4(vdupq_n_f64(value), vdupq_n_f64(value)) }
    }
    #[inline(always)]
    fn iota(self) -> U32x4 {
        self.load_u32(&[0, 1, 2, 3])
    }
    #[inline(always)]
    fn load(self, from: &[f32]) -> F32x4 {
        let from = &from[..4];
        // SAFETY: see the head of the file.
        F32x4(unsafe { vld1q_f32(from.as_ptr()) })
    }
    #[inline(always)]
    fn load_u32(self, from: &[u32]) -> U32x4 {
        let from = &from[..4];
        // SAFETY: see the head of the file.
        U32x4(unsafe { vld1q_u32(from.as_ptr()) })
    }
    #[inline(always)]
    fn load_f64(self, from: &[f64]) -> F64x4 {
        let from = &from[..4];
        // SAFETY: see the head of the file.
        unsafe { F64x4(vld1q_f64(from.as_ptr()), vld1q_f64(from[2..].as_ptr())) }
    }
    #[inline(always)]
    fn table8(self, entries: &[f32; 8]) -> Table8x128 {
        Table8x128(uint8x16x2_t(bytes(entries), bytes(&entries[4..])))
    }
    #[inline(always)]
    fn table16(self, entries: &[f32; 16]) -> Table16x128 {
        Table16x128(uint8x16x4_t(bytes(entries), bytes(&entries[4..]), bytes(&entries[8..]), bytes(&entries[12..])))
    }
    #[inline(always)]
    fn lookup8(self, table: Table8x128, index: U32x4) -> F32x4 {
        // SAFETY: see the head of the file.
        F32x4(unsafe {
            let index = byte_numbers(vandq_u32(index.0, vdupq_n_u32(7)));
            vreinterpretq_f32_u8(vqtbl2q_u8(table.0, index))
        })
    }
    #[inline(always)]
    fn lookup16(self, table: Table16x128, index: U32x4) -> F32x4 {
        // SAFETY: see the head of the file.
        F32x4(unsafe {
            let index = byte_numbers(vandq_u32(index.0, vdupq_n_u32(15)));
            vreinterpretq_f32_u8(vqtbl4q_u8(table.0, index))
        })
    }
}

impl F32Lanes<Neon> for F32x4 {
    #[inline(always)]
    fn store(self, to: &mut [f32]) {
        let to = &mut to[..4];
        // SAFETY: see the head of the file.
        unsafe { vst1q_f32(to.as_mut_ptr(), self.0) }
    }
    #[inline(always)]
    fn mul_add(self, factor: Self, term: Self) -> Self {
        // SAFETY: see the head of the file.
        F32x4(unsafe { vfmaq_f32(term.0, self.0, factor.0) })
    }
    #[inline(always)]
    fn neg_mul_add(self, factor: Self, term: Self) -> Self {
        // SAFETY: see the head of the file.
        F32x4(unsafe { vfmsq_f32(term.0, self.0, factor.0) })
    }
    #[inline(always)]
    fn min(self, other: Self) -> Self {
        // Not vminq, which propagates NaN.
        self.select(self.lt(other), other)
    }
    #[inline(always)]
    fn max(self, other: Self) -> Self {
        self.select(other.lt(self), other)
    }
    #[inline(always)]
    fn abs(self) -> Self {
        // SAFETY: see the head of the file.
        F32x4(unsafe { vabsq_f32(self.0) })
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        // SAFETY: see the head of the file.
        F32x4(unsafe { vsqrtq_f32(self.0) })
    }
    #[inline(always)]
    fn floor(self) -> Self {
        // SAFETY: see the head of the file.
        F32x4(unsafe { vrndmq_f32(self.0) })
    }
    #[inline(always)]
    fn lt(self, other: Self) -> Mask4 {
        // SAFETY: see the head of the file.
        Mask4(unsafe { vcltq_f32(self.0, other.0) })
    }
    #[inline(always)]
    fn le(self, other: Self) -> Mask4 {
        // SAFETY: see the head of the file.
        Mask4(unsafe { vcleq_f32(self.0, other.0) })
    }
    #[inline(always)]
    fn eq(self, other: Self) -> Mask4 {
        // SAFETY: see the head of the file.
        Mask4(unsafe { vceqq_f32(self.0, other.0) })
    }
    #[inline(always)]
    fn select(self, mask: Mask4, other: Self) -> Self {
        // SAFETY: see the head of the file.
        F32x4(unsafe { vbslq_f32(mask.0, self.0, other.0) })
    }
    #[inline(always)]
    fn to_i32(self) -> U32x4 {
        // The instruction saturates; values out of range and NaN must give the lowest number.
        // SAFETY: see the head of the file.
        U32x4(unsafe {
            let fits = vandq_u32(
                vcgeq_f32(self.0, vdupq_n_f32(-2_147_483_648.0)),
                vcltq_f32(self.0, vdupq_n_f32(2_147_483_648.0)),
            );
            vbslq_u32(fits, vreinterpretq_u32_s32(vcvtq_s32_f32(self.0)), vdupq_n_u32(0x8000_0000))
        })
    }
    #[inline(always)]
    fn bits(self) -> U32x4 {
        // SAFETY: see the head of the file.
        U32x4(unsafe { vreinterpretq_u32_f32(self.0) })
    }
    #[inline(always)]
    fn widen(self) -> F64x4 {
        // SAFETY: see the head of the file.
        unsafe { F64x4(vcvt_f64_f32(vget_low_f32(self.0)), vcvt_high_f64_f32(self.0)) }
    }
    #[inline(always)]
    fn permute(self, index: U32x4) -> Self {
        // SAFETY: see the head of the file.
        F32x4(unsafe {
            let index = byte_numbers(vandq_u32(index.0, vdupq_n_u32(3)));
            vreinterpretq_f32_u8(vqtbl1q_u8(vreinterpretq_u8_f32(self.0), index))
        })
    }
}

impl U32Lanes<Neon> for U32x4 {
    #[inline(always)]
    fn store(self, to: &mut [u32]) {
        let to = &mut to[..4];
        // SAFETY: see the head of the file.
        unsafe { vst1q_u32(to.as_mut_ptr(), self.0) }
    }
    #[inline(always)]
    fn shl(self, count: u32) -> Self {
        // SAFETY: see the head of the file.
        U32x4(unsafe { vshlq_u32(self.0, vdupq_n_s32((count & 31) as i32)) })
    }
    #[inline(always)]
    fn shr(self, count: u32) -> Self {
        // SAFETY: see the head of the file.
        U32x4(unsafe { vshlq_u32(self.0, vdupq_n_s32(-((count & 31) as i32))) })
    }
    #[inline(always)]
    fn sar(self, count: u32) -> Self {
        // SAFETY: see the head of the file.
        U32x4(unsafe {
            vreinterpretq_u32_s32(vshlq_s32(vreinterpretq_s32_u32(self.0), vdupq_n_s32(-((count & 31) as i32))))
        })
    }
    #[inline(always)]
    fn eq(self, other: Self) -> Mask4 {
        // SAFETY: see the head of the file.
        Mask4(unsafe { vceqq_u32(self.0, other.0) })
    }
    #[inline(always)]
    fn lt_i32(self, other: Self) -> Mask4 {
        // SAFETY: see the head of the file.
        Mask4(unsafe { vcltq_s32(vreinterpretq_s32_u32(self.0), vreinterpretq_s32_u32(other.0)) })
    }
    #[inline(always)]
    fn select(self, mask: Mask4, other: Self) -> Self {
        // SAFETY: see the head of the file.
        U32x4(unsafe { vbslq_u32(mask.0, self.0, other.0) })
    }
    #[inline(always)]
    fn i32_to_f32(self) -> F32x4 {
        // SAFETY: see the head of the file.
        F32x4(unsafe { vcvtq_f32_s32(vreinterpretq_s32_u32(self.0)) })
    }
    #[inline(always)]
    fn as_f32(self) -> F32x4 {
        // SAFETY: see the head of the file.
        F32x4(unsafe { vreinterpretq_f32_u32(self.0) })
    }
    #[inline(always)]
    fn permute(self, index: Self) -> Self {
        self.as_f32().permute(index).bits()
    }
}

impl F64Lanes<Neon> for F64x4 {
    #[inline(always)]
    fn store(self, to: &mut [f64]) {
        let to = &mut to[..4];
        // SAFETY: see the head of the file.
        unsafe {
            vst1q_f64(to.as_mut_ptr(), self.0);
            vst1q_f64(to[2..].as_mut_ptr(), self.1);
        }
    }
    #[inline(always)]
    fn min(self, other: Self) -> Self {
        // SAFETY: see the head of the file.
        unsafe {
            F64x4(
                vbslq_f64(vcltq_f64(self.0, other.0), self.0, other.0),
                vbslq_f64(vcltq_f64(self.1, other.1), self.1, other.1),
            )
        }
    }
    #[inline(always)]
    fn max(self, other: Self) -> Self {
        // SAFETY: see the head of the file.
        unsafe {
            F64x4(
                vbslq_f64(vcgtq_f64(self.0, other.0), self.0, other.0),
                vbslq_f64(vcgtq_f64(self.1, other.1), self.1, other.1),
            )
        }
    }
    #[inline(always)]
    fn floor(self) -> Self {
        // SAFETY: see the head of the file.
        unsafe { F64x4(vrndmq_f64(self.0), vrndmq_f64(self.1)) }
    }
    #[inline(always)]
    fn narrow(self) -> F32x4 {
        // SAFETY: see the head of the file.
        F32x4(unsafe { vcvt_high_f32_f64(vcvt_f32_f64(self.0), self.1) })
    }
    #[inline(always)]
    fn words(self) -> (U32x4, U32x4) {
        // SAFETY: see the head of the file.
        unsafe {
            let (a, b) = (vreinterpretq_u32_f64(self.0), vreinterpretq_u32_f64(self.1));
            (U32x4(vuzp1q_u32(a, b)), U32x4(vuzp2q_u32(a, b)))
        }
    }
}

impl MaskLanes for Mask4 {
    const LANES: usize = 4;
    #[inline(always)]
    fn to_bits(self) -> u32 {
        // SAFETY: see the head of the file.
        unsafe { vaddvq_u32(vandq_u32(self.0, vld1q_u32([1_u32, 2, 4, 8].as_ptr()))) }
    }
}
