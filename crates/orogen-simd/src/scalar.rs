//! The level that every machine supports: lanes emulated with arrays of 4, 8 or 16, so that tests can emulate any
//! register.

use crate::fma::{floor32, floor64, fma, to_i32};
use crate::{Body, F32Lanes, F64Lanes, Level, MaskLanes, Simd, U32Lanes};
use std::array::from_fn;
use std::ops::{Add, BitAnd, BitOr, BitXor, Div, Mul, Neg, Not, Sub};

/// The token of the emulated level with `N` lanes. It needs no check. `N` is 4, 8 or 16.
#[derive(Clone, Copy, Debug, Default)]
pub struct Scalar<const N: usize>;

/// `N` f32 in an array.
#[derive(Clone, Copy, Debug)]
pub struct ScalarF32<const N: usize>([f32; N]);
/// `N` u32 in an array.
#[derive(Clone, Copy, Debug)]
pub struct ScalarU32<const N: usize>([u32; N]);
/// `N` f64 in an array.
#[derive(Clone, Copy, Debug)]
pub struct ScalarF64<const N: usize>([f64; N]);
/// `N` truth values in an array.
#[derive(Clone, Copy, Debug)]
pub struct ScalarMask<const N: usize>([bool; N]);

/// Methods that work lane by lane. `self` and the other parameters stand for their values in one lane.
macro_rules! by_lane {
    ($(fn $name:ident $lanes:tt -> $result:ident => $value:expr;)*) => {$(
        by_lane!(@fn $name $lanes $result $value);
    )*};
    (@fn $name:ident($a:ident) $result:ident $value:expr) => {
        #[inline]
        fn $name(self) -> $result<N> {
            $result(self.0.map(|$a| $value))
        }
    };
    (@fn $name:ident($a:ident $(, $b:ident: $type:ty)+) $result:ident $value:expr) => {
        #[inline]
        fn $name(self $(, $b: $type)+) -> $result<N> {
            $result(from_fn(|i| {
                let $a = self.0[i];
                $(let $b = $b.0[i];)+
                $value
            }))
        }
    };
}
macro_rules! operators {
    ($type:ident: $($trait:ident $method:ident($a:ident $(, $b:ident)?) => $value:expr;)*) => {$(
        impl<const N: usize> $trait for $type<N> {
            type Output = Self;
            by_lane!(fn $method($a $(, $b: Self)?) -> $type => $value;);
        }
    )*};
}
operators! { ScalarF32:
    Add add(a, b) => a + b;
    Sub sub(a, b) => a - b;
    Mul mul(a, b) => a * b;
    Div div(a, b) => a / b;
    Neg neg(a) => -a;
}
operators! { ScalarF64:
    Add add(a, b) => a + b;
    Sub sub(a, b) => a - b;
    Mul mul(a, b) => a * b;
}
operators! { ScalarU32:
    Add add(a, b) => a.wrapping_add(b);
    Sub sub(a, b) => a.wrapping_sub(b);
    Mul mul(a, b) => a.wrapping_mul(b);
    BitAnd bitand(a, b) => a & b;
    BitOr bitor(a, b) => a | b;
    BitXor bitxor(a, b) => a ^ b;
    Not not(a) => !a;
}
operators! { ScalarMask:
    BitAnd bitand(a, b) => a & b;
    BitOr bitor(a, b) => a | b;
    Not not(a) => !a;
}

impl<const N: usize> Simd for Scalar<N> {
    type F32 = ScalarF32<N>;
    type U32 = ScalarU32<N>;
    type F64 = ScalarF64<N>;
    type Mask = ScalarMask<N>;
    type Table8 = [f32; 8];
    type Table16 = [f32; 16];
    const LANES: usize = N;
    const LEVEL: Level = Level::Scalar;
    const WIDE_LOOKUP: bool = true;

    #[inline]
    fn run<B: Body>(self, body: B) -> B::Output {
        #[inline(never)]
        fn inner<const N: usize, B: Body>(token: Scalar<N>, body: B) -> B::Output {
            body.run(token)
        }
        inner(self, body)
    }
    #[inline]
    fn f32(self, value: f32) -> Self::F32 {
        ScalarF32([value; N])
    }
    #[inline]
    fn u32(self, value: u32) -> Self::U32 {
        ScalarU32([value; N])
    }
    #[inline]
    fn f64(self, value: f64) -> Self::F64 {
        ScalarF64([value; N])
    }
    #[inline]
    fn iota(self) -> Self::U32 {
        ScalarU32(from_fn(|i| i as u32))
    }
    #[inline]
    fn load(self, from: &[f32]) -> Self::F32 {
        let from = &from[..N];
        ScalarF32(from_fn(|i| from[i]))
    }
    #[inline]
    fn load_u32(self, from: &[u32]) -> Self::U32 {
        let from = &from[..N];
        ScalarU32(from_fn(|i| from[i]))
    }
    #[inline]
    fn load_f64(self, from: &[f64]) -> Self::F64 {
        let from = &from[..N];
        ScalarF64(from_fn(|i| from[i]))
    }
    #[inline]
    fn table8(self, entries: &[f32; 8]) -> Self::Table8 {
        *entries
    }
    #[inline]
    fn table16(self, entries: &[f32; 16]) -> Self::Table16 {
        *entries
    }
    #[inline]
    fn lookup8(self, table: Self::Table8, index: Self::U32) -> Self::F32 {
        ScalarF32(from_fn(|i| table[(index.0[i] & 7) as usize]))
    }
    #[inline]
    fn lookup16(self, table: Self::Table16, index: Self::U32) -> Self::F32 {
        ScalarF32(from_fn(|i| table[(index.0[i] & 15) as usize]))
    }
    #[inline]
    fn gather(self, from: &[f32], index: Self::U32) -> Self::F32 {
        ScalarF32(from_fn(|i| clamped(from, index.0[i])))
    }
    #[inline]
    fn gather_u32(self, from: &[u32], index: Self::U32) -> Self::U32 {
        ScalarU32(from_fn(|i| clamped(from, index.0[i])))
    }
}

// Unlike the operations of the other levels, these are inlined at the compiler's discretion, because unrolled arrays
// are long. The long operations are separate functions: eight copies of each in every body would make the code of this
// level by far the largest.

#[inline(never)]
fn fma_lanes<const N: usize>(a: &[f32; N], b: &[f32; N], c: &mut [f32; N]) {
    for i in 0..N {
        c[i] = fma(a[i], b[i], c[i]);
    }
}

#[inline(never)]
fn each<T: Copy, const N: usize>(lanes: &[T; N], f: impl Fn(T) -> T) -> [T; N] {
    lanes.map(f)
}

#[inline]
fn clamped<T: Copy + Default>(from: &[T], index: u32) -> T {
    from.get(index as usize).or(from.last()).copied().unwrap_or_default()
}

impl<const N: usize> F32Lanes<Scalar<N>> for ScalarF32<N> {
    by_lane! {
        fn min(a, b: Self) -> ScalarF32 => if a < b { a } else { b };
        fn max(a, b: Self) -> ScalarF32 => if a > b { a } else { b };
        fn abs(a) -> ScalarF32 => a.abs();
        fn sqrt(a) -> ScalarF32 => a.sqrt();
        fn lt(a, b: Self) -> ScalarMask => a < b;
        fn le(a, b: Self) -> ScalarMask => a <= b;
        fn eq(a, b: Self) -> ScalarMask => a == b;
        fn select(a, mask: ScalarMask<N>, b: Self) -> ScalarF32 => if mask { a } else { b };
        fn to_i32(a) -> ScalarU32 => to_i32(a) as u32;
        fn bits(a) -> ScalarU32 => a.to_bits();
        fn widen(a) -> ScalarF64 => f64::from(a);
    }
    #[inline]
    fn store(self, to: &mut [f32]) {
        to[..N].copy_from_slice(&self.0);
    }
    #[inline]
    fn mul_add(self, factor: Self, term: Self) -> Self {
        let mut sum = term;
        fma_lanes(&self.0, &factor.0, &mut sum.0);
        sum
    }
    #[inline]
    fn neg_mul_add(self, factor: Self, term: Self) -> Self {
        (-self).mul_add(factor, term)
    }
    #[inline]
    fn floor(self) -> Self {
        ScalarF32(each(&self.0, floor32))
    }
    #[inline]
    fn permute(self, index: ScalarU32<N>) -> Self {
        ScalarF32(from_fn(|i| self.0[index.0[i] as usize % N]))
    }
}

impl<const N: usize> U32Lanes<Scalar<N>> for ScalarU32<N> {
    by_lane! {
        fn eq(a, b: Self) -> ScalarMask => a == b;
        fn lt_i32(a, b: Self) -> ScalarMask => (a as i32) < b as i32;
        fn select(a, mask: ScalarMask<N>, b: Self) -> ScalarU32 => if mask { a } else { b };
        fn i32_to_f32(a) -> ScalarF32 => a as i32 as f32;
        fn as_f32(a) -> ScalarF32 => f32::from_bits(a);
    }
    #[inline]
    fn store(self, to: &mut [u32]) {
        to[..N].copy_from_slice(&self.0);
    }
    #[inline]
    fn shl(self, count: u32) -> Self {
        ScalarU32(self.0.map(|a| a << (count & 31)))
    }
    #[inline]
    fn shr(self, count: u32) -> Self {
        ScalarU32(self.0.map(|a| a >> (count & 31)))
    }
    #[inline]
    fn sar(self, count: u32) -> Self {
        ScalarU32(self.0.map(|a| ((a as i32) >> (count & 31)) as u32))
    }
    #[inline]
    fn permute(self, index: Self) -> Self {
        ScalarU32(from_fn(|i| self.0[index.0[i] as usize % N]))
    }
}

impl<const N: usize> F64Lanes<Scalar<N>> for ScalarF64<N> {
    by_lane! {
        fn min(a, b: Self) -> ScalarF64 => if a < b { a } else { b };
        fn max(a, b: Self) -> ScalarF64 => if a > b { a } else { b };
        fn narrow(a) -> ScalarF32 => a as f32;
    }
    #[inline]
    fn store(self, to: &mut [f64]) {
        to[..N].copy_from_slice(&self.0);
    }
    #[inline]
    fn floor(self) -> Self {
        ScalarF64(each(&self.0, floor64))
    }
    #[inline]
    fn words(self) -> (ScalarU32<N>, ScalarU32<N>) {
        (ScalarU32(self.0.map(|x| x.to_bits() as u32)), ScalarU32(self.0.map(|x| (x.to_bits() >> 32) as u32)))
    }
}

impl<const N: usize> MaskLanes for ScalarMask<N> {
    const LANES: usize = N;
    #[inline]
    fn to_bits(self) -> u32 {
        self.0.iter().enumerate().fold(0, |bits, (i, &lane)| bits | (u32::from(lane) << i))
    }
}
