//! AVX-512: 16 lanes in one register, f64 in two.

use crate::lanes::FAR;
use crate::{F64Lanes, Level};
use core::arch::x86_64::*;

/// Rounding mode: down, without exceptions.
const DOWN: i32 = _MM_FROUND_TO_NEG_INF | _MM_FROUND_NO_EXC;

/// 8 f32, twice.
#[derive(Clone, Copy, Debug)]
pub struct Table8(__m512);
/// 16 f32.
#[derive(Clone, Copy, Debug)]
pub struct Table16(__m512);

level! {
    /// The token of AVX-512.
    Avx512: 16 lanes, requires [
        "avx512f" "avx512bw" "avx512dq" "avx512vl" "avx2" "fma" "bmi1" "bmi2" "lzcnt" "popcnt"
    ];

    Simd {
        fn f32(value: f32) -> F32 => _mm512_set1_ps(value);
        fn u32(value: u32) -> U32 => _mm512_set1_epi32(value as i32);
        fn f64(value: f64) -> F64 => _mm512_set1_pd(value);
        fn iota() -> U32 => _mm512_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15);
        fn load(from: [f32]) -> F32 => _mm512_loadu_ps(from);
        fn load_u32(from: [u32]) -> U32 => _mm512_loadu_si512(from.cast());
        fn load_f64(from: [f64]) -> F64 => _mm512_loadu_pd(from);
        fn table8(entries: &[f32; 8]) -> Table8 => {
            let [a, b, c, d, e, f, g, h] = *entries;
            _mm512_setr_ps(a, b, c, d, e, f, g, h, a, b, c, d, e, f, g, h)
        };
        fn table16(entries: &[f32; 16]) -> Table16 => _mm512_loadu_ps(entries.as_ptr());
        fn lookup8(table: Table8, index: U32) -> F32 => _mm512_permutexvar_ps(index, table);
        fn lookup16(table: Table16, index: U32) -> F32 => _mm512_permutexvar_ps(index, table);
        fn gather(from: [f32], index: U32, last: i32) -> F32 =>
            _mm512_i32gather_ps::<4>(_mm512_min_epu32(index, _mm512_set1_epi32(last)), from);
        fn gather_u32(from: [u32], index: U32, last: i32) -> U32 =>
            _mm512_i32gather_epi32::<4>(_mm512_min_epu32(index, _mm512_set1_epi32(last)), from.cast());
    }
    by_hand {
        type Table8 = Table8;
        type Table16 = Table16;
        const LEVEL: Level = Level::Avx512;
        const WIDE_LOOKUP: bool = true;

        #[inline(always)]
        fn whole(self, number: F64) -> (F64, U32, U32) {
            let far = self.f64(FAR);
            let sum = sum_down(number, far);
            let (low, high) = sum.words();
            (sum - far, low, high)
        }
        #[inline(always)]
        fn place(self, number: F64, from: f64, count: u32) -> (F64, U32, U32) {
            let far = self.f64(FAR - from);
            let sum = sum_down(number, far);
            // SAFETY: the token proves the features.
            let elsewhere = unsafe {
                let here = _mm512_castpd_si512(self.f64(FAR).0);
                let (a, b) = (_mm512_castpd_si512(sum.0), _mm512_castpd_si512(sum.1));
                let either = _mm512_or_si512(_mm512_xor_si512(a, here), _mm512_xor_si512(b, here));
                _mm512_and_si512(either, _mm512_set1_epi64(!i64::from(count - 1)))
            };
            (sum - far, sum.words().0, U32(elsewhere))
        }
    }

    /// 16 f32.
    F32(__m512): F32Lanes {
        impl Add: add(a, b) => _mm512_add_ps(a, b);
        impl Sub: sub(a, b) => _mm512_sub_ps(a, b);
        impl Mul: mul(a, b) => _mm512_mul_ps(a, b);
        impl Div: div(a, b) => _mm512_div_ps(a, b);
        impl Neg: neg(a) => _mm512_xor_ps(a, _mm512_set1_ps(-0.0));
        fn store(a, to: [f32]) => _mm512_storeu_ps(to, a);
        fn stream(a, to: [f32]) => _mm512_stream_ps(to, a);
        fn mul_add(a, factor, term) => _mm512_fmadd_ps(a, factor, term);
        fn neg_mul_add(a, factor, term) => _mm512_fnmadd_ps(a, factor, term);
        fn min(a, b) => _mm512_min_ps(a, b);
        fn max(a, b) => _mm512_max_ps(a, b);
        fn abs(a) => _mm512_abs_ps(a);
        fn sqrt(a) => _mm512_sqrt_ps(a);
        fn floor(a) => _mm512_roundscale_ps::<DOWN>(a);
        fn lt(a, b) -> Mask => _mm512_cmp_ps_mask::<_CMP_LT_OQ>(a, b);
        fn le(a, b) -> Mask => _mm512_cmp_ps_mask::<_CMP_LE_OQ>(a, b);
        fn eq(a, b) -> Mask => _mm512_cmp_ps_mask::<_CMP_EQ_OQ>(a, b);
        fn select(a, mask: Mask, b) => _mm512_mask_blend_ps(mask, b, a);
        fn to_i32(a) -> U32 => _mm512_cvttps_epi32(a);
        fn bits(a) -> U32 => _mm512_castps_si512(a);
        fn widen(a) -> F64 =>
            (_mm512_cvtps_pd(_mm512_castps512_ps256(a)), _mm512_cvtps_pd(_mm512_extractf32x8_ps::<1>(a)));
        fn permute(a, index: U32) => _mm512_permutexvar_ps(index, a);
    }

    /// 16 u32.
    U32(__m512i): U32Lanes {
        impl Add: add(a, b) => _mm512_add_epi32(a, b);
        impl Sub: sub(a, b) => _mm512_sub_epi32(a, b);
        impl Mul: mul(a, b) => _mm512_mullo_epi32(a, b);
        impl BitAnd: bitand(a, b) => _mm512_and_si512(a, b);
        impl BitOr: bitor(a, b) => _mm512_or_si512(a, b);
        impl BitXor: bitxor(a, b) => _mm512_xor_si512(a, b);
        impl Not: not(a) => _mm512_xor_si512(a, _mm512_set1_epi32(-1));
        fn store(a, to: [u32]) => _mm512_storeu_si512(to.cast(), a);
        fn shl(a, count: u32) => _mm512_sllv_epi32(a, _mm512_set1_epi32(count as i32));
        fn shr(a, count: u32) => _mm512_srlv_epi32(a, _mm512_set1_epi32(count as i32));
        fn sar(a, count: u32) => _mm512_srav_epi32(a, _mm512_set1_epi32(count as i32));
        fn eq(a, b) -> Mask => _mm512_cmpeq_epi32_mask(a, b);
        fn lt_i32(a, b) -> Mask => _mm512_cmplt_epi32_mask(a, b);
        fn select(a, mask: Mask, b) => _mm512_mask_blend_epi32(mask, b, a);
        fn i32_to_f32(a) -> F32 => _mm512_cvtepi32_ps(a);
        fn as_f32(a) -> F32 => _mm512_castsi512_ps(a);
        fn permute(a, index: U32) => _mm512_permutexvar_epi32(index, a);
    }

    /// 16 f64.
    F64(__m512d, __m512d): F64Lanes {
        impl Add: add(a, b) => _mm512_add_pd(a, b);
        impl Sub: sub(a, b) => _mm512_sub_pd(a, b);
        impl Mul: mul(a, b) => _mm512_mul_pd(a, b);
        fn store(a, to: [f64]) => _mm512_storeu_pd(to, a);
        fn min(a, b) => _mm512_min_pd(a, b);
        fn max(a, b) => _mm512_max_pd(a, b);
        fn floor(a) => _mm512_roundscale_pd::<DOWN>(a);
        fn narrow(low, high) -> F32 =>
            _mm512_insertf32x8::<1>(_mm512_castps256_ps512(_mm512_cvtpd_ps(low)), _mm512_cvtpd_ps(high));
        fn words(low, high) => {
            let (a, b) = (_mm512_castpd_si512(low), _mm512_castpd_si512(high));
            let even = _mm512_setr_epi32(0, 2, 4, 6, 8, 10, 12, 14, 16, 18, 20, 22, 24, 26, 28, 30);
            let odd = _mm512_setr_epi32(1, 3, 5, 7, 9, 11, 13, 15, 17, 19, 21, 23, 25, 27, 29, 31);
            (_mm512_permutex2var_epi32(a, even, b), _mm512_permutex2var_epi32(a, odd, b))
        };
    }

    /// 16 truth values.
    Mask(__mmask16): MaskLanes {
        impl BitAnd: bitand(a, b) => a & b;
        impl BitOr: bitor(a, b) => a | b;
        impl Not: not(a) => !a;
        fn to_bits(a) -> u32 => u32::from(a);
    }
}

/// A sum rounded down. The sum with [`FAR`] has no fraction, so its low bits are the floor of the number.
#[inline(always)]
fn sum_down(number: F64, far: F64) -> F64 {
    // SAFETY: the lanes came from a token, which proves the features.
    unsafe { F64(_mm512_add_round_pd::<DOWN>(number.0, far.0), _mm512_add_round_pd::<DOWN>(number.1, far.1)) }
}
