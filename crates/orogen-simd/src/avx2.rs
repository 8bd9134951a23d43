//! AVX2 with FMA: 8 lanes in one register, f64 in two.

use crate::avx512::last_index;
use crate::lanes::FAR;
use crate::{Body, F32Lanes, F64Lanes, Level, MaskLanes, Simd, Stream, U32Lanes};
use core::arch::x86_64::*;
use std::ops::{Add, BitAnd, BitOr, BitXor, Div, Mul, Neg, Not, Sub};

/// The token of AVX2 with FMA.
#[derive(Clone, Copy, Debug)]
pub struct Avx2(());

/// 8 f32.
#[derive(Clone, Copy, Debug)]
pub struct F32x8(__m256);
/// 8 u32.
#[derive(Clone, Copy, Debug)]
pub struct U32x8(__m256i);
/// 8 f64.
#[derive(Clone, Copy, Debug)]
pub struct F64x8(__m256d, __m256d);
/// 8 truth values, each all ones or all zeros.
#[derive(Clone, Copy, Debug)]
pub struct Mask8(__m256i);
/// 8 f32.
#[derive(Clone, Copy, Debug)]
pub struct Table8x256(__m256);
/// 16 f32.
#[derive(Clone, Copy, Debug)]
pub struct Table16x256(__m256, __m256);

impl Avx2 {
    /// The token, if the processor and the operating system support the instructions.
    #[inline]
    #[must_use]
    pub fn detect() -> Option<Avx2> {
        (is_x86_feature_detected!("avx2")
            && is_x86_feature_detected!("fma")
            && is_x86_feature_detected!("bmi1")
            && is_x86_feature_detected!("bmi2")
            && is_x86_feature_detected!("lzcnt")
            && is_x86_feature_detected!("popcnt"))
        .then_some(Avx2(()))
    }

    /// The token without a check.
    ///
    /// # Safety
    /// [`Avx2::detect`] must return a token on this machine.
    #[inline(always)]
    #[must_use]
    pub unsafe fn new_unchecked() -> Avx2 {
        Avx2(())
    }
}

// SAFETY of every block in this file: its lane values and its token exist only where `Avx2::detect` held (their contents are
// private), so the processor has the instructions. Loads and stores touch what a bounds-checked slice covers.

macro_rules! lanewise {
    ($type:ident: $($trait:ident $method:ident $op:ident;)*) => {$(
        impl $trait for $type {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                // SAFETY: see the head of the file.
                $type(unsafe { $op(self.0, other.0) })
            }
        }
    )*};
}
lanewise!(F32x8: Add add _mm256_add_ps; Sub sub _mm256_sub_ps; Mul mul _mm256_mul_ps; Div div _mm256_div_ps;);
lanewise!(U32x8: Add add _mm256_add_epi32; Sub sub _mm256_sub_epi32; Mul mul _mm256_mullo_epi32;
    BitAnd bitand _mm256_and_si256; BitOr bitor _mm256_or_si256; BitXor bitxor _mm256_xor_si256;);
lanewise!(Mask8: BitAnd bitand _mm256_and_si256; BitOr bitor _mm256_or_si256;);

macro_rules! lanewise_f64 {
    ($($trait:ident $method:ident $op:ident;)*) => {$(
        impl $trait for F64x8 {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                // SAFETY: see the head of the file.
                unsafe { F64x8($op(self.0, other.0), $op(self.1, other.1)) }
            }
        }
    )*};
}
lanewise_f64!(Add add _mm256_add_pd; Sub sub _mm256_sub_pd; Mul mul _mm256_mul_pd;);

impl Neg for F32x8 {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        // SAFETY: see the head of the file.
        F32x8(unsafe { _mm256_xor_ps(self.0, _mm256_set1_ps(-0.0)) })
    }
}
impl Not for U32x8 {
    type Output = Self;
    #[inline(always)]
    fn not(self) -> Self {
        // SAFETY: see the head of the file.
        U32x8(unsafe { _mm256_xor_si256(self.0, _mm256_set1_epi32(-1)) })
    }
}
impl Not for Mask8 {
    type Output = Self;
    #[inline(always)]
    fn not(self) -> Self {
        // SAFETY: see the head of the file.
        Mask8(unsafe { _mm256_xor_si256(self.0, _mm256_set1_epi32(-1)) })
    }
}

impl Simd for Avx2 {
    type F32 = F32x8;
    type U32 = U32x8;
    type F64 = F64x8;
    type Mask = Mask8;
    type Table8 = Table8x256;
    type Table16 = Table16x256;
    const LANES: usize = 8;
    const LEVEL: Level = Level::Avx2;
    const WIDE_LOOKUP: bool = false;

    #[inline(always)]
    fn run<B: Body>(self, body: B) -> B::Output {
        #[target_feature(enable = "avx2,fma,bmi1,bmi2,lzcnt,popcnt")]
        #[inline(never)]
        fn inner<B: Body>(token: Avx2, body: B) -> B::Output {
            body.run(token)
        }
        // SAFETY: the token proves the features.
        unsafe { inner(self, body) }
    }
    #[inline(always)]
    fn f32(self, value: f32) -> F32x8 {
        // SAFETY: see the head of the file.
        F32x8(unsafe { _mm256_set1_ps(value) })
    }
    #[inline(always)]
    fn u32(self, value: u32) -> U32x8 {
        // SAFETY: see the head of the file.
        U32x8(unsafe { _mm256_set1_epi32(value as i32) })
    }
    #[inline(always)]
    fn f64(self, value: f64) -> F64x8 {
        // SAFETY: see the head of the file.
        unsafe { F64x8(_mm256_set1_pd(value), _mm256_set1_pd(value)) }
    }
    #[inline(always)]
    fn iota(self) -> U32x8 {
        // SAFETY: see the head of the file.
        U32x8(unsafe { _mm256_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7) })
    }
    #[inline(always)]
    fn load(self, from: &[f32]) -> F32x8 {
        let from = &from[..8];
        // SAFETY: see the head of the file.
        F32x8(unsafe { _mm256_loadu_ps(from.as_ptr()) })
    }
    #[inline(always)]
    fn load_u32(self, from: &[u32]) -> U32x8 {
        let from = &from[..8];
        // SAFETY: see the head of the file.
        U32x8(unsafe { _mm256_loadu_si256(from.as_ptr().cast()) })
    }
    #[inline(always)]
    fn load_f64(self, from: &[f64]) -> F64x8 {
        let from = &from[..8];
        // SAFETY: see the head of the file.
        unsafe { F64x8(_mm256_loadu_pd(from.as_ptr()), _mm256_loadu_pd(from[4..].as_ptr())) }
    }
    #[inline(always)]
    fn table8(self, entries: &[f32; 8]) -> Table8x256 {
        Table8x256(self.load(entries).0)
    }
    #[inline(always)]
    fn table16(self, entries: &[f32; 16]) -> Table16x256 {
        Table16x256(self.load(entries).0, self.load(&entries[8..]).0)
    }
    #[inline(always)]
    fn lookup8(self, table: Table8x256, index: U32x8) -> F32x8 {
        // SAFETY: see the head of the file.
        F32x8(unsafe { _mm256_permutevar8x32_ps(table.0, index.0) })
    }
    #[inline(always)]
    fn lookup16(self, table: Table16x256, index: U32x8) -> F32x8 {
        // SAFETY: see the head of the file.
        F32x8(unsafe {
            // Bit 3 of the index, shifted to the sign, selects the half.
            let half = _mm256_castsi256_ps(index.shl(28).0);
            let low = _mm256_permutevar8x32_ps(table.0, index.0);
            let high = _mm256_permutevar8x32_ps(table.1, index.0);
            _mm256_blendv_ps(low, high, half)
        })
    }
    #[inline(always)]
    fn place(self, number: F64x8, from: f64, count: u32) -> (F64x8, U32x8, U32x8) {
        let whole = number.floor();
        let sum = whole + self.f64(FAR - from);
        // SAFETY: see the head of the file.
        let elsewhere = unsafe {
            let here = _mm256_castpd_si256(self.f64(FAR).0);
            let (a, b) = (_mm256_castpd_si256(sum.0), _mm256_castpd_si256(sum.1));
            let either = _mm256_or_si256(_mm256_xor_si256(a, here), _mm256_xor_si256(b, here));
            _mm256_and_si256(either, _mm256_set1_epi64x(!i64::from(count - 1)))
        };
        (whole, sum.words().0, U32x8(elsewhere))
    }
    #[inline(always)]
    fn gather(self, from: &[f32], index: U32x8) -> F32x8 {
        let Some(last) = last_index(from.len()) else {
            return self.f32(0.0);
        };
        // SAFETY: see the head of the file; the clamped indices are inside the slice and below 2^31.
        F32x8(unsafe {
            let index = _mm256_min_epu32(index.0, _mm256_set1_epi32(last));
            _mm256_i32gather_ps::<4>(from.as_ptr(), index)
        })
    }
    #[inline(always)]
    fn gather_u32(self, from: &[u32], index: U32x8) -> U32x8 {
        let Some(last) = last_index(from.len()) else {
            return self.u32(0);
        };
        // SAFETY: see the head of the file; the clamped indices are inside the slice and below 2^31.
        U32x8(unsafe {
            let index = _mm256_min_epu32(index.0, _mm256_set1_epi32(last));
            _mm256_i32gather_epi32::<4>(from.as_ptr().cast(), index)
        })
    }
}

/// The result of a comparison as a mask.
#[inline(always)]
fn mask(lanes: __m256) -> Mask8 {
    // SAFETY: see the head of the file; the argument came from an AVX instruction.
    Mask8(unsafe { _mm256_castps_si256(lanes) })
}

impl F32Lanes<Avx2> for F32x8 {
    #[inline(always)]
    fn store(self, to: &mut [f32]) {
        let to = &mut to[..8];
        // SAFETY: see the head of the file.
        unsafe { _mm256_storeu_ps(to.as_mut_ptr(), self.0) }
    }
    #[inline(always)]
    fn stream(self, to: &mut [f32], _: &Stream) {
        if to.len() >= 8 && to.as_ptr().addr().is_multiple_of(32) {
            // SAFETY: see the head of the file; it is aligned, and a `Stream` waits for what was written when it is dropped.
            unsafe { _mm256_stream_ps(to.as_mut_ptr(), self.0) }
        } else {
            self.store_partial(to);
        }
    }
    #[inline(always)]
    fn mul_add(self, factor: Self, term: Self) -> Self {
        // SAFETY: see the head of the file.
        F32x8(unsafe { _mm256_fmadd_ps(self.0, factor.0, term.0) })
    }
    #[inline(always)]
    fn neg_mul_add(self, factor: Self, term: Self) -> Self {
        // SAFETY: see the head of the file.
        F32x8(unsafe { _mm256_fnmadd_ps(self.0, factor.0, term.0) })
    }
    #[inline(always)]
    fn min(self, other: Self) -> Self {
        // SAFETY: see the head of the file.
        F32x8(unsafe { _mm256_min_ps(self.0, other.0) })
    }
    #[inline(always)]
    fn max(self, other: Self) -> Self {
        // SAFETY: see the head of the file.
        F32x8(unsafe { _mm256_max_ps(self.0, other.0) })
    }
    #[inline(always)]
    fn abs(self) -> Self {
        // SAFETY: see the head of the file.
        F32x8(unsafe { _mm256_andnot_ps(_mm256_set1_ps(-0.0), self.0) })
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        // SAFETY: see the head of the file.
        F32x8(unsafe { _mm256_sqrt_ps(self.0) })
    }
    #[inline(always)]
    fn floor(self) -> Self {
        // SAFETY: see the head of the file.
        F32x8(unsafe { _mm256_floor_ps(self.0) })
    }
    #[inline(always)]
    fn lt(self, other: Self) -> Mask8 {
        // SAFETY: see the head of the file.
        mask(unsafe { _mm256_cmp_ps::<_CMP_LT_OQ>(self.0, other.0) })
    }
    #[inline(always)]
    fn le(self, other: Self) -> Mask8 {
        // SAFETY: see the head of the file.
        mask(unsafe { _mm256_cmp_ps::<_CMP_LE_OQ>(self.0, other.0) })
    }
    #[inline(always)]
    fn eq(self, other: Self) -> Mask8 {
        // SAFETY: see the head of the file.
        mask(unsafe { _mm256_cmp_ps::<_CMP_EQ_OQ>(self.0, other.0) })
    }
    #[inline(always)]
    fn select(self, mask: Mask8, other: Self) -> Self {
        // SAFETY: see the head of the file.
        F32x8(unsafe { _mm256_blendv_ps(other.0, self.0, _mm256_castsi256_ps(mask.0)) })
    }
    #[inline(always)]
    fn to_i32(self) -> U32x8 {
        // SAFETY: see the head of the file.
        U32x8(unsafe { _mm256_cvttps_epi32(self.0) })
    }
    #[inline(always)]
    fn bits(self) -> U32x8 {
        // SAFETY: see the head of the file.
        U32x8(unsafe { _mm256_castps_si256(self.0) })
    }
    #[inline(always)]
    fn widen(self) -> F64x8 {
        // SAFETY: see the head of the file.
        unsafe {
            F64x8(_mm256_cvtps_pd(_mm256_castps256_ps128(self.0)), _mm256_cvtps_pd(_mm256_extractf128_ps::<1>(self.0)))
        }
    }
    #[inline(always)]
    fn permute(self, index: U32x8) -> Self {
        // SAFETY: see the head of the file.
        F32x8(unsafe { _mm256_permutevar8x32_ps(self.0, index.0) })
    }
}

impl U32Lanes<Avx2> for U32x8 {
    #[inline(always)]
    fn store(self, to: &mut [u32]) {
        let to = &mut to[..8];
        // SAFETY: see the head of the file.
        unsafe { _mm256_storeu_si256(to.as_mut_ptr().cast(), self.0) }
    }
    #[inline(always)]
    fn shl(self, count: u32) -> Self {
        // SAFETY: see the head of the file.
        U32x8(unsafe { _mm256_sllv_epi32(self.0, _mm256_set1_epi32((count & 31) as i32)) })
    }
    #[inline(always)]
    fn shr(self, count: u32) -> Self {
        // SAFETY: see the head of the file.
        U32x8(unsafe { _mm256_srlv_epi32(self.0, _mm256_set1_epi32((count & 31) as i32)) })
    }
    #[inline(always)]
    fn sar(self, count: u32) -> Self {
        // SAFETY: see the head of the file.
        U32x8(unsafe { _mm256_srav_epi32(self.0, _mm256_set1_epi32((count & 31) as i32)) })
    }
    #[inline(always)]
    fn eq(self, other: Self) -> Mask8 {
        // SAFETY: see the head of the file.
        Mask8(unsafe { _mm256_cmpeq_epi32(self.0, other.0) })
    }
    #[inline(always)]
    fn lt_i32(self, other: Self) -> Mask8 {
        // SAFETY: see the head of the file.
        Mask8(unsafe { _mm256_cmpgt_epi32(other.0, self.0) })
    }
    #[inline(always)]
    fn select(self, mask: Mask8, other: Self) -> Self {
        // SAFETY: see the head of the file.
        U32x8(unsafe { _mm256_blendv_epi8(other.0, self.0, mask.0) })
    }
    #[inline(always)]
    fn i32_to_f32(self) -> F32x8 {
        // SAFETY: see the head of the file.
        F32x8(unsafe { _mm256_cvtepi32_ps(self.0) })
    }
    #[inline(always)]
    fn as_f32(self) -> F32x8 {
        // SAFETY: see the head of the file.
        F32x8(unsafe { _mm256_castsi256_ps(self.0) })
    }
    #[inline(always)]
    fn permute(self, index: Self) -> Self {
        // SAFETY: see the head of the file.
        U32x8(unsafe { _mm256_permutevar8x32_epi32(self.0, index.0) })
    }
}

impl F64Lanes<Avx2> for F64x8 {
    #[inline(always)]
    fn store(self, to: &mut [f64]) {
        let to = &mut to[..8];
        // SAFETY: see the head of the file.
        unsafe {
            _mm256_storeu_pd(to.as_mut_ptr(), self.0);
            _mm256_storeu_pd(to[4..].as_mut_ptr(), self.1);
        }
    }
    #[inline(always)]
    fn min(self, other: Self) -> Self {
        // SAFETY: see the head of the file.
        unsafe { F64x8(_mm256_min_pd(self.0, other.0), _mm256_min_pd(self.1, other.1)) }
    }
    #[inline(always)]
    fn max(self, other: Self) -> Self {
        // SAFETY: see the head of the file.
        unsafe { F64x8(_mm256_max_pd(self.0, other.0), _mm256_max_pd(self.1, other.1)) }
    }
    #[inline(always)]
    fn floor(self) -> Self {
        // SAFETY: see the head of the file.
        unsafe { F64x8(_mm256_floor_pd(self.0), _mm256_floor_pd(self.1)) }
    }
    #[inline(always)]
    fn narrow(self) -> F32x8 {
        // SAFETY: see the head of the file.
        F32x8(unsafe { _mm256_set_m128(_mm256_cvtpd_ps(self.1), _mm256_cvtpd_ps(self.0)) })
    }
    #[inline(always)]
    fn words(self) -> (U32x8, U32x8) {
        // SAFETY: see the head of the file.
        unsafe {
            let (a, b) = (_mm256_castpd_ps(self.0), _mm256_castpd_ps(self.1));
            // Each shuffle works within 128-bit halves, which leaves the pairs as a01 b01 a23 b23.
            let low = _mm256_castps_pd(_mm256_shuffle_ps::<0x88>(a, b));
            let high = _mm256_castps_pd(_mm256_shuffle_ps::<0xDD>(a, b));
            (
                U32x8(_mm256_castpd_si256(_mm256_permute4x64_pd::<0xD8>(low))),
                U32x8(_mm256_castpd_si256(_mm256_permute4x64_pd::<0xD8>(high))),
            )
        }
    }
}

impl MaskLanes for Mask8 {
    const LANES: usize = 8;
    #[inline(always)]
    fn to_bits(self) -> u32 {
        // SAFETY: see the head of the file.
        (unsafe { _mm256_movemask_ps(_mm256_castsi256_ps(self.0)) }) as u32
    }
}
