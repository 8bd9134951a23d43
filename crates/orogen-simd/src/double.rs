//! Two registers of a level together: while one waits for a result, the processor works on the other one.

use crate::{Body, F32Lanes, F64Lanes, Level, MaskLanes, Simd, U32Lanes};
use std::ops::{Add, BitAnd, BitOr, BitXor, Div, Mul, Neg, Not, Sub};

/// The token of a level whose lanes are pairs of registers, for bodies that are long chains of dependent instructions.
/// At most 16 lanes can be doubled.
#[derive(Clone, Copy, Debug)]
pub struct Double<S>(pub S);

/// Two values of the same type.
#[derive(Clone, Copy, Debug)]
pub struct Pair<T>(T, T);

macro_rules! both {
    ($($trait:ident $method:ident;)*) => {$(
        impl<T: $trait<Output = T>> $trait for Pair<T> {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                Pair(self.0.$method(other.0), self.1.$method(other.1))
            }
        }
    )*};
}
both!(Add add; Sub sub; Mul mul; Div div; BitAnd bitand; BitOr bitor; BitXor bitxor;);

impl<T: Neg<Output = T>> Neg for Pair<T> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Pair(-self.0, -self.1)
    }
}
impl<T: Not<Output = T>> Not for Pair<T> {
    type Output = Self;
    #[inline(always)]
    fn not(self) -> Self {
        Pair(!self.0, !self.1)
    }
}

/// A body that runs with pairs.
struct Paired<B>(B);

impl<B: Body> Body for Paired<B> {
    type Output = B::Output;
    #[inline(always)]
    fn run<S: Simd>(self, simd: S) -> B::Output {
        self.0.run(Double(simd))
    }
}

impl<S: Simd> Simd for Double<S> {
    type F32 = Pair<S::F32>;
    type U32 = Pair<S::U32>;
    type F64 = Pair<S::F64>;
    type Mask = Pair<S::Mask>;
    type Table8 = S::Table8;
    type Table16 = S::Table16;
    const LANES: usize = 2 * S::LANES;
    const LEVEL: Level = S::LEVEL;
    const WIDE_LOOKUP: bool = S::WIDE_LOOKUP;

    #[inline(always)]
    fn run<B: Body>(self, body: B) -> B::Output {
        self.0.run(Paired(body))
    }
    #[inline(always)]
    fn f32(self, value: f32) -> Self::F32 {
        Pair(self.0.f32(value), self.0.f32(value))
    }
    #[inline(always)]
    fn u32(self, value: u32) -> Self::U32 {
        Pair(self.0.u32(value), self.0.u32(value))
    }
    #[inline(always)]
    fn f64(self, value: f64) -> Self::F64 {
        Pair(self.0.f64(value), self.0.f64(value))
    }
    #[inline(always)]
    fn iota(self) -> Self::U32 {
        Pair(self.0.iota(), self.0.iota() + self.0.u32(S::LANES as u32))
    }
    #[inline(always)]
    fn load(self, from: &[f32]) -> Self::F32 {
        let from = &from[..Self::LANES];
        Pair(self.0.load(from), self.0.load(&from[S::LANES..]))
    }
    #[inline(always)]
    fn load_u32(self, from: &[u32]) -> Self::U32 {
        let from = &from[..Self::LANES];
        Pair(self.0.load_u32(from), self.0.load_u32(&from[S::LANES..]))
    }
    #[inline(always)]
    fn load_f64(self, from: &[f64]) -> Self::F64 {
        let from = &from[..Self::LANES];
        Pair(self.0.load_f64(from), self.0.load_f64(&from[S::LANES..]))
    }
    #[inline(always)]
    fn table8(self, entries: &[f32; 8]) -> S::Table8 {
        self.0.table8(entries)
    }
    #[inline(always)]
    fn table16(self, entries: &[f32; 16]) -> S::Table16 {
        self.0.table16(entries)
    }
    #[inline(always)]
    fn lookup8(self, table: S::Table8, index: Self::U32) -> Self::F32 {
        Pair(self.0.lookup8(table, index.0), self.0.lookup8(table, index.1))
    }
    #[inline(always)]
    fn lookup16(self, table: S::Table16, index: Self::U32) -> Self::F32 {
        Pair(self.0.lookup16(table, index.0), self.0.lookup16(table, index.1))
    }
    #[inline(always)]
    fn whole(self, number: Self::F64) -> (Self::F64, Self::U32, Self::U32) {
        let ((whole, low, high), other) = (self.0.whole(number.0), self.0.whole(number.1));
        (Pair(whole, other.0), Pair(low, other.1), Pair(high, other.2))
    }
    #[inline(always)]
    fn place(self, number: Self::F64, from: f64, count: u32) -> (Self::F64, Self::U32, Self::U32) {
        let ((whole, place, elsewhere), other) =
            (self.0.place(number.0, from, count), self.0.place(number.1, from, count));
        (Pair(whole, other.0), Pair(place, other.1), Pair(elsewhere, other.2))
    }
    #[inline(always)]
    fn gather(self, from: &[f32], index: Self::U32) -> Self::F32 {
        Pair(self.0.gather(from, index.0), self.0.gather(from, index.1))
    }
    #[inline(always)]
    fn gather_u32(self, from: &[u32], index: Self::U32) -> Self::U32 {
        Pair(self.0.gather_u32(from, index.0), self.0.gather_u32(from, index.1))
    }
}

/// Methods that do the same for both halves.
macro_rules! in_halves {
    ($(fn $name:ident($($other:ident: $type:ty),*) -> $result:ty;)*) => {$(
        #[inline(always)]
        fn $name(self $(, $other: $type)*) -> $result {
            Pair(self.0.$name($($other.0),*), self.1.$name($($other.1),*))
        }
    )*};
}

/// Lanes from either half, selected by the most significant bit of the index.
#[inline(always)]
fn half<S: Simd>(from: Pair<S::F32>, index: S::U32) -> S::F32 {
    let sign = 31 - S::LANES.trailing_zeros();
    let zero = index.shr(31).shr(1);
    let upper = index.shl(sign).lt_i32(zero);
    from.1.permute(index).select(upper, from.0.permute(index))
}

impl<S: Simd> F32Lanes<Double<S>> for Pair<S::F32> {
    #[inline(always)]
    fn store(self, to: &mut [f32]) {
        let to = &mut to[..2 * S::LANES];
        self.0.store(to);
        self.1.store(&mut to[S::LANES..]);
    }
    in_halves! {
        fn mul_add(factor: Self, term: Self) -> Self;
        fn neg_mul_add(factor: Self, term: Self) -> Self;
        fn min(other: Self) -> Self;
        fn max(other: Self) -> Self;
        fn abs() -> Self;
        fn sqrt() -> Self;
        fn floor() -> Self;
        fn lt(other: Self) -> Pair<S::Mask>;
        fn le(other: Self) -> Pair<S::Mask>;
        fn eq(other: Self) -> Pair<S::Mask>;
        fn select(mask: Pair<S::Mask>, other: Self) -> Self;
        fn to_i32() -> Pair<S::U32>;
        fn bits() -> Pair<S::U32>;
        fn widen() -> Pair<S::F64>;
    }
    #[inline(always)]
    fn permute(self, index: Pair<S::U32>) -> Self {
        Pair(half::<S>(self, index.0), half::<S>(self, index.1))
    }
}

impl<S: Simd> U32Lanes<Double<S>> for Pair<S::U32> {
    #[inline(always)]
    fn store(self, to: &mut [u32]) {
        let to = &mut to[..2 * S::LANES];
        self.0.store(to);
        self.1.store(&mut to[S::LANES..]);
    }
    #[inline(always)]
    fn shl(self, count: u32) -> Self {
        Pair(self.0.shl(count), self.1.shl(count))
    }
    #[inline(always)]
    fn shr(self, count: u32) -> Self {
        Pair(self.0.shr(count), self.1.shr(count))
    }
    #[inline(always)]
    fn sar(self, count: u32) -> Self {
        Pair(self.0.sar(count), self.1.sar(count))
    }
    in_halves! {
        fn eq(other: Self) -> Pair<S::Mask>;
        fn lt_i32(other: Self) -> Pair<S::Mask>;
        fn select(mask: Pair<S::Mask>, other: Self) -> Self;
        fn i32_to_f32() -> Pair<S::F32>;
        fn as_f32() -> Pair<S::F32>;
    }
    #[inline(always)]
    fn permute(self, index: Pair<S::U32>) -> Self {
        let lanes = Pair(self.0.as_f32(), self.1.as_f32());
        Pair(half::<S>(lanes, index.0).bits(), half::<S>(lanes, index.1).bits())
    }
}

impl<S: Simd> F64Lanes<Double<S>> for Pair<S::F64> {
    #[inline(always)]
    fn store(self, to: &mut [f64]) {
        let to = &mut to[..2 * S::LANES];
        self.0.store(to);
        self.1.store(&mut to[S::LANES..]);
    }
    in_halves! {
        fn min(other: Self) -> Self;
        fn max(other: Self) -> Self;
        fn floor() -> Self;
        fn narrow() -> Pair<S::F32>;
    }
    #[inline(always)]
    fn words(self) -> (Pair<S::U32>, Pair<S::U32>) {
        let ((low, high), other) = (self.0.words(), self.1.words());
        (Pair(low, other.0), Pair(high, other.1))
    }
}

impl<M: MaskLanes> MaskLanes for Pair<M> {
    const LANES: usize = 2 * M::LANES;
    #[inline(always)]
    fn to_bits(self) -> u32 {
        self.0.to_bits() | self.1.to_bits() << M::LANES
    }
    #[inline(always)]
    fn any(self) -> bool {
        (self.0 | self.1).any()
    }
}
