//! Wavelengths that fit into a picture a whole number of times.

/// Period of a picture in samples, along x, y and the depth; 0 where it does not repeat.
pub type Lengths = [f64; 3];

/// The adjusted wavelengths of a noise.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Fit {
    /// Number of wavelengths along x, y and the depth; 0 where the noise does not repeat.
    pub cells: [u32; 3],
    /// Distance between samples in the noise's unit: 1 if a whole number of wavelengths fits without adjustment.
    pub steps: [f64; 3],
}

impl Fit {
    /// Rounds a wavelength along each axis so that a whole number of them fits, at least one.
    pub fn new(wavelength: f64, lengths: Lengths) -> Fit {
        // Numbers beyond u32 are too large for any lattice as well, and the noise reports them.
        let cells = lengths.map(|length| if length > 0.0 { (length / wavelength).round().max(1.0) as u32 } else { 0 });
        let step = |axis: usize| match lengths[axis] {
            length if length > 0.0 => f64::from(cells[axis]) * wavelength / length,
            _ => 1.0,
        };
        Fit { cells, steps: [step(0), step(1), step(2)] }
    }

    /// The wavelength along x and y, in samples.
    pub fn wavelengths(&self, wavelength: f64) -> [f64; 2] {
        [wavelength / self.steps[0], wavelength / self.steps[1]]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn whole_numbers_of_wavelengths_fit() {
        for (wavelength, lengths, cells, steps) in [
            (64.0, [512.0, 256.0, 0.0], [8, 4, 0], [1.0, 1.0, 1.0]),
            (60.0, [512.0, 100.0, 30.0], [9, 2, 1], [540.0 / 512.0, 1.2, 2.0]),
            (1000.0, [1.0, 500.0, 0.0], [1, 1, 0], [1000.0, 2.0, 1.0]),
            (64.0, [0.0; 3], [0; 3], [1.0; 3]),
            (
                1e-300,
                [512.0, 1.0, 0.0],
                [u32::MAX, u32::MAX, 0],
                [f64::from(u32::MAX) * 1e-300 / 512.0, f64::from(u32::MAX) * 1e-300, 1.0],
            ),
        ] {
            assert_eq!(Fit::new(wavelength, lengths), Fit { cells, steps }, "{wavelength} {lengths:?}");
        }
        assert_eq!(Fit::new(60.0, [512.0, 100.0, 0.0]).wavelengths(60.0), [512.0 / 9.0, 50.0]);
    }
}
