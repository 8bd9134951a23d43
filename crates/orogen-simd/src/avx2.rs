//! AVX2 with FMA: 8 lanes in one register, f64 in two.

use crate::lanes::FAR;
use crate::{F64Lanes, Level};
use core::arch::x86_64::*;

/// 8 f32.
#[derive(Clone, Copy, Debug)]
pub struct Table8(__m256);
/// 16 f32.
#[derive(Clone, Copy, Debug)]
pub struct Table16([__m256; 2]);

level! {
    /// The token of AVX2 with FMA.
    Avx2: 8 lanes, requires ["avx2" "fma" "bmi1" "bmi2" "lzcnt" "popcnt"];

    Simd {
        fn f32(value: f32) -> F32 => _mm256_set1_ps(value);
        fn u32(value: u32) -> U32 => _mm256_set1_epi32(value as i32);
        fn f64(value: f64) -> F64 => _mm256_set1_pd(value);
        fn iota() -> U32 => _mm256_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7);
        fn load(from: [f32]) -> F32 => _mm256_loadu_ps(from);
        fn load_u32(from: [u32]) -> U32 => _mm256_loadu_si256(from.cast());
        fn load_f64(from: [f64]) -> F64 => _mm256_loadu_pd(from);
        fn table8(entries: &[f32; 8]) -> Table8 => _mm256_loadu_ps(entries.as_ptr());
        fn table16(entries: &[f32; 16]) -> Table16 =>
            [_mm256_loadu_ps(entries.as_ptr()), _mm256_loadu_ps(entries[8..].as_ptr())];
        fn lookup8(table: Table8, index: U32) -> F32 => _mm256_permutevar8x32_ps(table, index);
        fn lookup16(table: Table16, index: U32) -> F32 => {
            // Bit 3 of the index, shifted to the sign, selects the half.
            let half = _mm256_castsi256_ps(_mm256_slli_epi32::<28>(index));
            let [low, high] = [_mm256_permutevar8x32_ps(table[0], index), _mm256_permutevar8x32_ps(table[1], index)];
            _mm256_blendv_ps(low, high, half)
        };
        fn gather(from: [f32], index: U32, last: i32) -> F32 =>
            _mm256_i32gather_ps::<4>(from, _mm256_min_epu32(index, _mm256_set1_epi32(last)));
        fn gather_u32(from: [u32], index: U32, last: i32) -> U32 =>
            _mm256_i32gather_epi32::<4>(from.cast(), _mm256_min_epu32(index, _mm256_set1_epi32(last)));
    }
    by_hand {
        type Table8 = Table8;
        type Table16 = Table16;
        const LEVEL: Level = Level::Avx2;
        const WIDE_LOOKUP: bool = false;

        #[inline(always)]
        fn place(self, number: F64, from: f64, count: u32) -> (F64, U32, U32) {
            let whole = number.floor();
            let sum = whole + self.f64(FAR - from);
            // SAFETY: the token proves the features.
            let elsewhere = unsafe {
                let here = _mm256_castpd_si256(self.f64(FAR).0);
                let (a, b) = (_mm256_castpd_si256(sum.0), _mm256_castpd_si256(sum.1));
                let either = _mm256_or_si256(_mm256_xor_si256(a, here), _mm256_xor_si256(b, here));
                _mm256_and_si256(either, _mm256_set1_epi64x(!i64::from(count - 1)))
            };
            (whole, sum.words().0, U32(elsewhere))
        }
    }

    /// 8 f32.
    F32(__m256): F32Lanes {
        impl Add: add(a, b) => _mm256_add_ps(a, b);
        impl Sub: sub(a, b) => _mm256_sub_ps(a, b);
        impl Mul: mul(a, b) => _mm256_mul_ps(a, b);
        impl Div: div(a, b) => _mm256_div_ps(a, b);
        impl Neg: neg(a) => _mm256_xor_ps(a, _mm256_set1_ps(-0.0));
        fn store(a, to: [f32]) => _mm256_storeu_ps(to, a);
        fn stream(a, to: [f32]) => _mm256_stream_ps(to, a);
        fn mul_add(a, factor, term) => _mm256_fmadd_ps(a, factor, term);
        fn neg_mul_add(a, factor, term) => _mm256_fnmadd_ps(a, factor, term);
        fn min(a, b) => _mm256_min_ps(a, b);
        fn max(a, b) => _mm256_max_ps(a, b);
        fn abs(a) => _mm256_andnot_ps(_mm256_set1_ps(-0.0), a);
        fn sqrt(a) => _mm256_sqrt_ps(a);
        fn floor(a) => _mm256_floor_ps(a);
        fn lt(a, b) -> Mask => _mm256_castps_si256(_mm256_cmp_ps::<_CMP_LT_OQ>(a, b));
        fn le(a, b) -> Mask => _mm256_castps_si256(_mm256_cmp_ps::<_CMP_LE_OQ>(a, b));
        fn eq(a, b) -> Mask => _mm256_castps_si256(_mm256_cmp_ps::<_CMP_EQ_OQ>(a, b));
        fn select(a, mask: Mask, b) => _mm256_blendv_ps(b, a, _mm256_castsi256_ps(mask));
        fn to_i32(a) -> U32 => _mm256_cvttps_epi32(a);
        fn bits(a) -> U32 => _mm256_castps_si256(a);
        fn widen(a) -> F64 =>
            (_mm256_cvtps_pd(_mm256_castps256_ps128(a)), _mm256_cvtps_pd(_mm256_extractf128_ps::<1>(a)));
        fn permute(a, index: U32) => _mm256_permutevar8x32_ps(a, index);
    }

    /// 8 u32.
    U32(__m256i): U32Lanes {
        impl Add: add(a, b) => _mm256_add_epi32(a, b);
        impl Sub: sub(a, b) => _mm256_sub_epi32(a, b);
        impl Mul: mul(a, b) => _mm256_mullo_epi32(a, b);
        impl BitAnd: bitand(a, b) => _mm256_and_si256(a, b);
        impl BitOr: bitor(a, b) => _mm256_or_si256(a, b);
        impl BitXor: bitxor(a, b) => _mm256_xor_si256(a, b);
        impl Not: not(a) => _mm256_xor_si256(a, _mm256_set1_epi32(-1));
        fn store(a, to: [u32]) => _mm256_storeu_si256(to.cast(), a);
        fn shl(a, count: u32) => _mm256_sllv_epi32(a, _mm256_set1_epi32(count as i32));
        fn shr(a, count: u32) => _mm256_srlv_epi32(a, _mm256_set1_epi32(count as i32));
        fn sar(a, count: u32) => _mm256_srav_epi32(a, _mm256_set1_epi32(count as i32));
        fn eq(a, b) -> Mask => _mm256_cmpeq_epi32(a, b);
        fn lt_i32(a, b) -> Mask => _mm256_cmpgt_epi32(b, a);
        fn select(a, mask: Mask, b) => _mm256_blendv_epi8(b, a, mask);
        fn i32_to_f32(a) -> F32 => _mm256_cvtepi32_ps(a);
        fn as_f32(a) -> F32 => _mm256_castsi256_ps(a);
        fn permute(a, index: U32) => _mm256_permutevar8x32_epi32(a, index);
    }

    /// 8 f64.
    F64(__m256d, __m256d): F64Lanes {
        impl Add: add(a, b) => _mm256_add_pd(a, b);
        impl Sub: sub(a, b) => _mm256_sub_pd(a, b);
        impl Mul: mul(a, b) => _mm256_mul_pd(a, b);
        fn store(a, to: [f64]) => _mm256_storeu_pd(to, a);
        fn min(a, b) => _mm256_min_pd(a, b);
        fn max(a, b) => _mm256_max_pd(a, b);
        fn floor(a) => _mm256_floor_pd(a);
        fn narrow(low, high) -> F32 => _mm256_set_m128(_mm256_cvtpd_ps(high), _mm256_cvtpd_ps(low));
        fn words(low, high) => {
            let (a, b) = (_mm256_castpd_ps(low), _mm256_castpd_ps(high));
            // Each shuffle works within 128-bit halves, which leaves the pairs as a01 b01 a23 b23.
            let even = _mm256_castps_pd(_mm256_shuffle_ps::<0x88>(a, b));
            let odd = _mm256_castps_pd(_mm256_shuffle_ps::<0xDD>(a, b));
            (
                _mm256_castpd_si256(_mm256_permute4x64_pd::<0xD8>(even)),
                _mm256_castpd_si256(_mm256_permute4x64_pd::<0xD8>(odd)),
            )
        };
    }

    /// 8 truth values, each all ones or all zeros.
    Mask(__m256i): MaskLanes {
        impl BitAnd: bitand(a, b) => _mm256_and_si256(a, b);
        impl BitOr: bitor(a, b) => _mm256_or_si256(a, b);
        impl Not: not(a) => _mm256_xor_si256(a, _mm256_set1_epi32(-1));
        fn to_bits(a) -> u32 => _mm256_movemask_ps(_mm256_castsi256_ps(a)) as u32;
    }
}
