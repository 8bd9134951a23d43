//! Conversion of metres to integer levels.

use orogen_grid::grid::Grid;

/// Maps a range of heights to all levels of an integer format: `low` becomes 0 and `high` the largest level.
///
/// With an empty range (`low == high`) every height becomes 0, and [`Levels::is_flat`] returns true. Heights outside
/// the range, including infinities, are clamped; NaN becomes 0.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Levels {
    low: f32,
    high: f32,
}

impl Levels {
    /// The range from `low` to `high`, in the unit of the grid. It is flat unless both are finite and `low` is less
    /// than `high`.
    #[must_use]
    pub fn new(low: f32, high: f32) -> Levels {
        match low.is_finite() && high.is_finite() && low < high {
            true => Levels { low, high },
            false if low.is_finite() => Levels { low, high: low },
            false => Levels { low: 0.0, high: 0.0 },
        }
    }

    /// The range of the finite samples of a grid; flat if there are none.
    #[must_use]
    pub fn of(grid: &Grid) -> Levels {
        let [low, high] = extremes(NO_SAMPLES, grid.data());
        Levels::new(low, high)
    }

    /// The height that becomes 0.
    #[must_use]
    pub fn low(&self) -> f32 {
        self.low
    }

    /// The height that becomes the largest level.
    #[must_use]
    pub fn high(&self) -> f32 {
        self.high
    }

    /// Whether the range is empty, so that every level is 0.
    #[must_use]
    pub fn is_flat(&self) -> bool {
        self.low == self.high
    }

    /// The 16-bit level nearest to `height`: 0 at `low`, 65535 at `high`.
    #[must_use]
    pub fn to_u16(&self, height: f32) -> u16 {
        self.level(height, f64::from(u16::MAX)) as u16
    }

    /// The 8-bit level nearest to `height`: 0 at `low`, 255 at `high`.
    #[must_use]
    pub fn to_u8(&self, height: f32) -> u8 {
        self.level(height, f64::from(u8::MAX)) as u8
    }

    /// Appends the levels of samples as bytes: one byte each if `most` is 255, otherwise two, big-endian.
    pub fn append_bytes(&self, bytes: &mut Vec<u8>, samples: &[f32], most: u16) {
        match most {
            255 => bytes.extend(samples.iter().map(|sample| self.to_u8(*sample))),
            _ => bytes.extend(samples.iter().flat_map(|sample| self.to_u16(*sample).to_be_bytes())),
        }
    }

    /// The 16-bit levels of samples as bytes, little-endian.
    #[must_use]
    pub fn to_le_bytes(&self, samples: &[f32]) -> Vec<u8> {
        samples.iter().flat_map(|sample| self.to_u16(*sample).to_le_bytes()).collect()
    }

    /// Computed in f64, where the difference of two f32 and its product with a level neither overflow nor round twice.
    fn level(&self, height: f32, most: f64) -> f64 {
        if height.is_nan() || self.is_flat() {
            return 0.0;
        }
        let (low, high) = (f64::from(self.low), f64::from(self.high));
        let share = (f64::from(height).clamp(low, high) - low) / (high - low);
        (share * most + 0.5).floor()
    }
}

/// The initial value of [`extremes`]: the range of no samples.
pub const NO_SAMPLES: [f32; 2] = [f32::INFINITY, f32::NEG_INFINITY];

/// Extends the range `before` to the minimum and maximum of the finite samples.
#[must_use]
pub fn extremes(before: [f32; 2], samples: &[f32]) -> [f32; 2] {
    let finite = samples.iter().copied().filter(|sample| sample.is_finite());
    finite.fold(before, |[low, high], sample| [low.min(sample), high.max(sample)])
}

#[cfg(test)]
mod tests {
    use super::*;
    use orogen_grid::grid::Window;

    #[test]
    fn ends_and_middle() {
        let levels = Levels::new(-100.0, 300.0);
        for (height, expect) in
            [(-100.0, 0), (300.0, 65535), (100.0, 32768), (-1e30, 0), (f32::INFINITY, 65535), (f32::NAN, 0)]
        {
            assert_eq!(levels.to_u16(height), expect, "{height}");
        }
        assert_eq!((levels.to_u8(-100.0), levels.to_u8(100.0), levels.to_u8(300.0)), (0, 128, 255));
    }

    #[test]
    fn every_level_comes_back_as_itself() {
        let levels = Levels::new(120.5, 3920.25);
        for level in 0..=u16::MAX {
            let height = 120.5 + f64::from(level) / 65535.0 * (3920.25 - 120.5);
            assert_eq!(levels.to_u16(height as f32), level);
        }
    }

    #[test]
    fn a_flat_or_senseless_range_is_flat_and_black() {
        let (inf, nan) = (f32::INFINITY, f32::NAN);
        for (low, high) in [(5.0, 5.0), (5.0, 4.0), (nan, 1.0), (1.0, nan), (-inf, inf), (inf, -inf)] {
            let levels = Levels::new(low, high);
            assert!(levels.is_flat(), "{low} {high}");
            assert_eq!((levels.to_u16(5.0), levels.to_u8(1e9)), (0, 0));
        }
        assert!(Levels::of(&Grid::filled(Window::new(3, 2, 1.0), 7.0)).is_flat());
        assert!(Levels::of(&Grid::filled(Window::new(3, 2, 1.0), nan)).is_flat());
    }

    #[test]
    fn the_widest_range_does_not_overflow() {
        let levels = Levels::new(f32::MIN, f32::MAX);
        assert_eq!((levels.to_u16(f32::MIN), levels.to_u16(0.0), levels.to_u16(f32::MAX)), (0, 32768, 65535));
    }
}
