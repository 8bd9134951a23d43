//! Options of contours, common to all formats of lines.

use crate::options::{OptionSpec, Options, ValueKind};
use orogen_grid::contour::levels::given;
use orogen_grid::error::{Error, ErrorKind, Result};

/// `--interval`.
pub const INTERVAL: OptionSpec = OptionSpec::new("interval", "M", ValueKind::Number(1e-6, 1e6))
    .with_about("Contour interval in metres [default: a round number that gives 10 to 25 contours]");

/// `--levels`.
pub const LEVELS: OptionSpec =
    OptionSpec::new("levels", "A,B,...", ValueKind::Text).with_about("Contour heights, instead of an interval");

/// `--smooth`.
pub const SMOOTH: OptionSpec = OptionSpec::new("smooth", "N", ValueKind::Whole(0, 6)).with_about(
    "Passes of corner cutting for lines, each doubling their points, and of smoothing for rivers [default: 0 \
             for contours, 1 for shores and watersheds, 3 for rivers]",
);

/// Checks that the options of contours are consistent and valid.
///
/// # Errors
/// If they are not.
pub fn check(options: &Options) -> Result<()> {
    if options.has(INTERVAL.name) && options.has(LEVELS.name) {
        let message = "--interval and --levels exclude each other; leave out one of them";
        return Err(Error::new(ErrorKind::Request, message));
    }
    options.text(LEVELS.name).map_or(Ok(()), |text| parse(text).map(drop))
}

/// Parses a list of levels.
///
/// # Errors
/// If a part is not a number, or there are too many.
pub fn parse(text: &str) -> Result<Vec<f64>> {
    let numbers = text.split(',').map(|part| {
        part.trim().parse::<f64>().map_err(|_| {
            let message =
                format!("`{part}` in --levels is not a height; write numbers separated by commas, such as 0,250.5,500");
            Error::new(ErrorKind::Request, message)
        })
    });
    given(&numbers.collect::<Result<Vec<f64>>>()?)
}
