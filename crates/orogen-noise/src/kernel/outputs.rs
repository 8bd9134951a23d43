//! Where results go.

/// Where results go: values, and slopes along x, y and z where they are wanted. Lengths are checked.
pub(crate) struct Outputs<'a> {
    pub value: &'a mut [f32],
    pub slopes: Option<[&'a mut [f32]; 3]>,
}

impl Outputs<'_> {
    /// The `count` samples from `start` on. In 2D there is no slope along z: that slice is empty.
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
