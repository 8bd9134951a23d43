//! The level of every machine: lanes emulated with arrays, 4, 8 or 16 wide so that tests can emulate any register.

use crate::fma::{floor32, floor64, fma, to_i32};
use crate::{Body, F32Lanes, F64Lanes, Level, MaskLanes, Simd, U32Lanes};
use std::array::from_fn;
use std::ops::{Add, BitAnd, BitOr, BitXor, Div, Mul, Neg, Not, Sub};

/// The token of the emulated level with `N` lanes; anyone may make one. `N` is 4, 8 or 16.
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

macro_rules! lanewise {
    ($type:ident: $($trait:ident $method:ident $f:expr;)*) => {$(
        impl<const N: usize> $trait for $type<N> {
            type Output = Self;
            #[inline]
            fn $method(self, other: Self) -> Self {
                $type(from_fn(|i| $f(self.0[i], other.0[i])))
            }
        }
    )*};
}
lanewise!(ScalarF32: Add add |a, b| a + b; Sub sub |a, b| a - b; Mul mul |a, b| a * b; Div div |a, b| a / b;);
lanewise!(ScalarF64: Add add |a, b| a + b; Sub sub |a, b| a - b; Mul mul |a, b| a * b;);
lanewise!(ScalarU32: Add add u32::wrapping_add; Sub sub u32::wrapping_sub; Mul mul u32::wrapping_mul;
    BitAnd bitand |a, b| a & b; BitOr bitor |a, b| a | b; BitXor bitxor |a, b| a ^ b;);
lanewise!(ScalarMask: BitAnd bitand |a, b| a & b; BitOr bitor |a, b| a | b;);

impl<const N: usize> Neg for ScalarF32<N> {
    type Output = Self;
    #[inline]
    fn neg(self) -> Self {
        ScalarF32(self.0.map(|a| -a))
    }
}
impl<const N: usize> Not for ScalarU32<N> {
    type Output = Self;
    #[inline]
    fn not(self) -> Self {
        ScalarU32(self.0.map(|a| !a))
    }
}
impl<const N: usize> Not for ScalarMask<N> {
    type Output = Self;
    #[inline]
    fn not(self) -> Self {
        ScalarMask(self.0.map(|a| !a))
    }
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

// Unlike the other levels' operations, these are inlined at the compiler's discretion, because unrolled arrays are long.
// The long operations are separate functions: eight copies of each in every body would make the code of this level by far
// the largest.

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
    fn min(self, other: Self) -> Self {
        ScalarF32(from_fn(|i| if self.0[i] < other.0[i] { self.0[i] } else { other.0[i] }))
    }
    #[inline]
    fn max(self, other: Self) -> Self {
        ScalarF32(from_fn(|i| if self.0[i] > other.0[i] { self.0[i] } else { other.0[i] }))
    }
    #[inline]
    fn abs(self) -> Self {
        ScalarF32(self.0.map(f32::abs))
    }
    #[inline]
    fn sqrt(self) -> Self {
        ScalarF32(self.0.map(f32::sqrt))
    }
    #[inline]
    fn floor(self) -> Self {
        ScalarF32(each(&self.0, floor32))
    }
    #[inline]
    fn lt(self, other: Self) -> ScalarMask<N> {
        ScalarMask(from_fn(|i| self.0[i] < other.0[i]))
    }
    #[inline]
    fn le(self, other: Self) -> ScalarMask<N> {
        ScalarMask(from_fn(|i| self.0[i] <= other.0[i]))
    }
    #[inline]
    fn eq(self, other: Self) -> ScalarMask<N> {
        ScalarMask(from_fn(|i| self.0[i] == other.0[i]))
    }
    #[inline]
    fn select(self, mask: ScalarMask<N>, other: Self) -> Self {
        ScalarF32(from_fn(|i| if mask.0[i] { self.0[i] } else { other.0[i] }))
    }
    #[inline]
    fn to_i32(self) -> ScalarU32<N> {
        ScalarU32(self.0.map(|x| to_i32(x) as u32))
    }
    #[inline]
    fn bits(self) -> ScalarU32<N> {
        ScalarU32(self.0.map(f32::to_bits))
    }
    #[inline]
    fn widen(self) -> ScalarF64<N> {
        ScalarF64(self.0.map(f64::from))
    }
    #[inline]
    fn permute(self, index: ScalarU32<N>) -> Self {
        ScalarF32(from_fn(|i| self.0[index.0[i] as usize % N]))
    }
}

impl<const N: usize> U32Lanes<Scalar<N>> for ScalarU32<N> {
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
    fn eq(self, other: Self) -> ScalarMask<N> {
        ScalarMask(from_fn(|i| self.0[i] == other.0[i]))
    }
    #[inline]
    fn lt_i32(self, other: Self) -> ScalarMask<N> {
        ScalarMask(from_fn(|i| (self.0[i] as i32) < other.0[i] as i32))
    }
    #[inline]
    fn select(self, mask: ScalarMask<N>, other: Self) -> Self {
        ScalarU32(from_fn(|i| if mask.0[i] { self.0[i] } else { other.0[i] }))
    }
    #[inline]
    fn i32_to_f32(self) -> ScalarF32<N> {
        ScalarF32(self.0.map(|a| a as i32 as f32))
    }
    #[inline]
    fn as_f32(self) -> ScalarF32<N> {
        ScalarF32(self.0.map(f32::from_bits))
    }
    #[inline]
    fn permute(self, index: Self) -> Self {
        ScalarU32(from_fn(|i| self.0[index.0[i] as usize % N]))
    }
}

impl<const N: usize> F64Lanes<Scalar<N>> for ScalarF64<N> {
    #[inline]
    fn store(self, to: &mut [f64]) {
        to[..N].copy_from_slice(&self.0);
    }
    #[inline]
    fn min(self, other: Self) -> Self {
        ScalarF64(from_fn(|i| if self.0[i] < other.0[i] { self.0[i] } else { other.0[i] }))
    }
    #[inline]
    fn max(self, other: Self) -> Self {
        ScalarF64(from_fn(|i| if self.0[i] > other.0[i] { self.0[i] } else { other.0[i] }))
    }
    #[inline]
    fn floor(self) -> Self {
        ScalarF64(each(&self.0, floor64))
    }
    #[inline]
    fn narrow(self) -> ScalarF32<N> {
        ScalarF32(self.0.map(|x| x as f32))
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
