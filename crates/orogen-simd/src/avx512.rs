//! AVX-512: 16 lanes in one register, f64 in two.

use crate::lanes::FAR;
use crate::{Body, F32Lanes, F64Lanes, Level, MaskLanes, Simd, Stream, U32Lanes};
use core::arch::x86_64::*;
use std::ops::{Add, BitAnd, BitOr, BitXor, Div, Mul, Neg, Not, Sub};

/// The token of AVX-512.
#[derive(Clone, Copy, Debug)]
pub struct Avx512(());

/// 16 f32.
#[derive(Clone, Copy, Debug)]
pub struct F32x16(__m512);
/// 16 u32.
#[derive(Clone, Copy, Debug)]
pub struct U32x16(__m512i);
/// 16 f64.
#[derive(Clone, Copy, Debug)]
pub struct F64x16(__m512d, __m512d);
/// 16 truth values.
#[derive(Clone, Copy, Debug)]
pub struct Mask16(__mmask16);
/// 8 f32, twice.
#[derive(Clone, Copy, Debug)]
pub struct Table8x512(__m512);
/// 16 f32.
#[derive(Clone, Copy, Debug)]
pub struct Table16x512(__m512);

impl Avx512 {
    /// The token, if the processor and the operating system support the instructions.
    #[inline]
    #[must_use]
    pub fn detect() -> Option<Avx512> {
        (is_x86_feature_detected!("avx512f")
            && is_x86_feature_detected!("avx512bw")
            && is_x86_feature_detected!("avx512dq")
            && is_x86_feature_detected!("avx512vl")
            && is_x86_feature_detected!("avx2")
            && is_x86_feature_detected!("fma")
            && is_x86_feature_detected!("bmi1")
            && is_x86_feature_detected!("bmi2")
            && is_x86_feature_detected!("lzcnt")
            && is_x86_feature_detected!("popcnt"))
        .then_some(Avx512(()))
    }

    /// The token without a check.
    ///
    /// # Safety
    /// [`Avx512::detect`] must return a token on this machine.
    #[inline(always)]
    #[must_use]
    pub unsafe fn new_unchecked() -> Avx512 {
        Avx512(())
    }
}

// SAFETY of every block in this file: its lane values and its token exist only where `Avx512::detect` held (their contents are
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
lanewise!(F32x16: Add add _mm512_add_ps; Sub sub _mm512_sub_ps; Mul mul _mm512_mul_ps; Div div _mm512_div_ps;);
lanewise!(U32x16: Add add _mm512_add_epi32; Sub sub _mm512_sub_epi32; Mul mul _mm512_mullo_epi32;
    BitAnd bitand _mm512_and_si512; BitOr bitor _mm512_or_si512; BitXor bitxor _mm512_xor_si512;);

macro_rules! lanewise_f64 {
    ($($trait:ident $method:ident $op:ident;)*) => {$(
        impl $trait for F64x16 {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                // SAFETY: see the head of the file.
                unsafe { F64x16($op(self.0, other.0), $op(self.1, other.1)) }
            }
        }
    )*};
}
lanewise_f64!(Add add _mm512_add_pd; Sub sub _mm512_sub_pd; Mul mul _mm512_mul_pd;);

impl BitAnd for Mask16 {
    type Output = Self;
    #[inline(always)]
    fn bitand(self, other: Self) -> Self {
        Mask16(self.0 & other.0)
    }
}
impl BitOr for Mask16 {
    type Output = Self;
    #[inline(always)]
    fn bitor(self, other: Self) -> Self {
        Mask16(self.0 | other.0)
    }
}
impl Not for Mask16 {
    type Output = Self;
    #[inline(always)]
    fn not(self) -> Self {
        Mask16(!self.0)
    }
}
impl Neg for F32x16 {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        // SAFETY: see the head of the file.
        F32x16(unsafe { _mm512_xor_ps(self.0, _mm512_set1_ps(-0.0)) })
    }
}
impl Not for U32x16 {
    type Output = Self;
    #[inline(always)]
    fn not(self) -> Self {
        // SAFETY: see the head of the file.
        U32x16(unsafe { _mm512_xor_si512(self.0, _mm512_set1_epi32(-1)) })
    }
}

impl Simd for Avx512 {
    type F32 = F32x16;
    type U32 = U32x16;
    type F64 = F64x16;
    type Mask = Mask16;
    type Table8 = Table8x512;
    type Table16 = Table16x512;
    const LANES: usize = 16;
    const LEVEL: Level = Level::Avx512;
    const WIDE_LOOKUP: bool = true;

    #[inline(always)]
    fn run<B: Body>(self, body: B) -> B::Output {
        #[target_feature(enable = "avx512f,avx512bw,avx512dq,avx512vl,avx2,fma,bmi1,bmi2,lzcnt,popcnt")]
        #[inline(never)]
        fn inner<B: Body>(token: Avx512, body: B) -> B::Output {
            body.run(token)
        }
        // SAFETY: the token proves the features.
        unsafe { inner(self, body) }
    }
    #[inline(always)]
    fn f32(self, value: f32) -> F32x16 {
        // SAFETY: see the head of the file.
        F32x16(unsafe { _mm512_set1_ps(value) })
    }
    #[inline(always)]
    fn u32(self, value: u32) -> U32x16 {
        // SAFETY: see the head of the file.
        U32x16(unsafe { _mm512_set1_epi32(value as i32) })
    }
    #[inline(always)]
    fn f64(self, value: f64) -> F64x16 {
        // SAFETY: see the head of the file.
        unsafe { F64x16(_mm512_set1_pd(value), _mm512_set1_pd(value)) }
    }
    #[inline(always)]
    fn iota(self) -> U32x16 {
        // SAFETY: see the head of the file.
        U32x16(unsafe { _mm512_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15) })
    }
    #[inline(always)]
    fn load(self, from: &[f32]) -> F32x16 {
        let from = &from[..16];
        // SAFETY: see the head of the file.
        F32x16(unsafe { _mm512_loadu_ps(from.as_ptr()) })
    }
    #[inline(always)]
    fn load_u32(self, from: &[u32]) -> U32x16 {
        let from = &from[..16];
        // SAFETY: see the head of the file.
        U32x16(unsafe { _mm512_loadu_si512(from.as_ptr().cast()) })
    }
    #[inline(always)]
    fn load_f64(self, from: &[f64]) -> F64x16 {
        let from = &from[..16];
        // SAFETY: see the head of the file.
        unsafe { F64x16(_mm512_loadu_pd(from.as_ptr()), _mm512_loadu_pd(from[8..].as_ptr())) }
    }
    #[inline(always)]
    fn table8(self, entries: &[f32; 8]) -> Table8x512 {
        let [a, b, c, d, e, f, g, h] = *entries;
        // SAFETY: see the head of the file.
        Table8x512(unsafe { _mm512_setr_ps(a, b, c, d, e, f, g, h, a, b, c, d, e, f, g, h) })
    }
    #[inline(always)]
    fn table16(self, entries: &[f32; 16]) -> Table16x512 {
        Table16x512(self.load(entries).0)
    }
    #[inline(always)]
    fn lookup8(self, table: Table8x512, index: U32x16) -> F32x16 {
        // SAFETY: see the head of the file.
        F32x16(unsafe { _mm512_permutexvar_ps(index.0, table.0) })
    }
    #[inline(always)]
    fn lookup16(self, table: Table16x512, index: U32x16) -> F32x16 {
        // SAFETY: see the head of the file.
        F32x16(unsafe { _mm512_permutexvar_ps(index.0, table.0) })
    }
    #[inline(always)]
    fn whole(self, number: F64x16) -> (F64x16, U32x16, U32x16) {
        let far = self.f64(FAR);
        let sum = sum_down(number, far);
        let (low, high) = sum.words();
        (sum - far, low, high)
    }
    #[inline(always)]
    fn place(self, number: F64x16, from: f64, count: u32) -> (F64x16, U32x16, U32x16) {
        let far = self.f64(FAR - from);
        let sum = sum_down(number, far);
        // SAFETY: see the head of the file.
        let elsewhere = unsafe {
            let here = _mm512_castpd_si512(self.f64(FAR).0);
            let (a, b) = (_mm512_castpd_si512(sum.0), _mm512_castpd_si512(sum.1));
            let either = _mm512_or_si512(_mm512_xor_si512(a, here), _mm512_xor_si512(b, here));
            _mm512_and_si512(either, _mm512_set1_epi64(!i64::from(count - 1)))
        };
        (sum - far, sum.words().0, U32x16(elsewhere))
    }
    #[inline(always)]
    fn gather(self, from: &[f32], index: U32x16) -> F32x16 {
        let Some(last) = last_index(from.len()) else {
            return self.f32(0.0);
        };
        // SAFETY: see the head of the file; the clamped indices are inside the slice and below 2^31.
        F32x16(unsafe {
            let index = _mm512_min_epu32(index.0, _mm512_set1_epi32(last));
            _mm512_i32gather_ps::<4>(index, from.as_ptr())
        })
    }
    #[inline(always)]
    fn gather_u32(self, from: &[u32], index: U32x16) -> U32x16 {
        let Some(last) = last_index(from.len()) else {
            return self.u32(0);
        };
        // SAFETY: see the head of the file; the clamped indices are inside the slice and below 2^31.
        U32x16(unsafe {
            let index = _mm512_min_epu32(index.0, _mm512_set1_epi32(last));
            _mm512_i32gather_epi32::<4>(index, from.as_ptr().cast())
        })
    }
}

/// A sum rounded down. The sum with [`FAR`] has no fraction, so its low bits are the floor of the number.
#[inline(always)]
fn sum_down(number: F64x16, far: F64x16) -> F64x16 {
    const DOWN: i32 = _MM_FROUND_TO_NEG_INF | _MM_FROUND_NO_EXC;
    // SAFETY: see the head of the file.
    unsafe { F64x16(_mm512_add_round_pd::<DOWN>(number.0, far.0), _mm512_add_round_pd::<DOWN>(number.1, far.1)) }
}

/// The highest index of a gather: its indices are signed 32-bit, so the rest of a larger slice cannot be reached.
#[inline(always)]
pub(crate) fn last_index(length: usize) -> Option<i32> {
    length.checked_sub(1).map(|last| i32::try_from(last).unwrap_or(i32::MAX))
}

impl F32Lanes<Avx512> for F32x16 {
    #[inline(always)]
    fn store(self, to: &mut [f32]) {
        let to = &mut to[..16];
        // SAFETY: see the head of the file.
        unsafe { _mm512_storeu_ps(to.as_mut_ptr(), self.0) }
    }
    #[inline(always)]
    fn stream(self, to: &mut [f32], _: &Stream) {
        if to.len() >= 16 && to.as_ptr().addr().is_multiple_of(64) {
            // SAFETY: see the head of the file; it is aligned, and a `Stream` waits for what was written when it is dropped.
            unsafe { _mm512_stream_ps(to.as_mut_ptr(), self.0) }
        } else {
            self.store_partial(to);
        }
    }
    #[inline(always)]
    fn mul_add(self, factor: Self, term: Self) -> Self {
        // SAFETY: see the head of the file.
        F32x16(unsafe { _mm512_fmadd_ps(self.0, factor.0, term.0) })
    }
    #[inline(always)]
    fn neg_mul_add(self, factor: Self, term: Self) -> Self {
        // SAFETY: see the head of the file.
        F32x16(unsafe { _mm512_fnmadd_ps(self.0, factor.0, term.0) })
    }
    #[inline(always)]
    fn min(self, other: Self) -> Self {
        // SAFETY: see the head of the file.
        F32x16(unsafe { _mm512_min_ps(self.0, other.0) })
    }
    #[inline(always)]
    fn max(self, other: Self) -> Self {
        // SAFETY: see the head of the file.
        F32x16(unsafe { _mm512_max_ps(self.0, other.0) })
    }
    #[inline(always)]
    fn abs(self) -> Self {
        // SAFETY: see the head of the file.
        F32x16(unsafe { _mm512_abs_ps(self.0) })
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        // SAFETY: see the head of the file.
        F32x16(unsafe { _mm512_sqrt_ps(self.0) })
    }
    #[inline(always)]
    fn floor(self) -> Self {
        // SAFETY: see the head of the file.
        F32x16(unsafe { _mm512_roundscale_ps::<{ _MM_FROUND_TO_NEG_INF | _MM_FROUND_NO_EXC }>(self.0) })
    }
    #[inline(always)]
    fn lt(self, other: Self) -> Mask16 {
        // SAFETY: see the head of the file.
        Mask16(unsafe { _mm512_cmp_ps_mask::<_CMP_LT_OQ>(self.0, other.0) })
    }
    #[inline(always)]
    fn le(self, other: Self) -> Mask16 {
        // SAFETY: see the head of the file.
        Mask16(unsafe { _mm512_cmp_ps_mask::<_CMP_LE_OQ>(self.0, other.0) })
    }
    #[inline(always)]
    fn eq(self, other: Self) -> Mask16 {
        // SAFETY: see the head of the file.
        Mask16(unsafe { _mm512_cmp_ps_mask::<_CMP_EQ_OQ>(self.0, other.0) })
    }
    #[inline(always)]
    fn select(self, mask: Mask16, other: Self) -> Self {
        // SAFETY: see the head of the file.
        F32x16(unsafe { _mm512_mask_blend_ps(mask.0, other.0, self.0) })
    }
    #[inline(always)]
    fn to_i32(self) -> U32x16 {
        // SAFETY: see the head of the file.
        U32x16(unsafe { _mm512_cvttps_epi32(self.0) })
    }
    #[inline(always)]
    fn bits(self) -> U32x16 {
        // SAFETY: see the head of the file.
        U32x16(unsafe { _mm512_castps_si512(self.0) })
    }
    #[inline(always)]
    fn widen(self) -> F64x16 {
        // SAFETY: see the head of the file.
        unsafe {
            F64x16(
                _mm512_cvtps_pd(_mm512_castps512_ps256(self.0)),
                _mm512_cvtps_pd(_mm512_extractf32x8_ps::<1>(self.0)),
            )
        }
    }
    #[inline(always)]
    fn permute(self, index: U32x16) -> Self {
        // SAFETY: see the head of the file.
        F32x16(unsafe { _mm512_permutexvar_ps(index.0, self.0) })
    }
}

impl U32Lanes<Avx512> for U32x16 {
    #[inline(always)]
    fn store(self, to: &mut [u32]) {
        let to = &mut to[..16];
        // SAFETY: see the head of the file.
        unsafe { _mm512_storeu_si512(to.as_mut_ptr().cast(), self.0) }
    }
    #[inline(always)]
    fn shl(self, count: u32) -> Self {
        // SAFETY: see the head of the file.
        U32x16(unsafe { _mm512_sllv_epi32(self.0, _mm512_set1_epi32((count & 31) as i32)) })
    }
    #[inline(always)]
    fn shr(self, count: u32) -> Self {
        // SAFETY: see the head of the file.
        U32x16(unsafe { _mm512_srlv_epi32(self.0, _mm512_set1_epi32((count & 31) as i32)) })
    }
    #[inline(always)]
    fn sar(self, count: u32) -> Self {
        // SAFETY: see the head of the file.
        U32x16(unsafe { _mm512_srav_epi32(self.0, _mm512_set1_epi32((count & 31) as i32)) })
    }
    #[inline(always)]
    fn eq(self, other: Self) -> Mask16 {
        // SAFETY: see the head of the file.
        Mask16(unsafe { _mm512_cmpeq_epi32_mask(self.0, other.0) })
    }
    #[inline(always)]
    fn lt_i32(self, other: Self) -> Mask16 {
        // SAFETY: see the head of the file.
        Mask16(unsafe { _mm512_cmplt_epi32_mask(self.0, other.0) })
    }
    #[inline(always)]
    fn select(self, mask: Mask16, other: Self) -> Self {
        // SAFETY: see the head of the file.
        U32x16(unsafe { _mm512_mask_blend_epi32(mask.0, other.0, self.0) })
    }
    #[inline(always)]
    fn i32_to_f32(self) -> F32x16 {
        // SAFETY: see the head of the file.
        F32x16(unsafe { _mm512_cvtepi32_ps(self.0) })
    }
    #[inline(always)]
    fn as_f32(self) -> F32x16 {
        // SAFETY: see the head of the file.
        F32x16(unsafe { _mm512_castsi512_ps(self.0) })
    }
    #[inline(always)]
    fn permute(self, index: Self) -> Self {
        // SAFETY: see the head of the file.
        U32x16(unsafe { _mm512_permutexvar_epi32(index.0, self.0) })
    }
}

impl F64Lanes<Avx512> for F64x16 {
    #[inline(always)]
    fn store(self, to: &mut [f64]) {
        let to = &mut to[..16];
        // SAFETY: see the head of the file.
        unsafe {
            _mm512_storeu_pd(to.as_mut_ptr(), self.0);
            _mm512_storeu_pd(to[8..].as_mut_ptr(), self.1);
        }
    }
    #[inline(always)]
    fn min(self, other: Self) -> Self {
        // SAFETY: see the head of the file.
        unsafe { F64x16(_mm512_min_pd(self.0, other.0), _mm512_min_pd(self.1, other.1)) }
    }
    #[inline(always)]
    fn max(self, other: Self) -> Self {
        // SAFETY: see the head of the file.
        unsafe { F64x16(_mm512_max_pd(self.0, other.0), _mm512_max_pd(self.1, other.1)) }
    }
    #[inline(always)]
    fn floor(self) -> Self {
        const DOWN: i32 = _MM_FROUND_TO_NEG_INF | _MM_FROUND_NO_EXC;
        // SAFETY: see the head of the file.
        unsafe { F64x16(_mm512_roundscale_pd::<DOWN>(self.0), _mm512_roundscale_pd::<DOWN>(self.1)) }
    }
    #[inline(always)]
    fn narrow(self) -> F32x16 {
        // SAFETY: see the head of the file.
        F32x16(unsafe {
            _mm512_insertf32x8::<1>(_mm512_castps256_ps512(_mm512_cvtpd_ps(self.0)), _mm512_cvtpd_ps(self.1))
        })
    }
    #[inline(always)]
    fn words(self) -> (U32x16, U32x16) {
        // SAFETY: see the head of the file.
        unsafe {
            let (a, b) = (_mm512_castpd_si512(self.0), _mm512_castpd_si512(self.1));
            let even = _mm512_setr_epi32(0, 2, 4, 6, 8, 10, 12, 14, 16, 18, 20, 22, 24, 26, 28, 30);
            let odd = _mm512_setr_epi32(1, 3, 5, 7, 9, 11, 13, 15, 17, 19, 21, 23, 25, 27, 29, 31);
            (U32x16(_mm512_permutex2var_epi32(a, even, b)), U32x16(_mm512_permutex2var_epi32(a, odd, b)))
        }
    }
}

impl MaskLanes for Mask16 {
    const LANES: usize = 16;
    #[inline(always)]
    fn to_bits(self) -> u32 {
        u32::from(self.0)
    }
}
