//! Interpolation of missing samples.

/// Fills every NaN. A pyramid of means over two by two samples is built from the existing samples. From the top down,
/// each missing sample is interpolated bilinearly from the next coarser level. The filled surface is smooth from rim to
/// rim. Existing heights do not change. The time is O(samples).
///
/// Returns the number of samples that were missing. If all samples are missing, they stay missing.
pub fn fill(heights: &mut Vec<f32>, width: usize, height: usize) -> usize {
    let missing = heights.iter().filter(|height| height.is_nan()).count();
    if missing == 0 || missing == heights.len() {
        return missing;
    }
    let mut finer: Vec<Level> = Vec::new();
    let mut level = Level { width, height, heights: std::mem::take(heights) };
    while level.heights.iter().any(|height| height.is_nan()) {
        let coarser = level.halved();
        finer.push(std::mem::replace(&mut level, coarser));
    }
    while let Some(mut fine) = finer.pop() {
        fine.complete(&level);
        level = fine;
    }
    *heights = level.heights;
    missing
}

struct Level {
    width: usize,
    height: usize,
    heights: Vec<f32>,
}

impl Level {
    /// The level with half the samples along each side. Each sample is the mean of the existing ones among its four
    /// samples.
    fn halved(&self) -> Level {
        let (width, height) = (self.width.div_ceil(2), self.height.div_ceil(2));
        let mut heights = Vec::with_capacity(width * height);
        for j in 0..height {
            for i in 0..width {
                let (mut sum, mut count) = (0.0f64, 0.0f64);
                for y in 2 * j..(2 * j + 2).min(self.height) {
                    for x in 2 * i..(2 * i + 2).min(self.width) {
                        let sample = self.heights[y * self.width + x];
                        if !sample.is_nan() {
                            sum += f64::from(sample);
                            count += 1.0;
                        }
                    }
                }
                heights.push((sum / count) as f32);
            }
        }
        Level { width, height, heights }
    }

    /// Fills missing samples from a complete level with half the samples along each side.
    fn complete(&mut self, coarse: &Level) {
        for j in 0..self.height {
            for i in 0..self.width {
                let sample = &mut self.heights[j * self.width + i];
                if sample.is_nan() {
                    *sample = coarse.between(i, j);
                }
            }
        }
    }

    /// The value at sample (i, j) of the next finer level. Its center is a quarter of a cell away from the center of
    /// the nearest sample of this level.
    fn between(&self, i: usize, j: usize) -> f32 {
        let pair = |k: usize, side: usize| {
            let near = (k / 2).min(side - 1);
            let far = if k.is_multiple_of(2) { near.saturating_sub(1) } else { (near + 1).min(side - 1) };
            (near, far)
        };
        let ((x, far_x), (y, far_y)) = (pair(i, self.width), pair(j, self.height));
        let at = |x: usize, y: usize| f64::from(self.heights[y * self.width + x]);
        let near = 0.75 * at(x, y) + 0.25 * at(far_x, y);
        let far = 0.75 * at(x, far_y) + 0.25 * at(far_x, far_y);
        (0.75 * near + 0.25 * far) as f32
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_hole_in_a_plane_is_nearly_the_plane() {
        let plane = |k: usize| (k % 40) as f32 * 2.0 - (k / 40) as f32;
        let mut heights: Vec<f32> = (0..40 * 30).map(plane).collect();
        for k in (0..heights.len()).filter(|k| (15..21).contains(&(k % 40)) && (9..15).contains(&(k / 40))) {
            heights[k] = f32::NAN;
        }
        assert_eq!(fill(&mut heights, 40, 30), 36);
        for (k, height) in heights.iter().enumerate() {
            let hole = (15..21).contains(&(k % 40)) && (9..15).contains(&(k / 40));
            assert!((height - plane(k)).abs() <= if hole { 6.0 } else { 0.0 }, "{k}: {height} {}", plane(k));
        }
    }

    #[test]
    fn one_height_is_enough_and_none_stays_none() {
        let mut heights = vec![f32::NAN; 35];
        assert_eq!(fill(&mut heights, 7, 5), 35);
        assert!(heights.iter().all(|height| height.is_nan()));
        heights[30] = 12.5;
        assert_eq!(fill(&mut heights, 7, 5), 34);
        assert_eq!(heights, [12.5; 35]);
    }
}
