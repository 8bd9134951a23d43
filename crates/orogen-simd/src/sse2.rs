//! The scalar level of x86-64, in SSE2 registers, which belong to that target: 4 lanes in one register, f64 in two. Arrays
//! of lanes (see [`crate::Scalar`]) give the same bits, but take longer to compile and to run.
//!
//! SSE2 has no fused multiply-add, no floor and no lookup. They are emulated, each in one function that is not inlined:
//! copies in every body would make the code of the slowest level the largest.

use crate::{Body, F32Lanes, F64Lanes, Level, MaskLanes, Simd, U32Lanes};
use core::arch::x86_64::*;
use std::ops::{Add, BitAnd, BitOr, BitXor, Div, Mul, Neg, Not, Sub};

/// The token of SSE2.
#[derive(Clone, Copy, Debug, Default)]
pub struct Sse2(());

/// 4 f32.
#[derive(Clone, Copy, Debug)]
pub struct F32x4(__m128);
/// 4 u32.
#[derive(Clone, Copy, Debug)]
pub struct U32x4(__m128i);
/// 4 f64.
#[derive(Clone, Copy, Debug)]
pub struct F64x4(__m128d, __m128d);
/// 4 truth values, each all ones or all zeros.
#[derive(Clone, Copy, Debug)]
pub struct Mask4(__m128i);

impl Sse2 {
    /// The token.
    #[inline(always)]
    #[must_use]
    pub const fn new() -> Sse2 {
        Sse2(())
    }
}

/// An expression of intrinsics on values.
macro_rules! sse2 {
    ($expression:expr) => {
        // SAFETY: SSE2 belongs to the x86-64 baseline, so the processor has the instructions. Those that read or write
        // memory stand in blocks of their own.
        unsafe { $expression }
    };
}

macro_rules! lanewise {
    ($type:ident: $($trait:ident $method:ident $op:ident;)*) => {$(
        impl $trait for $type {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                $type(sse2!($op(self.0, other.0)))
            }
        }
    )*};
}
lanewise!(F32x4: Add add _mm_add_ps; Sub sub _mm_sub_ps; Mul mul _mm_mul_ps; Div div _mm_div_ps;);
lanewise!(U32x4: Add add _mm_add_epi32; Sub sub _mm_sub_epi32;
    BitAnd bitand _mm_and_si128; BitOr bitor _mm_or_si128; BitXor bitxor _mm_xor_si128;);
lanewise!(Mask4: BitAnd bitand _mm_and_si128; BitOr bitor _mm_or_si128;);

macro_rules! lanewise_f64 {
    ($($trait:ident $method:ident $op:ident;)*) => {$(
        impl $trait for F64x4 {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                sse2!(F64x4($op(self.0, other.0), $op(self.1, other.1)))
            }
        }
    )*};
}
lanewise_f64!(Add add _mm_add_pd; Sub sub _mm_sub_pd; Mul mul _mm_mul_pd;);

impl Mul for U32x4 {
    type Output = Self;
    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        sse2!({
            // The instruction multiplies the even lanes.
            let (a, b) = (_mm_srli_epi64::<32>(self.0), _mm_srli_epi64::<32>(other.0));
            let even = _mm_shuffle_epi32::<0b10_00>(_mm_mul_epu32(self.0, other.0));
            let odd = _mm_shuffle_epi32::<0b10_00>(_mm_mul_epu32(a, b));
            U32x4(_mm_unpacklo_epi32(even, odd))
        })
    }
}
impl Neg for F32x4 {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        sse2!(F32x4(_mm_xor_ps(self.0, _mm_set1_ps(-0.0))))
    }
}
impl Not for U32x4 {
    type Output = Self;
    #[inline(always)]
    fn not(self) -> Self {
        sse2!(U32x4(_mm_xor_si128(self.0, _mm_set1_epi32(-1))))
    }
}
impl Not for Mask4 {
    type Output = Self;
    #[inline(always)]
    fn not(self) -> Self {
        sse2!(Mask4(_mm_xor_si128(self.0, _mm_set1_epi32(-1))))
    }
}

/// `a` where the mask holds, else `b`.
#[inline(always)]
fn choose(mask: __m128i, a: __m128i, b: __m128i) -> __m128i {
    sse2!(_mm_or_si128(_mm_and_si128(mask, a), _mm_andnot_si128(mask, b)))
}

/// The four lanes.
#[inline(always)]
fn lanes(a: __m128i) -> [u32; 4] {
    let (low, high) = sse2!((_mm_cvtsi128_si64(a) as u64, _mm_cvtsi128_si64(_mm_unpackhi_epi64(a, a)) as u64));
    [low as u32, (low >> 32) as u32, high as u32, (high >> 32) as u32]
}

// The functions that are not inlined have a calling convention that passes vectors in registers; Rust's own passes them in
// memory. They are never called from outside, so that it is no foreign interface.

/// `a * b + c`, rounded once.
#[allow(improper_ctypes_definitions)]
#[inline(never)]
extern "sysv64" fn fused(a: __m128, b: __m128, c: __m128) -> __m128 {
    sse2!({
        let low = fma_to_odd(_mm_cvtps_pd(a), _mm_cvtps_pd(b), _mm_cvtps_pd(c));
        let high = fma_to_odd(widen_high(a), widen_high(b), widen_high(c));
        _mm_movelh_ps(_mm_cvtpd_ps(low), _mm_cvtpd_ps(high))
    })
}

/// `a * b + c` of f32 widened to f64, rounded to odd: rounded to f32 it is the fused multiply-add (see [`crate::fma`]).
#[inline(always)]
fn fma_to_odd(a: __m128d, b: __m128d, c: __m128d) -> __m128d {
    sse2!({
        let zero = _mm_setzero_pd();
        let product = _mm_mul_pd(a, b);
        let sum = _mm_add_pd(product, c);
        let back = _mm_sub_pd(sum, product);
        let error = _mm_add_pd(_mm_sub_pd(product, _mm_sub_pd(sum, back)), _mm_sub_pd(c, back));
        let below = _mm_cmplt_pd(error, zero);
        let inexact = _mm_castpd_si128(_mm_or_pd(below, _mm_cmpgt_pd(error, zero)));
        // All ones where the sum was rounded towards zero: there the step is 1, otherwise -1.
        let towards = _mm_castpd_si128(_mm_xor_pd(below, _mm_cmpgt_pd(sum, zero)));
        let bits = _mm_castpd_si128(sum);
        let odd = _mm_and_si128(bits, _mm_set1_epi64x(1));
        let even = _mm_sub_epi64(odd, _mm_set1_epi64x(1));
        let step = _mm_or_si128(_mm_xor_si128(towards, _mm_set1_epi64x(-1)), _mm_set1_epi64x(1));
        _mm_castsi128_pd(_mm_add_epi64(bits, _mm_and_si128(step, _mm_and_si128(inexact, even))))
    })
}

/// The upper two f32 as f64.
#[inline(always)]
fn widen_high(a: __m128) -> __m128d {
    sse2!(_mm_cvtps_pd(_mm_movehl_ps(a, a)))
}

/// The floor of four f32; keeps the sign of zero.
#[allow(improper_ctypes_definitions)]
#[inline(never)]
extern "sysv64" fn floor(x: __m128) -> __m128 {
    sse2!({
        let sign = _mm_and_ps(x, _mm_set1_ps(-0.0));
        let size = _mm_xor_ps(x, sign);
        // Numbers from 2^23 on, and NaN, are their own floor. All others fit in an i32.
        let whole = _mm_cvtepi32_ps(_mm_cvttps_epi32(x));
        let down = _mm_sub_ps(whole, _mm_and_ps(_mm_cmpgt_ps(whole, x), _mm_set1_ps(1.0)));
        let fraction = _mm_castps_si128(_mm_cmplt_ps(size, _mm_set1_ps(8_388_608.0)));
        _mm_castsi128_ps(choose(fraction, _mm_castps_si128(_mm_or_ps(down, sign)), _mm_castps_si128(x)))
    })
}

/// The floor of two f64; keeps the sign of zero.
#[allow(improper_ctypes_definitions)]
#[inline(never)]
extern "sysv64" fn floor_f64(x: __m128d) -> __m128d {
    sse2!({
        let far = _mm_set1_pd(4_503_599_627_370_496.0);
        let sign = _mm_and_pd(x, _mm_set1_pd(-0.0));
        let size = _mm_xor_pd(x, sign);
        // Adding 2^52 rounds a positive number to an integer. Numbers from 2^52 on, and NaN, are their own floor.
        let near = _mm_or_pd(_mm_sub_pd(_mm_add_pd(size, far), far), sign);
        let down = _mm_sub_pd(near, _mm_and_pd(_mm_cmpgt_pd(near, x), _mm_set1_pd(1.0)));
        let fraction = _mm_castpd_si128(_mm_cmplt_pd(size, far));
        _mm_castsi128_pd(choose(fraction, _mm_castpd_si128(_mm_or_pd(down, sign)), _mm_castpd_si128(x)))
    })
}

/// The entries with these indices; the lower bits of an index count. `N` is a power of two.
#[allow(improper_ctypes_definitions)]
#[inline(never)]
extern "sysv64" fn look_up<const N: usize>(table: &[f32; N], index: __m128i) -> __m128 {
    let [a, b, c, d] = lanes(index).map(|index| table[index as usize % N]);
    sse2!(_mm_setr_ps(a, b, c, d))
}

/// `from[index]` per lane; an index beyond the end reads the last entry, an empty slice gives 0.
#[inline(always)]
fn picked<T: Copy + Default>(from: &[T], index: U32x4) -> [T; 4] {
    lanes(index.0).map(|index| from.get(index as usize).or(from.last()).copied().unwrap_or_default())
}

impl Simd for Sse2 {
    type F32 = F32x4;
    type U32 = U32x4;
    type F64 = F64x4;
    type Mask = Mask4;
    type Table8 = [f32; 8];
    type Table16 = [f32; 16];
    const LANES: usize = 4;
    const LEVEL: Level = Level::Scalar;
    const WIDE_LOOKUP: bool = true;

    #[inline(always)]
    fn run<B: Body>(self, body: B) -> B::Output {
        #[inline(never)]
        fn inner<B: Body>(token: Sse2, body: B) -> B::Output {
            body.run(token)
        }
        inner(self, body)
    }
    #[inline(always)]
    fn f32(self, value: f32) -> F32x4 {
        sse2!(F32x4(_mm_set1_ps(value)))
    }
    #[inline(always)]
    fn u32(self, value: u32) -> U32x4 {
        sse2!(U32x4(_mm_set1_epi32(value as i32)))
    }
    #[inline(always)]
    fn f64(self, value: f64) -> F64x4 {
        sse2!(F64x4(_mm_set1_pd(value), _mm_set1_pd(value)))
    }
    #[inline(always)]
    fn iota(self) -> U32x4 {
        sse2!(U32x4(_mm_setr_epi32(0, 1, 2, 3)))
    }
    #[inline(always)]
    fn load(self, from: &[f32]) -> F32x4 {
        let from = &from[..4];
        // SAFETY: the slice has four values; the instruction takes any alignment.
        F32x4(unsafe { _mm_loadu_ps(from.as_ptr()) })
    }
    #[inline(always)]
    fn load_u32(self, from: &[u32]) -> U32x4 {
        let from = &from[..4];
        // SAFETY: as above.
        U32x4(unsafe { _mm_loadu_si128(from.as_ptr().cast()) })
    }
    #[inline(always)]
    fn load_f64(self, from: &[f64]) -> F64x4 {
        let from = &from[..4];
        // SAFETY: as above, two values each.
        unsafe { F64x4(_mm_loadu_pd(from.as_ptr()), _mm_loadu_pd(from[2..].as_ptr())) }
    }
    #[inline(always)]
    fn table8(self, entries: &[f32; 8]) -> [f32; 8] {
        *entries
    }
    #[inline(always)]
    fn table16(self, entries: &[f32; 16]) -> [f32; 16] {
        *entries
    }
    #[inline(always)]
    fn lookup8(self, table: [f32; 8], index: U32x4) -> F32x4 {
        F32x4(look_up(&table, index.0))
    }
    #[inline(always)]
    fn lookup16(self, table: [f32; 16], index: U32x4) -> F32x4 {
        F32x4(look_up(&table, index.0))
    }
    #[inline(always)]
    fn gather(self, from: &[f32], index: U32x4) -> F32x4 {
        self.load(&picked(from, index))
    }
    #[inline(always)]
    fn gather_u32(self, from: &[u32], index: U32x4) -> U32x4 {
        self.load_u32(&picked(from, index))
    }
}

impl F32Lanes<Sse2> for F32x4 {
    #[inline(always)]
    fn store(self, to: &mut [f32]) {
        let to = &mut to[..4];
        // SAFETY: the slice has room for four values; the instruction takes any alignment.
        unsafe { _mm_storeu_ps(to.as_mut_ptr(), self.0) }
    }
    #[inline(always)]
    fn mul_add(self, factor: Self, term: Self) -> Self {
        F32x4(fused(self.0, factor.0, term.0))
    }
    #[inline(always)]
    fn neg_mul_add(self, factor: Self, term: Self) -> Self {
        (-self).mul_add(factor, term)
    }
    #[inline(always)]
    fn min(self, other: Self) -> Self {
        sse2!(F32x4(_mm_min_ps(self.0, other.0)))
    }
    #[inline(always)]
    fn max(self, other: Self) -> Self {
        sse2!(F32x4(_mm_max_ps(self.0, other.0)))
    }
    #[inline(always)]
    fn abs(self) -> Self {
        sse2!(F32x4(_mm_andnot_ps(_mm_set1_ps(-0.0), self.0)))
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        sse2!(F32x4(_mm_sqrt_ps(self.0)))
    }
    #[inline(always)]
    fn floor(self) -> Self {
        F32x4(floor(self.0))
    }
    #[inline(always)]
    fn lt(self, other: Self) -> Mask4 {
        sse2!(Mask4(_mm_castps_si128(_mm_cmplt_ps(self.0, other.0))))
    }
    #[inline(always)]
    fn le(self, other: Self) -> Mask4 {
        sse2!(Mask4(_mm_castps_si128(_mm_cmple_ps(self.0, other.0))))
    }
    #[inline(always)]
    fn eq(self, other: Self) -> Mask4 {
        sse2!(Mask4(_mm_castps_si128(_mm_cmpeq_ps(self.0, other.0))))
    }
    #[inline(always)]
    fn select(self, mask: Mask4, other: Self) -> Self {
        self.bits().select(mask, other.bits()).as_f32()
    }
    #[inline(always)]
    fn to_i32(self) -> U32x4 {
        sse2!(U32x4(_mm_cvttps_epi32(self.0)))
    }
    #[inline(always)]
    fn bits(self) -> U32x4 {
        sse2!(U32x4(_mm_castps_si128(self.0)))
    }
    #[inline(always)]
    fn widen(self) -> F64x4 {
        sse2!(F64x4(_mm_cvtps_pd(self.0), widen_high(self.0)))
    }
    #[inline(always)]
    fn permute(self, index: U32x4) -> Self {
        let mut entries = [0.0; 4];
        self.store(&mut entries);
        F32x4(look_up(&entries, index.0))
    }
}

impl U32Lanes<Sse2> for U32x4 {
    #[inline(always)]
    fn store(self, to: &mut [u32]) {
        let to = &mut to[..4];
        // SAFETY: as for f32.
        unsafe { _mm_storeu_si128(to.as_mut_ptr().cast(), self.0) }
    }
    #[inline(always)]
    fn shl(self, count: u32) -> Self {
        sse2!(U32x4(_mm_sll_epi32(self.0, _mm_cvtsi32_si128((count & 31) as i32))))
    }
    #[inline(always)]
    fn shr(self, count: u32) -> Self {
        sse2!(U32x4(_mm_srl_epi32(self.0, _mm_cvtsi32_si128((count & 31) as i32))))
    }
    #[inline(always)]
    fn sar(self, count: u32) -> Self {
        sse2!(U32x4(_mm_sra_epi32(self.0, _mm_cvtsi32_si128((count & 31) as i32))))
    }
    #[inline(always)]
    fn eq(self, other: Self) -> Mask4 {
        sse2!(Mask4(_mm_cmpeq_epi32(self.0, other.0)))
    }
    #[inline(always)]
    fn lt_i32(self, other: Self) -> Mask4 {
        sse2!(Mask4(_mm_cmplt_epi32(self.0, other.0)))
    }
    #[inline(always)]
    fn select(self, mask: Mask4, other: Self) -> Self {
        U32x4(choose(mask.0, self.0, other.0))
    }
    #[inline(always)]
    fn i32_to_f32(self) -> F32x4 {
        sse2!(F32x4(_mm_cvtepi32_ps(self.0)))
    }
    #[inline(always)]
    fn as_f32(self) -> F32x4 {
        sse2!(F32x4(_mm_castsi128_ps(self.0)))
    }
    #[inline(always)]
    fn permute(self, index: Self) -> Self {
        self.as_f32().permute(index).bits()
    }
}

impl F64Lanes<Sse2> for F64x4 {
    #[inline(always)]
    fn store(self, to: &mut [f64]) {
        let to = &mut to[..4];
        // SAFETY: as for f32, two values each.
        unsafe {
            _mm_storeu_pd(to.as_mut_ptr(), self.0);
            _mm_storeu_pd(to[2..].as_mut_ptr(), self.1);
        }
    }
    #[inline(always)]
    fn min(self, other: Self) -> Self {
        sse2!(F64x4(_mm_min_pd(self.0, other.0), _mm_min_pd(self.1, other.1)))
    }
    #[inline(always)]
    fn max(self, other: Self) -> Self {
        sse2!(F64x4(_mm_max_pd(self.0, other.0), _mm_max_pd(self.1, other.1)))
    }
    #[inline(always)]
    fn floor(self) -> Self {
        F64x4(floor_f64(self.0), floor_f64(self.1))
    }
    #[inline(always)]
    fn narrow(self) -> F32x4 {
        sse2!(F32x4(_mm_movelh_ps(_mm_cvtpd_ps(self.0), _mm_cvtpd_ps(self.1))))
    }
    #[inline(always)]
    fn words(self) -> (U32x4, U32x4) {
        sse2!({
            let (a, b) = (_mm_castpd_ps(self.0), _mm_castpd_ps(self.1));
            let (low, high) = (_mm_shuffle_ps::<0b10_00_10_00>(a, b), _mm_shuffle_ps::<0b11_01_11_01>(a, b));
            (U32x4(_mm_castps_si128(low)), U32x4(_mm_castps_si128(high)))
        })
    }
}

impl MaskLanes for Mask4 {
    const LANES: usize = 4;
    #[inline(always)]
    fn to_bits(self) -> u32 {
        sse2!(_mm_movemask_ps(_mm_castsi128_ps(self.0)) as u32)
    }
}
