//! Vectorized powers of positive numbers.

/// x to the power y, accurate to a few parts in a million, for x from 1e-37 to 1e37. It uses only sums, products and
/// bit operations, so it gives the same bits on every machine and can be vectorized.
#[inline(always)]
#[must_use]
pub fn power(x: f32, y: f32) -> f32 {
    exp2(y * log2(x))
}

/// The base-2 logarithm.
#[inline(always)]
fn log2(x: f32) -> f32 {
    // x = m 2^e with m from sqrt(1/2) to sqrt(2); 0x3F35_04F3 are the bits of the former.
    let bits = x.to_bits().wrapping_sub(0x3F35_04F3);
    let exponent = (bits as i32) >> 23;
    let m = f32::from_bits((bits & 0x007F_FFFF).wrapping_add(0x3F35_04F3));
    // ln m = 2 artanh((m - 1) / (m + 1)), with a short series.
    let t = (m - 1.0) / (m + 1.0);
    let s = t * t;
    let series = ((((0.222_222_2 * s + 0.285_714_3) * s + 0.4) * s + 0.666_666_7) * s + 2.0) * t;
    exponent as f32 + series * std::f32::consts::LOG2_E
}

/// 2 to the power y; y is clamped to -126 ..= 127.
#[inline(always)]
fn exp2(y: f32) -> f32 {
    // After adding 1.5 * 2^23, the integer part of a number is in the low bits.
    const WHOLE: f32 = 12_582_912.0;
    let y = if y > -126.0 { y } else { -126.0 };
    let y = if y < 127.0 { y } else { 127.0 };
    let shifted = y + WHOLE;
    let f = (y - (shifted - WHOLE)) * std::f32::consts::LN_2;
    let series = (((((1.0 / 720.0) * f + 1.0 / 120.0) * f + 1.0 / 24.0) * f + 1.0 / 6.0) * f + 0.5) * f + 1.0;
    let series = series * f + 1.0;
    f32::from_bits(series.to_bits().wrapping_add(shifted.to_bits() << 23))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_is_the_librarys_within_a_few_parts_in_a_million() {
        for k in 0..4000 {
            let x = libm::exp(-60.0 + 0.03 * f64::from(k)) as f32;
            for y in [0.0f32, 0.1, 0.3, 0.45, 0.5, 1.0, 1.3, -0.5] {
                let (got, expect) = (f64::from(power(x, y)), libm::pow(f64::from(x), f64::from(y)));
                assert!((got / expect - 1.0).abs() < 1e-5, "{x} to the power {y}: {got}, not {expect}");
            }
        }
        assert_eq!((power(1.0, 0.45), power(4.0, 0.5)), (1.0, 2.0));
    }
}
