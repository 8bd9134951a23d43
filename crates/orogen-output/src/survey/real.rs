//! Statistics that distinguish real from generated terrain, with their ranges in real terrain.

use super::measures::Measures;
use orogen_grid::analysis::geomorphons::FORMS;

/// A statistic of a terrain.
#[derive(Debug, Clone, Copy)]
pub struct Figure {
    /// The key in JSON.
    pub key: &'static str,
    /// The name for users.
    pub name: &'static str,
    /// The unit, or empty.
    pub unit: &'static str,
    /// Number of decimals.
    pub digits: usize,
    /// The 10 %, 50 % and 90 % quantiles over windows of real terrain.
    pub real: [f64; 3],
    /// The value from measurements.
    pub of: fn(&Measures) -> Option<f64>,
}

/// The source of the ranges of [`FIGURES`], for users.
pub const SOURCE: &str =
    "38 windows of 256 x 256 cells of eight real places, 30 to 90 m (SRTM and USGS; docs/analysis.md)";

macro_rules! figures {
    ($( $key:literal, $name:literal, $unit:literal, $digits:literal, [$($real:literal),+], |$m:ident| $of:expr; )*) => {
        &[$( Figure {
            key: $key, name: $name, unit: $unit, digits: $digits, real: [$($real),+], of: |$m: &Measures| Some($of),
        }, )*]
    };
}

/// All statistics, in the order of the table. The ranges were measured by `orogen analyze` on every window of 256 x 256
/// cells without missing heights, from the eight places that docs/analysis.md names.
pub static FIGURES: &[Figure] = figures![
    "relief", "relief", "m", 0, [683.0, 1022.0, 2264.0], |m| m.relief;
    "hypsometric_integral", "hypsometric integral", "", 3, [0.26, 0.432, 0.705], |m| m.hypsometric_integral;
    "slope_mean", "mean slope", "deg", 1, [7.09, 16.5, 24.0], |m| m.slope_mean;
    "slope_p90", "slope, 90th percentile", "deg", 1, [14.5, 30.2, 36.7], |m| m.slope_p90;
    "slope_spread", "spread of slopes", "", 3, [0.396, 0.647, 0.889], |m| m.slope_spread;
    "slope_patches", "patchiness of slopes", "", 3, [0.16, 0.322, 0.597], |m| m.slope_patches;
    "ruggedness", "ruggedness", "m", 1, [8.73, 10.4, 32.0], |m| m.ruggedness;
    "curvature", "curvature", "1/km", 2, [1.19, 4.24, 8.13], |m| m.curvature;
    "curvature_skew", "concave against convex", "", 3, [-0.128, -0.0349, 0.0318], |m| m.curvature_skew;
    "spectrum", "spectral exponent", "", 2, [3.45, 4.08, 4.38], |m| m.spectrum?;
    "hurst", "Hurst exponent", "", 3, [0.69, 0.758, 0.825], |m| m.hurst?;
    "grid_bias", "grid bias of aspects", "", 3, [0.0032, 0.00662, 0.0113], |m| m.grid_bias;
    "depressions", "ground in depressions", "%", 2, [0.137, 2.77, 6.7], |m| 100.0 * m.water.depressions;
    "depression_depth", "their mean depth", "m", 2, [1.66, 2.92, 7.41], |m| m.water.depression_depth;
    "area_exponent", "area exponent", "", 3, [0.489, 0.52, 0.564], |m| m.water.area_exponent?;
    "hack", "Hack's exponent", "", 3, [0.466, 0.517, 0.554], |m| m.water.hack?;
    "concavity", "concavity of rivers", "", 3, [0.275, 0.49, 0.647], |m| m.water.concavity?;
    "bifurcation", "bifurcation ratio", "", 2, [3.87, 4.34, 5.65], |m| m.water.bifurcation?;
    "length_ratio", "stream length ratio", "", 2, [1.63, 2.12, 2.65], |m| m.water.length_ratio?;
    "drainage_density", "drainage density", "km/km\u{b2}", 2, [0.788, 0.883, 0.971], |m| m.water.density;
    "wetness", "mean wetness index", "", 2, [5.87, 7.02, 8.36], |m| m.water.wetness;
    "valleys", "valleys", "%", 1, [9.65, 11.5, 15.4], |m| 100.0 * m.forms[8];
    "ridges", "ridges", "%", 1, [7.69, 9.04, 16.0], |m| 100.0 * m.forms[2];
    "slopes", "plain slopes", "%", 1, [31.1, 39.7, 44.3], |m| 100.0 * m.forms[5];
];

impl Figure {
    /// The value, if it exists and is finite.
    #[must_use]
    pub fn value(&self, measures: &Measures) -> Option<f64> {
        (self.of)(measures).filter(|value| value.is_finite())
    }

    /// The position of a value in the range of real terrain: 0 is the median, -1 and 1 are the 10 % and 90 % quantiles.
    #[must_use]
    pub fn place(&self, value: f64) -> f64 {
        let [low, middle, high] = self.real;
        let half = if value < middle { middle - low } else { high - middle };
        (value - middle) / half.max(f64::MIN_POSITIVE)
    }

    /// An assessment in one word.
    #[must_use]
    pub fn verdict(&self, value: f64) -> &'static str {
        match self.place(value) {
            place if place < -2.0 => "far below",
            place if place < -1.0 => "below",
            place if place <= 1.0 => "as real land",
            place if place <= 2.0 => "above",
            _ => "far above",
        }
    }

    /// A value with its number of decimals.
    #[must_use]
    pub fn text(&self, value: f64) -> String {
        format!("{value:.*}", self.digits)
    }
}

/// The table for a terminal: each statistic with its range in real terrain and an assessment.
#[must_use]
pub fn table(measures: &Measures) -> String {
    let mut out = format!("{:<24}{:>10} {:<8} {:>24}\n", "", "here", "", "real: 10 %, half, 90 %");
    for figure in FIGURES {
        let real = figure.real.map(|value| figure.text(value));
        let line = match figure.value(measures) {
            Some(value) => format!(
                "{:<24}{:>10} {:<8} {:>8}{:>8}{:>8}  {}",
                figure.name,
                figure.text(value),
                figure.unit,
                real[0],
                real[1],
                real[2],
                figure.verdict(value)
            ),
            None => {
                format!("{:<24}{:>10} {:<8} {:>8}{:>8}{:>8}", figure.name, "-", figure.unit, real[0], real[1], real[2])
            }
        };
        out.push_str(line.trim_end());
        out.push('\n');
    }
    out.push_str("\ngeomorphons");
    for (name, share) in FORMS.iter().zip(&measures.forms) {
        out.push_str(&format!("  {name} {:.1} %", 100.0 * share));
    }
    out.push('\n');
    out
}
