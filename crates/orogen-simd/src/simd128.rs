//! WebAssembly's 128-bit vectors: 4 lanes in one register, f64 in two. A module is compiled with or without them (`-C
//! target-feature=+simd128`), so the token needs no check. They have no fused multiply-add with defined rounding; it is
//! emulated with f64, as at the scalar level.

use crate::Level;
use core::arch::wasm32::*;

/// 8 f32, as bytes for lookup.
#[derive(Clone, Copy, Debug)]
pub struct Table8([v128; 2]);
/// 16 f32, as bytes for lookup.
#[derive(Clone, Copy, Debug)]
pub struct Table16([v128; 4]);

level! {
    /// The token of WebAssembly's vectors.
    Simd128: 4 lanes, requires [];

    Simd {
        fn f32(value: f32) -> F32 => f32x4_splat(value);
        fn u32(value: u32) -> U32 => u32x4_splat(value);
        fn f64(value: f64) -> F64 => f64x2_splat(value);
        fn iota() -> U32 => u32x4(0, 1, 2, 3);
        fn load(from: [f32]) -> F32 => v128_load(from.cast());
        fn load_u32(from: [u32]) -> U32 => v128_load(from.cast());
        fn load_f64(from: [f64]) -> F64 => v128_load(from.cast());
        fn table8(entries: &[f32; 8]) -> Table8 => [0, 4].map(|first| v128_load(entries[first..].as_ptr().cast()));
        fn table16(entries: &[f32; 16]) -> Table16 =>
            [0, 4, 8, 12].map(|first| v128_load(entries[first..].as_ptr().cast()));
        fn lookup8(table: Table8, index: U32) -> F32 => look_up(table, byte_numbers(v128_and(index, u32x4_splat(7))));
        fn lookup16(table: Table16, index: U32) -> F32 => look_up(table, byte_numbers(v128_and(index, u32x4_splat(15))));
    }
    by_hand {
        type Table8 = Table8;
        type Table16 = Table16;
        const LEVEL: Level = Level::Simd128;
        const WIDE_LOOKUP: bool = false;
    }

    /// 4 f32.
    F32(v128): F32Lanes {
        impl Add: add(a, b) => f32x4_add(a, b);
        impl Sub: sub(a, b) => f32x4_sub(a, b);
        impl Mul: mul(a, b) => f32x4_mul(a, b);
        impl Div: div(a, b) => f32x4_div(a, b);
        impl Neg: neg(a) => f32x4_neg(a);
        fn store(a, to: [f32]) => v128_store(to.cast(), a);
        fn mul_add(a, factor, term) => fused(a, factor, term);
        fn neg_mul_add(a, factor, term) => fused(f32x4_neg(a), factor, term);
        fn min(a, b) => f32x4_pmin(b, a);
        fn max(a, b) => f32x4_pmax(b, a);
        fn abs(a) => f32x4_abs(a);
        fn sqrt(a) => f32x4_sqrt(a);
        fn floor(a) => f32x4_floor(a);
        fn lt(a, b) -> Mask => f32x4_lt(a, b);
        fn le(a, b) -> Mask => f32x4_le(a, b);
        fn eq(a, b) -> Mask => f32x4_eq(a, b);
        fn select(a, mask: Mask, b) => v128_bitselect(a, b, mask);
        fn to_i32(a) -> U32 => {
            // The instruction saturates, but values out of range and NaN must give the lowest number.
            let (lowest, above) = (f32x4_splat(-2_147_483_648.0), f32x4_splat(2_147_483_648.0));
            let fits = v128_and(f32x4_ge(a, lowest), f32x4_lt(a, above));
            v128_bitselect(i32x4_trunc_sat_f32x4(a), u32x4_splat(0x8000_0000), fits)
        };
        fn bits(a) -> U32 => a;
        fn widen(a) -> F64 => (f64x2_promote_low_f32x4(a), promote_high(a));
        fn permute(a, index: U32) => permute(a, index);
    }

    /// 4 u32.
    U32(v128): U32Lanes {
        impl Add: add(a, b) => i32x4_add(a, b);
        impl Sub: sub(a, b) => i32x4_sub(a, b);
        impl Mul: mul(a, b) => i32x4_mul(a, b);
        impl BitAnd: bitand(a, b) => v128_and(a, b);
        impl BitOr: bitor(a, b) => v128_or(a, b);
        impl BitXor: bitxor(a, b) => v128_xor(a, b);
        impl Not: not(a) => v128_not(a);
        fn store(a, to: [u32]) => v128_store(to.cast(), a);
        fn shl(a, count: u32) => u32x4_shl(a, count);
        fn shr(a, count: u32) => u32x4_shr(a, count);
        fn sar(a, count: u32) => i32x4_shr(a, count);
        fn eq(a, b) -> Mask => i32x4_eq(a, b);
        fn lt_i32(a, b) -> Mask => i32x4_lt(a, b);
        fn select(a, mask: Mask, b) => v128_bitselect(a, b, mask);
        fn i32_to_f32(a) -> F32 => f32x4_convert_i32x4(a);
        fn as_f32(a) -> F32 => a;
        fn permute(a, index: U32) => permute(a, index);
    }

    /// 4 f64.
    F64(v128, v128): F64Lanes {
        impl Add: add(a, b) => f64x2_add(a, b);
        impl Sub: sub(a, b) => f64x2_sub(a, b);
        impl Mul: mul(a, b) => f64x2_mul(a, b);
        fn store(a, to: [f64]) => v128_store(to.cast(), a);
        fn min(a, b) => f64x2_pmin(b, a);
        fn max(a, b) => f64x2_pmax(b, a);
        fn floor(a) => f64x2_floor(a);
        fn narrow(low, high) -> F32 => demote(low, high);
        fn words(low, high) => (i32x4_shuffle::<0, 2, 4, 6>(low, high), i32x4_shuffle::<1, 3, 5, 7>(low, high));
    }

    /// 4 truth values, each all ones or all zeros.
    Mask(v128): MaskLanes {
        impl BitAnd: bitand(a, b) => v128_and(a, b);
        impl BitOr: bitor(a, b) => v128_or(a, b);
        impl Not: not(a) => v128_not(a);
        fn to_bits(a) -> u32 => u32::from(i32x4_bitmask(a));
    }
}

/// `a * b + c`, rounded once.
#[inline(always)]
fn fused(a: v128, b: v128, c: v128) -> v128 {
    let low = f64x2_promote_low_f32x4;
    let sum = fma_to_odd(low(a), low(b), low(c));
    demote(sum, fma_to_odd(promote_high(a), promote_high(b), promote_high(c)))
}

/// `a * b + c` of f32 widened to f64, rounded to odd. Rounded to f32, it is the fused multiply-add (see
/// [`crate::fma`]).
#[inline(always)]
fn fma_to_odd(a: v128, b: v128, c: v128) -> v128 {
    let zero = f64x2_splat(0.0);
    let product = f64x2_mul(a, b);
    let sum = f64x2_add(product, c);
    let back = f64x2_sub(sum, product);
    let error = f64x2_add(f64x2_sub(product, f64x2_sub(sum, back)), f64x2_sub(c, back));
    let below = f64x2_lt(error, zero);
    let inexact = v128_or(below, f64x2_gt(error, zero));
    let away = v128_not(v128_xor(below, f64x2_gt(sum, zero)));
    let even = i64x2_eq(v128_and(sum, i64x2_splat(1)), i64x2_splat(0));
    let step = v128_bitselect(i64x2_splat(-1), i64x2_splat(1), away);
    i64x2_add(sum, v128_and(step, v128_and(inexact, even)))
}

/// The upper two f32 as f64.
#[inline(always)]
fn promote_high(a: v128) -> v128 {
    f64x2_promote_low_f32x4(i32x4_shuffle::<2, 3, 2, 3>(a, a))
}

/// Four f64 rounded to f32.
#[inline(always)]
fn demote(low: v128, high: v128) -> v128 {
    i32x4_shuffle::<0, 1, 4, 5>(f32x4_demote_f64x2_zero(low), f32x4_demote_f64x2_zero(high))
}

/// The byte indices of word `index` of a table: 4 * index in every byte, plus 0 to 3.
#[inline(always)]
fn byte_numbers(index: v128) -> v128 {
    i32x4_add(i32x4_mul(index, u32x4_splat(0x0404_0404)), u32x4_splat(0x0302_0100))
}

/// The bytes with these indices in a table of several registers. An index beyond a register gives 0.
#[inline(always)]
fn look_up<const N: usize>(table: [v128; N], mut numbers: v128) -> v128 {
    let mut found = u32x4_splat(0);
    for register in table {
        found = v128_or(found, u8x16_swizzle(register, numbers));
        numbers = u8x16_sub(numbers, u8x16_splat(16));
    }
    found
}

/// The lanes with these indices. Only the lower bits of an index are used.
#[inline(always)]
fn permute(a: v128, index: v128) -> v128 {
    u8x16_swizzle(a, byte_numbers(v128_and(index, u32x4_splat(3))))
}
