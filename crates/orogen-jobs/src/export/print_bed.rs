//! Checks whether a printer can print a model: the size of its bed, and the thickness of its layers.

use orogen_grid::error::{Error, ErrorKind, Result};
use orogen_grid::words::number;

use super::mesh::EXAGGERATION;
use crate::options::{OptionSpec, ValueKind};

/// `--bed`.
pub const BED: OptionSpec = OptionSpec::new("bed", "WxDxH", ValueKind::Text).with_about(
    "Width and depth of the printer's bed and height above it in millimetres, such as 220x220x250: a model \
             that does not fit is refused [default: no check]",
);

/// Usual thickness of a layer in millimetres, and the number of layers that the advised relief has.
const LAYER: f64 = 0.2;
const LAYERS: f64 = 10.0;

/// The size of a model in millimetres: width, depth and height.
#[derive(Debug, Clone, Copy)]
pub struct ModelSize {
    /// The size.
    pub size: [f64; 3],
    /// The part of the size that does not depend on the size of the land: letters and base.
    pub fixed: [f64; 3],
    /// Length of the longer side of the land.
    pub print_size: f64,
    /// The factor of heights.
    pub exaggeration: f64,
}

/// The bed of a printer: width, depth and height in millimetres.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bed([f64; 3]);

impl Bed {
    /// Reads `WxDxH`.
    pub fn parse(text: &str) -> Result<Bed> {
        let sides: Vec<f64> = text.split(['x', 'X', '×']).map(|side| side.trim().parse().unwrap_or(f64::NAN)).collect();
        match <[f64; 3]>::try_from(sides) {
            Ok(sides) if sides.iter().all(|side| (1.0..=1e6).contains(side)) => Ok(Bed(sides)),
            _ => Err(Error::new(
                ErrorKind::Request,
                format!(
                    "`{}` is not a value for --bed: it must be width, depth and height in millimetres, from 1 to 1000000, such as 220x220x250",
                    text.escape_debug()
                ),
            )),
        }
    }

    /// Checks that a model fits, with its sides along those of the bed.
    pub fn check(self, model: &ModelSize) -> Result<()> {
        let Bed([width, depth, height]) = self;
        // The factor by which the land must shrink to fit.
        let factor = |axis: usize, room: f64| {
            let land = model.size[axis] - model.fixed[axis];
            if land > 0.0 { (room - model.fixed[axis]) / land } else { f64::INFINITY }
        };
        let along = factor(0, width).min(factor(1, depth)).max(factor(0, depth).min(factor(1, width)));
        let up = factor(2, height);
        // Sizes come from vertices in f32.
        if along.min(up) >= 1.0 - 1e-6 {
            return Ok(());
        }
        let advice = match (along.min(up), along < 1.0 - 1e-6) {
            (least, _) if least <= 0.0 => "use a thinner base, without text".to_string(),
            (least, true) => format!("use --print-size {} or less", number(down(model.print_size * least))),
            (least, false) => format!(
                "use --exaggeration {} or less, or --print-size {} or less",
                number(down(model.exaggeration * up)),
                number(down(model.print_size * least))
            ),
        };
        let message = format!(
            "the model is {} mm in size, and the printer has room for {} mm; {advice}",
            shown(model.size),
            shown(self.0)
        );
        Err(Error::new(ErrorKind::Request, message))
    }
}

/// A warning if the relief is less than a layer.
pub fn flatness(model: &ModelSize) -> Option<String> {
    let relief = model.size[2] - model.fixed[2];
    if relief >= LAYER {
        return None;
    }
    let high = format!("the relief is {} mm high, less than a layer of {LAYER} mm", number(rounded(relief, 100.0)));
    let ValueKind::Number(_, most) = EXAGGERATION.kind else { return Some(high) };
    let advised = digits(model.exaggeration * LAYERS * LAYER / relief, 2, f64::round);
    Some(match advised <= most {
        true => format!("{high}; use an exaggeration of about {}", number(advised)),
        false => format!("{high}; print other land, or a smaller part of it"),
    })
}

/// Rounds to this number of significant digits.
fn digits(value: f64, count: i32, round: fn(f64) -> f64) -> f64 {
    let parts = libm::pow(10.0, f64::from(count - 1) - libm::log10(value).floor());
    round(value * parts) / parts
}

/// Rounds down to three significant digits.
fn down(value: f64) -> f64 {
    digits(value * (1.0 + 1e-9), 3, f64::floor)
}

/// Rounds to multiples of 1 / `parts`.
fn rounded(value: f64, parts: f64) -> f64 {
    (value * parts).round() / parts
}

/// Formats a size such as "150 x 94 x 12.3", rounded to tenths.
pub fn shown(millimetres: [f64; 3]) -> String {
    millimetres.map(|side| number(rounded(side, 10.0))).join(" x ")
}

#[cfg(test)]
mod tests {
    use super::*;

    const MODEL: ModelSize =
        ModelSize { size: [150.0, 100.0, 43.0], fixed: [0.0, 0.0, 3.0], print_size: 150.0, exaggeration: 2.0 };

    #[test]
    fn a_bed_is_three_lengths() {
        assert_eq!(Bed::parse("220x210X250.5").unwrap(), Bed([220.0, 210.0, 250.5]));
        for text in ["220", "220x220", "220x220x", "1x1x1x1", "0x1x1", "axbxc", "1xnanx1", "1x1x1e99"] {
            let why = Bed::parse(text).unwrap_err().to_string();
            assert!(why.contains("such as 220x220x250"), "{text}: {why}");
        }
    }

    #[test]
    fn what_does_not_fit_is_refused_with_what_would() {
        let check = |text: &str| Bed::parse(text).unwrap().check(&MODEL).map_err(|error| error.to_string());
        assert_eq!(check("150x100x43"), Ok(()));
        // Rotated by a quarter turn.
        assert_eq!(check("100x150x43"), Ok(()));
        let expect = "the model is 150 x 100 x 43 mm in size, and the printer has room for 120 x 120 x 250 mm; use --print-size 120 or less";
        assert_eq!(check("120x120x250"), Err(expect.into()));
        // 23 mm hold the base and half of the relief.
        let why = check("220x220x23").unwrap_err();
        assert!(why.ends_with("use --exaggeration 1 or less, or --print-size 75 or less"), "{why}");
        assert!(check("220x220x2").unwrap_err().ends_with("use a thinner base, without text"));
        // The advised size fits.
        let smaller = ModelSize { size: [120.0, 80.0, 35.0], print_size: 120.0, ..MODEL };
        assert!(Bed([120.0, 120.0, 250.0]).check(&smaller).is_ok());
    }

    #[test]
    fn relief_below_a_layer_is_told_with_the_factor_to_use() {
        assert_eq!(flatness(&MODEL), None);
        let flat = |relief: f64| flatness(&ModelSize { size: [150.0, 100.0, 3.0 + relief], ..MODEL });
        let told = flat(0.05).unwrap();
        assert!(
            told.contains("the relief is 0.05 mm high, less than a layer of 0.2 mm; use an exaggeration of about 80"),
            "{told}"
        );
        let flattened = ModelSize { exaggeration: 0.01, size: [150.0, 100.0, 3.11], ..MODEL };
        assert!(flatness(&flattened).unwrap().ends_with("about 0.18"));
        assert!(flat(0.0).unwrap().ends_with("print other land, or a smaller part of it"));
    }
}
