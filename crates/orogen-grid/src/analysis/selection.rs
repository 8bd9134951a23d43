//! Masks that select a range of values with smooth ends.

/// A weight that is 1 within a range and decreases smoothly to 0 on both sides of it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Selection {
    low: f32,
    high: f32,
    below: f32,
    above: f32,
}

impl Selection {
    /// A weight of 1 from `range[0]` to `range[1]`. It reaches 0 at `falloff[0]` below and at `falloff[1]` above the
    /// range. A fall-off of 0 is a sharp end.
    #[must_use]
    pub fn new(range: [f64; 2], falloff: [f64; 2]) -> Selection {
        let [low, high] = range.map(|bound| bound as f32);
        let [below, above] = falloff.map(|width| width as f32);
        Selection { low, high, below, above }
    }

    /// The lower and the upper end of the range, and the widths of the fall-offs below and above it.
    #[doc(hidden)]
    #[must_use]
    pub fn numbers(&self) -> [f32; 4] {
        [self.low, self.high, self.below, self.above]
    }

    /// The weight of a value, 0 to 1; 0 for NaN.
    #[must_use]
    pub fn of(&self, value: f32) -> f32 {
        if value >= self.low && value <= self.high {
            1.0
        } else if value < self.low {
            fall(self.low - value, self.below)
        } else {
            fall(value - self.high, self.above)
        }
    }
}

/// Hermite's smoothstep from 1 at 0 to 0 at `width`; 0 for NaN.
fn fall(beyond: f32, width: f32) -> f32 {
    if beyond < width {
        let t = 1.0 - beyond / width;
        t * t * (3.0 - 2.0 * t)
    } else {
        0.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_is_one_within_and_falls_to_both_sides() {
        let selection = Selection::new([10.0, 20.0], [4.0, 0.0]);
        for (value, expect) in [
            (10.0, 1.0),
            (20.0, 1.0),
            (15.0, 1.0),
            (8.0, 0.5),
            (6.0, 0.0),
            (5.0, 0.0),
            (20.0f32.next_up(), 0.0),
            (f32::NAN, 0.0),
            (f32::INFINITY, 0.0),
            (f32::NEG_INFINITY, 0.0),
        ] {
            assert_eq!(selection.of(value), expect, "{value}");
        }
        let falling: Vec<f32> = (0..40).map(|k| selection.of(6.0 + k as f32 * 0.1)).collect();
        assert!(falling.windows(2).all(|pair| pair[0] < pair[1]), "{falling:?}");
    }
}
