//! NEON: 4 lanes in one register, f64 in two. It is part of every aarch64 target, so its token needs no check.

use crate::Level;
use core::arch::aarch64::*;

/// 8 f32, as bytes for lookup.
#[derive(Clone, Copy, Debug)]
pub struct Table8(uint8x16x2_t);
/// 16 f32, as bytes for lookup.
#[derive(Clone, Copy, Debug)]
pub struct Table16(uint8x16x4_t);

level! {
    /// The token of NEON.
    Neon: 4 lanes, requires [];

    Simd {
        fn f32(value: f32) -> F32 => vdupq_n_f32(value);
        fn u32(value: u32) -> U32 => vdupq_n_u32(value);
        fn f64(value: f64) -> F64 => vdupq_n_f64(value);
        fn iota() -> U32 => vld1q_u32([0_u32, 1, 2, 3].as_ptr());
        fn load(from: [f32]) -> F32 => vld1q_f32(from);
        fn load_u32(from: [u32]) -> U32 => vld1q_u32(from);
        fn load_f64(from: [f64]) -> F64 => vld1q_f64(from);
        fn table8(entries: &[f32; 8]) -> Table8 => uint8x16x2_t(bytes(entries), bytes(&entries[4..]));
        fn table16(entries: &[f32; 16]) -> Table16 =>
            uint8x16x4_t(bytes(entries), bytes(&entries[4..]), bytes(&entries[8..]), bytes(&entries[12..]));
        fn lookup8(table: Table8, index: U32) -> F32 =>
            vreinterpretq_f32_u8(vqtbl2q_u8(table, byte_numbers(vandq_u32(index, vdupq_n_u32(7)))));
        fn lookup16(table: Table16, index: U32) -> F32 =>
            vreinterpretq_f32_u8(vqtbl4q_u8(table, byte_numbers(vandq_u32(index, vdupq_n_u32(15)))));
    }
    by_hand {
        type Table8 = Table8;
        type Table16 = Table16;
        const LEVEL: Level = Level::Neon;
        const WIDE_LOOKUP: bool = true;
    }

    /// 4 f32.
    F32(float32x4_t): F32Lanes {
        impl Add: add(a, b) => vaddq_f32(a, b);
        impl Sub: sub(a, b) => vsubq_f32(a, b);
        impl Mul: mul(a, b) => vmulq_f32(a, b);
        impl Div: div(a, b) => vdivq_f32(a, b);
        impl Neg: neg(a) => vnegq_f32(a);
        fn store(a, to: [f32]) => vst1q_f32(to, a);
        fn mul_add(a, factor, term) => vfmaq_f32(term, a, factor);
        fn neg_mul_add(a, factor, term) => vfmsq_f32(term, a, factor);
        // vminq and vmaxq are not used, because they propagate NaN.
        fn min(a, b) => vbslq_f32(vcltq_f32(a, b), a, b);
        fn max(a, b) => vbslq_f32(vcltq_f32(b, a), a, b);
        fn abs(a) => vabsq_f32(a);
        fn sqrt(a) => vsqrtq_f32(a);
        fn floor(a) => vrndmq_f32(a);
        fn lt(a, b) -> Mask => vcltq_f32(a, b);
        fn le(a, b) -> Mask => vcleq_f32(a, b);
        fn eq(a, b) -> Mask => vceqq_f32(a, b);
        fn select(a, mask: Mask, b) => vbslq_f32(mask, a, b);
        fn to_i32(a) -> U32 => {
            // The instruction saturates, but values out of range and NaN must give the lowest number.
            let (lowest, above) = (vdupq_n_f32(-2_147_483_648.0), vdupq_n_f32(2_147_483_648.0));
            let fits = vandq_u32(vcgeq_f32(a, lowest), vcltq_f32(a, above));
            vbslq_u32(fits, vreinterpretq_u32_s32(vcvtq_s32_f32(a)), vdupq_n_u32(0x8000_0000))
        };
        fn bits(a) -> U32 => vreinterpretq_u32_f32(a);
        fn widen(a) -> F64 => (vcvt_f64_f32(vget_low_f32(a)), vcvt_high_f64_f32(a));
        fn permute(a, index: U32) => vreinterpretq_f32_u32(permute(vreinterpretq_u32_f32(a), index));
    }

    /// 4 u32.
    U32(uint32x4_t): U32Lanes {
        impl Add: add(a, b) => vaddq_u32(a, b);
        impl Sub: sub(a, b) => vsubq_u32(a, b);
        impl Mul: mul(a, b) => vmulq_u32(a, b);
        impl BitAnd: bitand(a, b) => vandq_u32(a, b);
        impl BitOr: bitor(a, b) => vorrq_u32(a, b);
        impl BitXor: bitxor(a, b) => veorq_u32(a, b);
        impl Not: not(a) => vmvnq_u32(a);
        fn store(a, to: [u32]) => vst1q_u32(to, a);
        fn shl(a, count: u32) => vshlq_u32(a, vdupq_n_s32(count as i32));
        fn shr(a, count: u32) => vshlq_u32(a, vdupq_n_s32(-(count as i32)));
        fn sar(a, count: u32) =>
            vreinterpretq_u32_s32(vshlq_s32(vreinterpretq_s32_u32(a), vdupq_n_s32(-(count as i32))));
        fn eq(a, b) -> Mask => vceqq_u32(a, b);
        fn lt_i32(a, b) -> Mask => vcltq_s32(vreinterpretq_s32_u32(a), vreinterpretq_s32_u32(b));
        fn select(a, mask: Mask, b) => vbslq_u32(mask, a, b);
        fn i32_to_f32(a) -> F32 => vcvtq_f32_s32(vreinterpretq_s32_u32(a));
        fn as_f32(a) -> F32 => vreinterpretq_f32_u32(a);
        fn permute(a, index: U32) => permute(a, index);
    }

    /// 4 f64.
    F64(float64x2_t, float64x2_t): F64Lanes {
        impl Add: add(a, b) => vaddq_f64(a, b);
        impl Sub: sub(a, b) => vsubq_f64(a, b);
        impl Mul: mul(a, b) => vmulq_f64(a, b);
        fn store(a, to: [f64]) => vst1q_f64(to, a);
        fn min(a, b) => vbslq_f64(vcltq_f64(a, b), a, b);
        fn max(a, b) => vbslq_f64(vcgtq_f64(a, b), a, b);
        fn floor(a) => vrndmq_f64(a);
        fn narrow(low, high) -> F32 => vcvt_high_f32_f64(vcvt_f32_f64(low), high);
        fn words(low, high) => {
            let (a, b) = (vreinterpretq_u32_f64(low), vreinterpretq_u32_f64(high));
            (vuzp1q_u32(a, b), vuzp2q_u32(a, b))
        };
    }

    /// 4 truth values, each all ones or all zeros.
    Mask(uint32x4_t): MaskLanes {
        impl BitAnd: bitand(a, b) => vandq_u32(a, b);
        impl BitOr: bitor(a, b) => vorrq_u32(a, b);
        impl Not: not(a) => vmvnq_u32(a);
        fn to_bits(a) -> u32 => vaddvq_u32(vandq_u32(a, vld1q_u32([1_u32, 2, 4, 8].as_ptr())));
    }
}

// SAFETY of the blocks below: NEON belongs to the aarch64 baseline, so the processor has the instructions.

/// The byte indices of word `index` of a table: 4 * index in every byte, plus 0 to 3.
#[inline(always)]
fn byte_numbers(index: uint32x4_t) -> uint8x16_t {
    // SAFETY: see above.
    unsafe {
        let spread = vmulq_u32(index, vdupq_n_u32(0x0404_0404));
        vreinterpretq_u8_u32(vaddq_u32(spread, vdupq_n_u32(0x0302_0100)))
    }
}

/// 16 bytes of a table of f32.
#[inline(always)]
fn bytes(entries: &[f32]) -> uint8x16_t {
    let entries = &entries[..4];
    // SAFETY: see above; the slice has four values.
    unsafe { vreinterpretq_u8_f32(vld1q_f32(entries.as_ptr())) }
}

/// The lanes with these indices. Only the lower bits of an index are used.
#[inline(always)]
fn permute(a: uint32x4_t, index: uint32x4_t) -> uint32x4_t {
    // SAFETY: see above.
    unsafe {
        let numbers = byte_numbers(vandq_u32(index, vdupq_n_u32(3)));
        vreinterpretq_u32_u8(vqtbl1q_u8(vreinterpretq_u8_u32(a), numbers))
    }
}
