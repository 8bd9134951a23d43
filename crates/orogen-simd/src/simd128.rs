//! WebAssembly's 128-bit vectors: 4 lanes in one register, f64 in two. A module is built with them or without
//! (`-C target-feature=+simd128`), so the token needs no check. They have no fused multiply-add with defined rounding: it
//! is emulated with f64, as at the scalar level.

use crate::{Body, F32Lanes, F64Lanes, Level, MaskLanes, Simd, U32Lanes};
use core::arch::wasm32::*;
use std::ops::{Add, BitAnd, BitOr, BitXor, Div, Mul, Neg, Not, Sub};

/// The token of WebAssembly's vectors.
#[derive(Clone, Copy, Debug, Default)]
pub struct Simd128(());

/// 4 f32.
#[derive(Clone, Copy, Debug)]
pub struct F32x4(v128);
/// 4 u32.
#[derive(Clone, Copy, Debug)]
pub struct U32x4(v128);
/// 4 f64.
#[derive(Clone, Copy, Debug)]
pub struct F64x4(v128, v128);
/// 4 truth values, each all ones or all zeros.
#[derive(Clone, Copy, Debug)]
pub struct Mask4(v128);
/// 8 f32, as bytes to look up.
#[derive(Clone, Copy, Debug)]
pub struct Table8x128([v128; 2]);
/// 16 f32, as bytes to look up.
#[derive(Clone, Copy, Debug)]
pub struct Table16x128([v128; 4]);

impl Simd128 {
    /// The token.
    #[inline(always)]
    #[must_use]
    pub const fn new() -> Simd128 {
        Simd128(())
    }
}

macro_rules! lanewise {
    ($type:ident: $($trait:ident $method:ident $op:ident;)*) => {$(
        impl $trait for $type {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                $type($op(self.0, other.0))
            }
        }
    )*};
}
lanewise!(F32x4: Add add f32x4_add; Sub sub f32x4_sub; Mul mul f32x4_mul; Div div f32x4_div;);
lanewise!(U32x4: Add add i32x4_add; Sub sub i32x4_sub; Mul mul i32x4_mul;
    BitAnd bitand v128_and; BitOr bitor v128_or; BitXor bitxor v128_xor;);
lanewise!(Mask4: BitAnd bitand v128_and; BitOr bitor v128_or;);

macro_rules! lanewise_f64 {
    ($($trait:ident $method:ident $op:ident;)*) => {$(
        impl $trait for F64x4 {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                F64x4($op(self.0, other.0), $op(self.1, other.1))
            }
        }
    )*};
}
lanewise_f64!(Add add f64x2_add; Sub sub f64x2_sub; Mul mul f64x2_mul;);

impl Neg for F32x4 {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        F32x4(f32x4_neg(self.0))
    }
}
impl Not for U32x4 {
    type Output = Self;
    #[inline(always)]
    fn not(self) -> Self {
        U32x4(v128_not(self.0))
    }
}
impl Not for Mask4 {
    type Output = Self;
    #[inline(always)]
    fn not(self) -> Self {
        Mask4(v128_not(self.0))
    }
}

/// `a * b + c` of f32 widened to f64, rounded to odd: rounded to f32 it is the fused multiply-add (see [`crate::fma`]).
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

impl Simd for Simd128 {
    type F32 = F32x4;
    type U32 = U32x4;
    type F64 = F64x4;
    type Mask = Mask4;
    type Table8 = Table8x128;
    type Table16 = Table16x128;
    const LANES: usize = 4;
    const LEVEL: Level = Level::Simd128;
    const WIDE_LOOKUP: bool = false;

    #[inline(always)]
    fn run<B: Body>(self, body: B) -> B::Output {
        #[inline(never)]
        fn inner<B: Body>(token: Simd128, body: B) -> B::Output {
            body.run(token)
        }
        inner(self, body)
    }
    #[inline(always)]
    fn f32(self, value: f32) -> F32x4 {
        F32x4(f32x4_splat(value))
    }
    #[inline(always)]
    fn u32(self, value: u32) -> U32x4 {
        U32x4(u32x4_splat(value))
    }
    #[inline(always)]
    fn f64(self, value: f64) -> F64x4 {
        F64x4(f64x2_splat(value), f64x2_splat(value))
    }
    #[inline(always)]
    fn iota(self) -> U32x4 {
        U32x4(u32x4(0, 1, 2, 3))
    }
    #[inline(always)]
    fn load(self, from: &[f32]) -> F32x4 {
        let from = &from[..4];
        // SAFETY: the slice has four values; the instruction takes any alignment.
        F32x4(unsafe { v128_load(from.as_ptr().cast()) })
    }
    #[inline(always)]
    fn load_u32(self, from: &[u32]) -> U32x4 {
        let from = &from[..4];
        // SAFETY: as above.
        U32x4(unsafe { v128_load(from.as_ptr().cast()) })
    }
    #[inline(always)]
    fn load_f64(self, from: &[f64]) -> F64x4 {
        let from = &from[..4];
        // SAFETY: as above, two values each.
        unsafe { F64x4(v128_load(from.as_ptr().cast()), v128_load(from[2..].as_ptr().cast())) }
    }
    #[inline(always)]
    fn table8(self, entries: &[f32; 8]) -> Table8x128 {
        Table8x128([self.load(entries).0, self.load(&entries[4..]).0])
    }
    #[inline(always)]
    fn table16(self, entries: &[f32; 16]) -> Table16x128 {
        Table16x128([0, 4, 8, 12].map(|first| self.load(&entries[first..]).0))
    }
    #[inline(always)]
    fn lookup8(self, table: Table8x128, index: U32x4) -> F32x4 {
        F32x4(look_up(table.0, byte_numbers(v128_and(index.0, u32x4_splat(7)))))
    }
    #[inline(always)]
    fn lookup16(self, table: Table16x128, index: U32x4) -> F32x4 {
        F32x4(look_up(table.0, byte_numbers(v128_and(index.0, u32x4_splat(15)))))
    }
}

impl F32Lanes<Simd128> for F32x4 {
    #[inline(always)]
    fn store(self, to: &mut [f32]) {
        let to = &mut to[..4];
        // SAFETY: the slice has room for four values; the instruction takes any alignment.
        unsafe { v128_store(to.as_mut_ptr().cast(), self.0) }
    }
    #[inline(always)]
    fn mul_add(self, factor: Self, term: Self) -> Self {
        let low = f64x2_promote_low_f32x4;
        let sum = [
            fma_to_odd(low(self.0), low(factor.0), low(term.0)),
            fma_to_odd(promote_high(self.0), promote_high(factor.0), promote_high(term.0)),
        ];
        F32x4(demote(sum[0], sum[1]))
    }
    #[inline(always)]
    fn neg_mul_add(self, factor: Self, term: Self) -> Self {
        (-self).mul_add(factor, term)
    }
    #[inline(always)]
    fn min(self, other: Self) -> Self {
        F32x4(f32x4_pmin(other.0, self.0))
    }
    #[inline(always)]
    fn max(self, other: Self) -> Self {
        F32x4(f32x4_pmax(other.0, self.0))
    }
    #[inline(always)]
    fn abs(self) -> Self {
        F32x4(f32x4_abs(self.0))
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        F32x4(f32x4_sqrt(self.0))
    }
    #[inline(always)]
    fn floor(self) -> Self {
        F32x4(f32x4_floor(self.0))
    }
    #[inline(always)]
    fn lt(self, other: Self) -> Mask4 {
        Mask4(f32x4_lt(self.0, other.0))
    }
    #[inline(always)]
    fn le(self, other: Self) -> Mask4 {
        Mask4(f32x4_le(self.0, other.0))
    }
    #[inline(always)]
    fn eq(self, other: Self) -> Mask4 {
        Mask4(f32x4_eq(self.0, other.0))
    }
    #[inline(always)]
    fn select(self, mask: Mask4, other: Self) -> Self {
        F32x4(v128_bitselect(self.0, other.0, mask.0))
    }
    #[inline(always)]
    fn to_i32(self) -> U32x4 {
        // The instruction saturates; values out of range and NaN must give the lowest number.
        let fits =
            v128_and(f32x4_ge(self.0, f32x4_splat(-2_147_483_648.0)), f32x4_lt(self.0, f32x4_splat(2_147_483_648.0)));
        U32x4(v128_bitselect(i32x4_trunc_sat_f32x4(self.0), u32x4_splat(0x8000_0000), fits))
    }
    #[inline(always)]
    fn bits(self) -> U32x4 {
        U32x4(self.0)
    }
    #[inline(always)]
    fn widen(self) -> F64x4 {
        F64x4(f64x2_promote_low_f32x4(self.0), promote_high(self.0))
    }
    #[inline(always)]
    fn permute(self, index: U32x4) -> Self {
        F32x4(u8x16_swizzle(self.0, byte_numbers(v128_and(index.0, u32x4_splat(3)))))
    }
}

impl U32Lanes<Simd128> for U32x4 {
    #[inline(always)]
    fn store(self, to: &mut [u32]) {
        let to = &mut to[..4];
        // SAFETY: as for f32.
        unsafe { v128_store(to.as_mut_ptr().cast(), self.0) }
    }
    #[inline(always)]
    fn shl(self, count: u32) -> Self {
        U32x4(u32x4_shl(self.0, count & 31))
    }
    #[inline(always)]
    fn shr(self, count: u32) -> Self {
        U32x4(u32x4_shr(self.0, count & 31))
    }
    #[inline(always)]
    fn sar(self, count: u32) -> Self {
        U32x4(i32x4_shr(self.0, count & 31))
    }
    #[inline(always)]
    fn eq(self, other: Self) -> Mask4 {
        Mask4(i32x4_eq(self.0, other.0))
    }
    #[inline(always)]
    fn lt_i32(self, other: Self) -> Mask4 {
        Mask4(i32x4_lt(self.0, other.0))
    }
    #[inline(always)]
    fn select(self, mask: Mask4, other: Self) -> Self {
        U32x4(v128_bitselect(self.0, other.0, mask.0))
    }
    #[inline(always)]
    fn i32_to_f32(self) -> F32x4 {
        F32x4(f32x4_convert_i32x4(self.0))
    }
    #[inline(always)]
    fn as_f32(self) -> F32x4 {
        F32x4(self.0)
    }
    #[inline(always)]
    fn permute(self, index: Self) -> Self {
        self.as_f32().permute(index).bits()
    }
}

impl F64Lanes<Simd128> for F64x4 {
    #[inline(always)]
    fn store(self, to: &mut [f64]) {
        let to = &mut to[..4];
        // SAFETY: as for f32, two values each.
        unsafe {
            v128_store(to.as_mut_ptr().cast(), self.0);
            v128_store(to[2..].as_mut_ptr().cast(), self.1);
        }
    }
    #[inline(always)]
    fn min(self, other: Self) -> Self {
        F64x4(f64x2_pmin(other.0, self.0), f64x2_pmin(other.1, self.1))
    }
    #[inline(always)]
    fn max(self, other: Self) -> Self {
        F64x4(f64x2_pmax(other.0, self.0), f64x2_pmax(other.1, self.1))
    }
    #[inline(always)]
    fn floor(self) -> Self {
        F64x4(f64x2_floor(self.0), f64x2_floor(self.1))
    }
    #[inline(always)]
    fn narrow(self) -> F32x4 {
        F32x4(demote(self.0, self.1))
    }
    #[inline(always)]
    fn words(self) -> (U32x4, U32x4) {
        let (a, b) = (self.0, self.1);
        (U32x4(i32x4_shuffle::<0, 2, 4, 6>(a, b)), U32x4(i32x4_shuffle::<1, 3, 5, 7>(a, b)))
    }
}

impl MaskLanes for Mask4 {
    const LANES: usize = 4;
    #[inline(always)]
    fn to_bits(self) -> u32 {
        u32::from(i32x4_bitmask(self.0))
    }
}
