//! The conversion of stored samples to heights in metres.

/// The most common nodata values, which files often do not declare.
const COMMON_NODATA: [f64; 3] = [-32768.0, -9999.0, -32767.0];

/// Stored values above this are nodata, whatever a file declares, because some programs write the largest float.
const HIGHEST: f64 = 1e30;

/// The conversion of stored samples to heights in metres. It records the unusual values that it encounters.
#[derive(Debug, Clone, PartialEq)]
pub struct Conversion {
    nodata: Vec<f64>,
    whole: Option<[f64; 2]>,
    linear: Linear,
    /// The name of the unit, if it is not a known length.
    unknown: Option<String>,
    seen: Seen,
}

/// Heights in metres are `(sample * scale + offset) * metres`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Linear {
    /// The scale of the samples.
    pub scale: f64,
    /// The offset that is added to the scaled samples.
    pub offset: f64,
    /// Metres per unit.
    pub metres: f64,
}

/// Undeclared nodata values that were found among samples.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
struct Seen {
    common: [bool; COMMON_NODATA.len()],
    huge: bool,
}

impl Conversion {
    /// A conversion in which samples with one of the values `nodata` are missing. If `whole` is given, samples become
    /// integers in that range. `unknown` is their unit, if it is not a known length.
    #[must_use]
    pub fn new(nodata: Vec<f64>, whole: Option<[f64; 2]>, linear: Linear, unknown: Option<String>) -> Conversion {
        Conversion { nodata, whole, linear, unknown, seen: Seen::default() }
    }

    /// The height of a stored sample of `size` bytes, in metres; NaN if it is missing.
    pub fn height(&mut self, value: f64, size: usize) -> f32 {
        // Some programs write nodata values with fewer digits than the float has.
        let is = |nodata: &f64| value == *nodata || size == 4 && value as f32 == *nodata as f32;
        if value.is_nan() || self.nodata.iter().any(is) {
            return f32::NAN;
        }
        let value = match self.whole {
            Some([least, greatest]) => (value + 0.5).floor().clamp(least, greatest),
            None => value,
        };
        if self.whole.is_some() && self.nodata.contains(&value) {
            return f32::NAN;
        }
        if value.abs() >= HIGHEST {
            self.seen.huge = true;
            return f32::NAN;
        }
        if value <= COMMON_NODATA[1] {
            COMMON_NODATA.iter().zip(&mut self.seen.common).for_each(|(common, seen)| *seen |= value == *common);
        }
        if self.linear.scale == 1.0 && self.linear.offset == 0.0 && self.linear.metres == 1.0 {
            return value as f32;
        }
        ((value * self.linear.scale + self.linear.offset) * self.linear.metres) as f32
    }

    /// The height of samples that a file does not store, such as absent blocks. As in GDAL, they are missing if the
    /// band has a nodata value; otherwise they have the height of the value 0.
    #[must_use]
    pub fn absent(&self) -> f32 {
        match self.nodata.is_empty() {
            true => (self.linear.offset * self.linear.metres) as f32,
            false => f32::NAN,
        }
    }

    /// The heights of the stored samples 0 and `most`.
    #[must_use]
    pub fn range(&self, most: f64) -> [f64; 2] {
        [0.0, most].map(|value| (value * self.linear.scale + self.linear.offset) * self.linear.metres)
    }

    /// Converts samples that a reader has stored as f32, in place.
    pub fn apply(&mut self, samples: &mut [f32]) {
        samples.iter_mut().for_each(|sample| *sample = self.height(f64::from(*sample), 4));
    }

    /// [`notes`](Conversion::notes) about the heights that are left after a mask was applied.
    #[must_use]
    pub fn notes_of(mut self, heights: &[f32]) -> Vec<String> {
        for (common, seen) in COMMON_NODATA.iter().zip(&mut self.seen.common).filter(|(_, seen)| **seen) {
            let height = ((common * self.linear.scale + self.linear.offset) * self.linear.metres) as f32;
            *seen = heights.contains(&height);
        }
        self.notes()
    }

    /// Messages about unusual units and values.
    #[must_use]
    pub fn notes(&self) -> Vec<String> {
        let mut notes = Vec::new();
        if let Some(unit) = &self.unknown {
            notes.push(format!(
                "the unit of its samples is `{}`, which is not a known length; they were read as metres",
                unit.escape_debug()
            ));
        }
        for (value, _) in COMMON_NODATA.iter().zip(self.seen.common).filter(|(_, seen)| *seen) {
            notes.push(format!(
                "some of its samples are {value}, a common nodata value that it does not declare, and were read as heights; if they are missing, declare it, for example with gdal_translate -a_nodata {value}"
            ));
        }
        if self.seen.huge {
            notes.push(
                "some of its samples are beyond 1e30, which it does not declare as nodata; they were read as missing"
                    .into(),
            );
        }
        notes
    }
}
