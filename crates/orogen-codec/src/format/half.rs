//! 16-bit floats (IEEE 754 binary16), which some engines use for heights. They have 11 bits of precision, so heights
//! above 2048 m have steps of 2 m.

/// The nearest half, ties to even. Values of 65520 and more become infinite; NaN stays NaN.
#[must_use]
pub fn from_f32(value: f32) -> u16 {
    let bits = value.to_bits();
    let sign = (bits >> 16) as u16 & 0x8000;
    let magnitude = bits & 0x7fff_ffff;
    if magnitude > 0x7f80_0000 {
        return sign | 0x7e00;
    }
    // 65520 is the smallest value that rounds to infinity.
    if magnitude >= 0x477f_f000 {
        return sign | 0x7c00;
    }
    if magnitude < 0x3880_0000 {
        // Numbers below the smallest normal half have steps of 2^-24.
        let steps = f64::from(f32::from_bits(magnitude)) * 16_777_216.0;
        return sign | steps.round_ties_even() as u16;
    }
    let rounded = magnitude + 0x0fff + ((magnitude >> 13) & 1);
    sign | ((rounded - 0x3800_0000) >> 13) as u16
}

/// The value of a half.
#[must_use]
pub fn to_f32(half: u16) -> f32 {
    let sign = if half & 0x8000 != 0 { -1.0f32 } else { 1.0 };
    let (exponent, fraction) = (u32::from(half >> 10) & 31, u32::from(half & 0x3ff));
    match exponent {
        0 => sign * (fraction as f32 / 16_777_216.0),
        31 if fraction != 0 => f32::NAN,
        31 => sign * f32::INFINITY,
        _ => sign * f32::from_bits((exponent + 112) << 23 | fraction << 13),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_half_comes_back_as_itself() {
        for half in 0..=u16::MAX {
            let back = from_f32(to_f32(half));
            assert!(back == half || to_f32(half).is_nan() && to_f32(back).is_nan(), "{half:#x}: {back:#x}");
        }
    }

    #[test]
    fn others_go_to_the_nearest_and_ties_to_even() {
        for half in 0..0x7bffu16 {
            let (low, high) = (to_f32(half), to_f32(half + 1));
            let middle = ((f64::from(low) + f64::from(high)) / 2.0) as f32;
            assert_eq!(from_f32(middle), if half % 2 == 0 { half } else { half + 1 }, "{middle}");
            assert_eq!((from_f32(middle.next_down()), from_f32(middle.next_up())), (half, half + 1));
        }
        assert_eq!((from_f32(65519.996), from_f32(65520.0), from_f32(-1e9)), (0x7bff, 0x7c00, 0xfc00));
        assert_eq!(to_f32(from_f32(3001.0)), 3000.0);
    }
}
