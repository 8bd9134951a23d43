//! The scalar level of x86-64, in SSE2 registers, which every x86-64 processor has: 4 lanes in one register, f64 in
//! two. Arrays of lanes (see [`crate::Scalar`]) give the same bits, but take longer to compile and to run.
//!
//! SSE2 has no fused multiply-add, no floor and no lookup. Each is emulated in one function that is not inlined,
//! because copies in every body would make the code of the slowest level the largest.

use crate::Level;
use core::arch::x86_64::*;

level! {
    /// The token of SSE2.
    Sse2: 4 lanes, requires [];

    Simd {
        fn f32(value: f32) -> F32 => _mm_set1_ps(value);
        fn u32(value: u32) -> U32 => _mm_set1_epi32(value as i32);
        fn f64(value: f64) -> F64 => _mm_set1_pd(value);
        fn iota() -> U32 => _mm_setr_epi32(0, 1, 2, 3);
        fn load(from: [f32]) -> F32 => _mm_loadu_ps(from);
        fn load_u32(from: [u32]) -> U32 => _mm_loadu_si128(from.cast());
        fn load_f64(from: [f64]) -> F64 => _mm_loadu_pd(from);
    }
    by_hand {
        type Table8 = [f32; 8];
        type Table16 = [f32; 16];
        const LEVEL: Level = Level::Scalar;
        const WIDE_LOOKUP: bool = true;

        #[inline(always)]
        fn table8(self, entries: &[f32; 8]) -> [f32; 8] {
            *entries
        }
        #[inline(always)]
        fn table16(self, entries: &[f32; 16]) -> [f32; 16] {
            *entries
        }
        #[inline(always)]
        fn lookup8(self, table: [f32; 8], index: U32) -> F32 {
            F32(look_up(&table, index.0))
        }
        #[inline(always)]
        fn lookup16(self, table: [f32; 16], index: U32) -> F32 {
            F32(look_up(&table, index.0))
        }
        #[inline(always)]
        fn gather(self, from: &[f32], index: U32) -> F32 {
            self.load(&picked(from, index))
        }
        #[inline(always)]
        fn gather_u32(self, from: &[u32], index: U32) -> U32 {
            self.load_u32(&picked(from, index))
        }
    }

    /// 4 f32.
    F32(__m128): F32Lanes {
        impl Add: add(a, b) => _mm_add_ps(a, b);
        impl Sub: sub(a, b) => _mm_sub_ps(a, b);
        impl Mul: mul(a, b) => _mm_mul_ps(a, b);
        impl Div: div(a, b) => _mm_div_ps(a, b);
        impl Neg: neg(a) => _mm_xor_ps(a, _mm_set1_ps(-0.0));
        fn store(a, to: [f32]) => _mm_storeu_ps(to, a);
        fn mul_add(a, factor, term) => fused(a, factor, term);
        fn neg_mul_add(a, factor, term) => fused(_mm_xor_ps(a, _mm_set1_ps(-0.0)), factor, term);
        fn min(a, b) => _mm_min_ps(a, b);
        fn max(a, b) => _mm_max_ps(a, b);
        fn abs(a) => _mm_andnot_ps(_mm_set1_ps(-0.0), a);
        fn sqrt(a) => _mm_sqrt_ps(a);
        fn floor(a) => floor(a);
        fn lt(a, b) -> Mask => _mm_castps_si128(_mm_cmplt_ps(a, b));
        fn le(a, b) -> Mask => _mm_castps_si128(_mm_cmple_ps(a, b));
        fn eq(a, b) -> Mask => _mm_castps_si128(_mm_cmpeq_ps(a, b));
        fn select(a, mask: Mask, b) => _mm_castsi128_ps(choose(mask, _mm_castps_si128(a), _mm_castps_si128(b)));
        fn to_i32(a) -> U32 => _mm_cvttps_epi32(a);
        fn bits(a) -> U32 => _mm_castps_si128(a);
        fn widen(a) -> F64 => (_mm_cvtps_pd(a), widen_high(a));
        fn permute(a, index: U32) => permute(a, index);
    }

    /// 4 u32.
    U32(__m128i): U32Lanes {
        impl Add: add(a, b) => _mm_add_epi32(a, b);
        impl Sub: sub(a, b) => _mm_sub_epi32(a, b);
        impl Mul: mul(a, b) => {
            // The instruction multiplies only the even lanes.
            let (odd_a, odd_b) = (_mm_srli_epi64::<32>(a), _mm_srli_epi64::<32>(b));
            let even = _mm_shuffle_epi32::<0b10_00>(_mm_mul_epu32(a, b));
            let odd = _mm_shuffle_epi32::<0b10_00>(_mm_mul_epu32(odd_a, odd_b));
            _mm_unpacklo_epi32(even, odd)
        };
        impl BitAnd: bitand(a, b) => _mm_and_si128(a, b);
        impl BitOr: bitor(a, b) => _mm_or_si128(a, b);
        impl BitXor: bitxor(a, b) => _mm_xor_si128(a, b);
        impl Not: not(a) => _mm_xor_si128(a, _mm_set1_epi32(-1));
        fn store(a, to: [u32]) => _mm_storeu_si128(to.cast(), a);
        fn shl(a, count: u32) => _mm_sll_epi32(a, _mm_cvtsi32_si128(count as i32));
        fn shr(a, count: u32) => _mm_srl_epi32(a, _mm_cvtsi32_si128(count as i32));
        fn sar(a, count: u32) => _mm_sra_epi32(a, _mm_cvtsi32_si128(count as i32));
        fn eq(a, b) -> Mask => _mm_cmpeq_epi32(a, b);
        fn lt_i32(a, b) -> Mask => _mm_cmplt_epi32(a, b);
        fn select(a, mask: Mask, b) => choose(mask, a, b);
        fn i32_to_f32(a) -> F32 => _mm_cvtepi32_ps(a);
        fn as_f32(a) -> F32 => _mm_castsi128_ps(a);
        fn permute(a, index: U32) => _mm_castps_si128(permute(_mm_castsi128_ps(a), index));
    }

    /// 4 f64.
    F64(__m128d, __m128d): F64Lanes {
        impl Add: add(a, b) => _mm_add_pd(a, b);
        impl Sub: sub(a, b) => _mm_sub_pd(a, b);
        impl Mul: mul(a, b) => _mm_mul_pd(a, b);
        fn store(a, to: [f64]) => _mm_storeu_pd(to, a);
        fn min(a, b) => _mm_min_pd(a, b);
        fn max(a, b) => _mm_max_pd(a, b);
        fn floor(a) => floor_f64(a);
        fn narrow(low, high) -> F32 => _mm_movelh_ps(_mm_cvtpd_ps(low), _mm_cvtpd_ps(high));
        fn words(low, high) => {
            let (a, b) = (_mm_castpd_ps(low), _mm_castpd_ps(high));
            let (even, odd) = (_mm_shuffle_ps::<0b10_00_10_00>(a, b), _mm_shuffle_ps::<0b11_01_11_01>(a, b));
            (_mm_castps_si128(even), _mm_castps_si128(odd))
        };
    }

    /// 4 truth values, each all ones or all zeros.
    Mask(__m128i): MaskLanes {
        impl BitAnd: bitand(a, b) => _mm_and_si128(a, b);
        impl BitOr: bitor(a, b) => _mm_or_si128(a, b);
        impl Not: not(a) => _mm_xor_si128(a, _mm_set1_epi32(-1));
        fn to_bits(a) -> u32 => _mm_movemask_ps(_mm_castsi128_ps(a)) as u32;
    }
}

/// An expression of intrinsics on values.
macro_rules! sse2 {
    ($expression:expr) => {
        // SAFETY: SSE2 belongs to the x86-64 baseline, so the processor has the instructions. Instructions that read or
        // write memory are in separate blocks.
        unsafe { $expression }
    };
}

/// `a` where the mask is set, otherwise `b`.
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

// The functions that are not inlined have a calling convention that passes vectors in registers, because Rust's own
// convention passes them in memory. They are never called from outside, so this is not a foreign interface.

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

/// `a * b + c` of f32 widened to f64, rounded to odd. Rounded to f32, it is the fused multiply-add (see
/// [`crate::fma`]).
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
        // All ones where the sum was rounded towards zero. The step is 1 there, otherwise -1.
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
        // Numbers from 2^23 on and NaN are their own floor. All others fit in an i32.
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
        // Adding 2^52 rounds a positive number to an integer. Numbers from 2^52 on and NaN are their own floor.
        let near = _mm_or_pd(_mm_sub_pd(_mm_add_pd(size, far), far), sign);
        let down = _mm_sub_pd(near, _mm_and_pd(_mm_cmpgt_pd(near, x), _mm_set1_pd(1.0)));
        let fraction = _mm_castpd_si128(_mm_cmplt_pd(size, far));
        _mm_castsi128_pd(choose(fraction, _mm_castpd_si128(_mm_or_pd(down, sign)), _mm_castpd_si128(x)))
    })
}

/// The entries with these indices. Only the lower bits of an index are used. `N` is a power of two.
#[allow(improper_ctypes_definitions)]
#[inline(never)]
extern "sysv64" fn look_up<const N: usize>(table: &[f32; N], index: __m128i) -> __m128 {
    let [a, b, c, d] = lanes(index).map(|index| table[index as usize % N]);
    sse2!(_mm_setr_ps(a, b, c, d))
}

/// The lanes with these indices.
#[inline(always)]
fn permute(a: __m128, index: __m128i) -> __m128 {
    let mut entries = [0.0; 4];
    // SAFETY: there is room for four values, and the instruction supports any alignment.
    unsafe { _mm_storeu_ps(entries.as_mut_ptr(), a) };
    look_up(&entries, index)
}

/// `from[index]` per lane. An index beyond the end reads the last entry; an empty slice gives 0.
#[inline(always)]
fn picked<T: Copy + Default>(from: &[T], index: U32) -> [T; 4] {
    lanes(index.0).map(|index| from.get(index as usize).or(from.last()).copied().unwrap_or_default())
}
