//! Emulation of the fused multiply-add for machines without the instruction, and other scalar operations.

/// `a * b + c` rounded once, computed in f64. The bits are the same as with the hardware instruction.
///
/// The product of two f32 is exact in f64. Its sum with `c` is computed with *round to odd*: if it is inexact, the last
/// bit is set instead of rounded. 53 bits are more than 2 * 24 + 2, so rounding this sum to f32 gives the correctly
/// rounded result, including subnormals (Boldo and Melquiond, "Emulation of a FMA and correctly rounded sums: proved
/// algorithms using rounding to odd", IEEE Transactions on Computers 57(4), 2008).
#[inline(always)]
#[must_use]
pub fn fma(a: f32, b: f32, c: f32) -> f32 {
    let product = f64::from(a) * f64::from(b);
    let term = f64::from(c);
    let sum = product + term;
    // Knuth's two-sum: `error` is the exact rounding error of `sum`.
    let back = sum - product;
    let error = (product - (sum - back)) + (term - back);
    let bits = sum.to_bits();
    // Comparisons with NaN (infinite operands) are false, so those sums are unchanged.
    let inexact = (error < 0.0) | (error > 0.0);
    // A sum rounded away from zero is moved back towards the exact value; the result must have an odd last bit.
    let away = (error < 0.0) == (sum > 0.0);
    let even = bits & 1 == 0;
    let step = if inexact & even { if away { u64::MAX } else { 1 } } else { 0 };
    f64::from_bits(bits.wrapping_add(step)) as f32
}

/// The largest integer that is not larger than `x`, without the platform's libm.
#[inline(always)]
pub(crate) fn floor32(x: f32) -> f32 {
    // Adding and subtracting 1.5 * 2^23 rounds to an integer. Values from 2^22 on are handled below.
    const MAGIC: f32 = 12_582_912.0;
    let size = f32::from_bits(x.to_bits() & 0x7FFF_FFFF);
    let small = size < 4_194_304.0;
    let whole = if small { (x + MAGIC) - MAGIC } else { trunc32(x) };
    let down = if whole > x { whole - 1.0 } else { whole };
    let signed = f32::from_bits((down.to_bits() & 0x7FFF_FFFF) | (x.to_bits() & 0x8000_0000));
    if size < 8_388_608.0 { signed } else { x }
}

/// Truncation of values from 2^22 to 2^23, which have one fractional bit.
#[inline(always)]
fn trunc32(x: f32) -> f32 {
    f32::from_bits(x.to_bits() & !1)
}

/// The largest integer that is not larger than `x`, without the platform's libm.
#[inline(always)]
pub(crate) fn floor64(x: f64) -> f64 {
    const MAGIC: f64 = 6_755_399_441_055_744.0;
    let size = f64::from_bits(x.to_bits() & 0x7FFF_FFFF_FFFF_FFFF);
    let small = size < 2_251_799_813_685_248.0;
    let whole = if small { (x + MAGIC) - MAGIC } else { f64::from_bits(x.to_bits() & !1) };
    let down = if whole > x { whole - 1.0 } else { whole };
    let signed = f64::from_bits((down.to_bits() & 0x7FFF_FFFF_FFFF_FFFF) | (x.to_bits() & 0x8000_0000_0000_0000));
    if size < 4_503_599_627_370_496.0 { signed } else { x }
}

/// Truncation to i32. NaN and values out of range give `i32::MIN`, as on x86.
#[inline(always)]
pub(crate) fn to_i32(x: f32) -> i32 {
    if (-2_147_483_648.0..2_147_483_648.0).contains(&x) { x as i32 } else { i32::MIN }
}
