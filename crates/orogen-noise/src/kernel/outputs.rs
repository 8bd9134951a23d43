//! Output slices.

/// Output slices: values, and slopes along x, y, z and w if requested. Their lengths were checked before.
pub(crate) struct Outputs<'a> {
    pub value: &'a mut [f32],
    pub slopes: Option<[&'a mut [f32]; 4]>,
}

impl Outputs<'_> {
    /// Sets all slopes to zero, for a noise without slopes.
    pub(crate) fn flatten(&mut self) {
        for slope in self.slopes.iter_mut().flatten() {
            slope.fill(0.0);
        }
    }

    /// The `count` samples from `start` on. If an axis is missing, the slice of its slopes is empty.
    #[inline(always)]
    pub(crate) fn part(&mut self, start: usize, count: usize) -> Outputs<'_> {
        Outputs {
            value: &mut self.value[start..start + count],
            slopes: self
                .slopes
                .as_mut()
                .map(|slopes| slopes.each_mut().map(|slope| slope.get_mut(start..start + count).unwrap_or_default())),
        }
    }
}
