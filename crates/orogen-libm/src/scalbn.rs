//! Powers of two as factors.

macro_rules! scalbn {
    ($name:ident, $float:ident, $bits:ident) => {
        /// `x * 2^n`, rounded once.
        #[inline]
        pub(crate) fn $name(mut x: $float, mut n: i32) -> $float {
            const SIG_BITS: u32 = $float::MANTISSA_DIGITS - 1;
            const EXP_MAX: i32 = $float::MAX_EXP - 1;
            const EXP_MIN: i32 = 1 - EXP_MAX;
            // 2^EXP_MAX, the largest power of two.
            const F_EXP_MAX: $float = $float::from_bits(((2 * EXP_MAX) as $bits) << SIG_BITS);
            // The factor on the way down is not 2^EXP_MIN, so that no x becomes subnormal before the last
            // multiplication: it would be rounded twice.
            const ADD: i32 = -EXP_MIN - $float::MANTISSA_DIGITS as i32;
            const MUL: $float = $float::from_bits(((EXP_MAX - ADD) as $bits) << SIG_BITS);

            if n > EXP_MAX {
                x *= F_EXP_MAX;
                n -= EXP_MAX;
                if n > EXP_MAX {
                    x *= F_EXP_MAX;
                    n -= EXP_MAX;
                    if n > EXP_MAX {
                        n = EXP_MAX;
                    }
                }
            } else if n < EXP_MIN {
                x *= MUL;
                n += ADD;
                if n < EXP_MIN {
                    x *= MUL;
                    n += ADD;
                    if n < EXP_MIN {
                        n = EXP_MIN;
                    }
                }
            }
            x * $float::from_bits(((EXP_MAX + n) as $bits) << SIG_BITS)
        }
    };
}

scalbn!(scalbn, f64, u64);
scalbn!(scalbnf, f32, u32);
