//! Powers of many numbers with one exponent, with the bits of `libm::powf`.

use orogen_simd::{Body, Simd, dispatch};

/// Raises each base to the exponent: the bits of `libm::powf` on every machine.
///
/// If the base is in 2^-12 .. 1 and the exponent in 0.1 .. 10, which is the usual case, several bases are processed
/// together.
pub(super) fn raise(bases: &mut [f32], exponent: f32) {
    // Exponents that libm handles separately, and exponents whose powers may be too small for the fast path.
    if !(0.1..=10.0).contains(&exponent) || [0.5, 1.0, 2.0].contains(&exponent) {
        bases.iter_mut().for_each(|base| *base = libm::powf(*base, exponent));
        return;
    }
    for bases in bases.chunks_mut(CHUNK) {
        let mut powers = [0.0; CHUNK];
        dispatch(Powers { bases, exponent, out: &mut powers[..bases.len()] });
        for (base, power) in bases.iter_mut().zip(powers) {
            *base = if (LEAST..1.0).contains(base) { power } else { libm::powf(*base, exponent) };
        }
    }
}

const CHUNK: usize = 256;

/// 2^-12: the smallest base whose tenth power is a normal number.
const LEAST: f32 = 1.0 / 4096.0;

struct Powers<'a> {
    bases: &'a [f32],
    exponent: f32,
    out: &'a mut [f32],
}

impl Body for Powers<'_> {
    type Output = ();

    #[inline(always)]
    fn run<S: Simd>(self, _: S) {
        for (out, base) in self.out.iter_mut().zip(self.bases) {
            *out = power(*base, self.exponent);
        }
    }
}

/// The upper bits of a number: the product of two such numbers is exact.
#[inline(always)]
fn upper(x: f32, bits: u32) -> f32 {
    f32::from_bits(x.to_bits() & bits)
}

/// The algorithm of `libm::powf` (after e_powf.c of FreeBSD's msun, Sun Microsystems 1993) without its branches, for
/// bases from [`LEAST`] to 1 and exponents from 0.1 to 10.
#[inline(always)]
fn power(x: f32, y: f32) -> f32 {
    const HIGH: u32 = 0xFFFF_F000;
    // x = 2^n ax with ax near 1 or 1.5.
    let bits = x.to_bits();
    let mantissa = bits & 0x007F_FFFF;
    let (upper_third, middle) = (mantissa >= 0x005D_B3D7, mantissa > 0x001C_C471 && mantissa < 0x005D_B3D7);
    let n = (bits >> 23) as i32 - 0x7F + i32::from(upper_third);
    let ix = (mantissa | 0x3F80_0000) - if upper_third { 0x0080_0000 } else { 0 };
    let ax = f32::from_bits(ix);
    let (bp, dp_high, dp_low) = if middle { (1.5, 5.849_609_4e-1, 1.563_220_9e-6) } else { (1.0, 0.0, 0.0) };
    // s = (ax - bp) / (ax + bp), in two parts.
    let u = ax - bp;
    let v = 1.0 / (ax + bp);
    let s = u * v;
    let s_high = upper(s, HIGH);
    let t_high = f32::from_bits((((ix >> 1) & HIGH) | 0x2000_0000).wrapping_add(0x0040_0000).wrapping_add(if middle {
        1 << 21
    } else {
        0
    }));
    let t_low = ax - (t_high - bp);
    let s_low = v * ((u - s_high * t_high) - s_high * t_low);
    // The logarithm of ax, in two parts.
    let s2 = s * s;
    let series = s2 * 2.069_750_1e-1;
    let series = s2 * (2.306_607_5e-1 + series);
    let series = s2 * (2.727_281_2e-1 + series);
    let series = s2 * (3.333_333_4e-1 + series);
    let series = s2 * (4.285_714_3e-1 + series);
    let r = s2 * s2 * (0.6 + series) + s_low * (s_high + s);
    let s2 = s_high * s_high;
    let t_high = upper(3.0 + s2 + r, HIGH);
    let t_low = r - ((t_high - 3.0) - s2);
    let u = s_high * t_high;
    let v = s_low * t_high + t_low * s;
    let p_high = upper(u + v, HIGH);
    let p_low = v - (p_high - u);
    let z_high = 9.619_140_6e-1 * p_high;
    let z_low = -1.173_685_74e-4 * p_high + p_low * 9.617_967e-1 + dp_low;
    let t = n as f32;
    let t1 = upper(((z_high + z_low) + dp_high) + t, HIGH);
    let t2 = z_low - (((t1 - t) - dp_high) - z_high);
    // Multiplied by the exponent.
    let y1 = upper(y, HIGH);
    let p_low = (y - y1) * t1 + y * t2;
    let p_high = y1 * t1;
    let z = p_low + p_high;
    // 2 to that power: an integer and a remainder of at most a half. z is negative.
    let size = z.abs();
    let whole = if size > 0.5 { (size + 0.5) as i32 } else { 0 };
    let p_high = p_high + whole as f32;
    let t = upper(p_low + p_high, 0xFFFF_8000);
    let u = t * 6.931_457_5e-1;
    let v = (p_low - (t - p_high)) * 6.931_472e-1 + t * 1.428_606_5e-6;
    let z = u + v;
    let w = v - (z - u);
    let t = z * z;
    let series = t * 4.138_137e-8;
    let series = t * (-1.653_390_2e-6 + series);
    let series = t * (6.613_756e-5 + series);
    let series = t * (-2.777_777_8e-3 + series);
    let t1 = z - t * (1.666_666_7e-1 + series);
    let r = (z * t1) / (t1 - 2.0) - (w + z * w);
    let z = 1.0 - (r - z);
    f32::from_bits(z.to_bits().wrapping_sub((whole as u32) << 23))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn powers_have_the_bits_of_libm() {
        // Every 97th number from 0 to above 1, and the limits of the fast path.
        let ends =
            [0.0, -0.0, LEAST, 1.0, 1.0f32.next_down(), LEAST.next_down(), f32::NAN, f32::INFINITY, -0.5, 7.0, 1e-40];
        let bases: Vec<f32> = (0..0x3F90_0000u32).step_by(97).map(f32::from_bits).chain(ends).collect();
        for exponent in [1.5, 0.1, 10.0, 0.7, 3.0, 1.000_01, 2.0, 1.0, 0.5, 20.0, -1.5] {
            let exponent = exponent as f32;
            let stride = if exponent == 1.5 { 1 } else { 41 };
            let mut powers: Vec<f32> = bases.iter().copied().step_by(stride).chain(ends).collect();
            let expect: Vec<u32> = powers.iter().map(|base| libm::powf(*base, exponent).to_bits()).collect();
            let from = powers.clone();
            raise(&mut powers, exponent);
            for ((power, expect), base) in powers.iter().zip(expect).zip(from) {
                assert!(
                    power.to_bits() == expect || power.is_nan() && f32::from_bits(expect).is_nan(),
                    "{base}^{exponent}"
                );
            }
        }
    }
}
