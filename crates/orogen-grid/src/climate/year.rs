//! The temperatures of the months of a year.

/// The temperatures of a year, as a sine wave.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Year {
    /// Mean temperature, in degrees C.
    pub mean: f64,
    /// Half the difference between the warmest and the coldest month, in K; not negative.
    pub range: f64,
}

/// cos(k 30 degrees) for k = 0 ..= 6.
const COSINES: [f64; 7] = [1.0, 0.866_025_403_784_438_6, 0.5, 0.0, -0.5, -0.866_025_403_784_438_6, -1.0];

impl Year {
    /// Mean temperatures of the twelve months, in degrees C, from the warmest (0) to the coldest (6) and back.
    #[must_use]
    pub fn months(&self) -> [f64; 12] {
        std::array::from_fn(|month| self.mean + self.range * cosine(month))
    }

    /// Mean temperature of the warmest month, in degrees C.
    #[must_use]
    pub fn warmest(&self) -> f64 {
        self.mean + self.range
    }

    /// Mean temperature of the coldest month, in degrees C.
    #[must_use]
    pub fn coldest(&self) -> f64 {
        self.mean - self.range
    }

    /// Biotemperature, in degrees C: the mean of the monthly temperatures, each clamped to 0 to 30 degrees C (Holdridge
    /// 1967).
    #[must_use]
    pub fn biotemperature(&self) -> f64 {
        self.months().iter().map(|month| month.clamp(0.0, 30.0)).sum::<f64>() / 12.0
    }
}

/// The cosine of a month's phase in the year, 1 in the warmest month.
pub(super) fn cosine(month: usize) -> f64 {
    COSINES[month.min(12 - month)]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_months_have_the_mean_and_the_range() {
        let year = Year { mean: 7.0, range: 11.0 };
        let months = year.months();
        assert!((months.iter().sum::<f64>() / 12.0 - 7.0).abs() < 1e-12);
        assert_eq!([months[0], months[3], months[6], months[9]], [18.0, 7.0, -4.0, 7.0]);
        assert_eq!([year.warmest(), year.coldest()], [18.0, -4.0]);
    }

    #[test]
    fn months_below_zero_do_not_count_as_negative() {
        assert_eq!(Year { mean: 12.0, range: 3.0 }.biotemperature(), 12.0);
        assert_eq!(Year { mean: -20.0, range: 10.0 }.biotemperature(), 0.0);
        let cold = Year { mean: 0.0, range: 12.0 }.biotemperature();
        assert!((cold - 12.0 * (1.0 + 2.0 * (0.866_025_4 + 0.5)) / 12.0).abs() < 1e-6, "{cold}");
        assert!(Year { mean: 35.0, range: 0.0 }.biotemperature() == 30.0);
    }
}
