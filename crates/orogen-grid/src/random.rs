//! Pseudo-random numbers that are the same on every machine.

/// The finaliser of splitmix64 (Steele, Lea and Flood, "Fast splittable pseudorandom number generators", 2014): every
/// bit of the result depends on every bit of the argument.
#[inline(always)]
#[must_use]
pub const fn mix64(mut z: u64) -> u64 {
    z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
    z ^ (z >> 31)
}

/// The step of splitmix64's state: 2^64 divided by the golden ratio.
pub const STEP: u64 = 0x9E37_79B9_7F4A_7C15;

/// A generator with 64 bits of state: splitmix64.
#[derive(Debug, Clone)]
pub struct Random(u64);

impl Random {
    /// A generator with a separate sequence for each pair of `seed` and `stream`.
    #[must_use]
    pub fn new(seed: u64, stream: u64) -> Random {
        let mut random = Random(seed ^ stream.wrapping_mul(0xD1B5_4A32_D192_ED03));
        random.0 = random.draw().wrapping_add(stream);
        random
    }

    /// A generator that continues the sequence of splitmix64 from `state`.
    #[must_use]
    pub const fn of_state(state: u64) -> Random {
        Random(state)
    }

    /// The next 64 bits.
    #[inline]
    pub fn draw(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(STEP);
        mix64(self.0)
    }

    /// A random number in `0..n`.
    #[inline]
    pub fn below(&mut self, n: usize) -> usize {
        ((u128::from(self.draw()) * n as u128) >> 64) as usize
    }

    /// A random number from 0 (included) to 1 (excluded), in steps of 2^-53.
    #[inline]
    pub fn share(&mut self) -> f64 {
        (self.draw() >> 11) as f64 / (1u64 << 53) as f64
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_sequence_is_that_of_the_reference() {
        // The first numbers of S. Vigna's splitmix64.c for the state 1234567.
        let mut random = Random::of_state(1_234_567);
        let expect = [6_457_827_717_110_365_317, 3_203_168_211_198_807_973, 9_817_491_932_198_370_423];
        assert_eq!(expect.map(|_| random.draw()), expect);
        assert!((0..1000).map(|_| random.share()).all(|share| (0.0..1.0).contains(&share)));
        assert!((0..1000).map(|_| random.below(7)).all(|number| number < 7));
    }
}
