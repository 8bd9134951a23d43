//! Contours of what is exported, as every format of lines takes them.

use std::io;

use super::format::whole;
use super::options::{OptionSpec, Options, Takes};
use super::subject::Subject;
use crate::contour::chaikin::smooth;
use crate::contour::levels::{every, given, round_interval};
use crate::contour::line::Line;
use crate::contour::trace;
use crate::error::{Error, ErrorKind, Result};
use crate::format::levels::Levels;
use crate::grid::{Grid, Window};
use crate::words::{count, number};

/// `--interval`.
pub const INTERVAL: OptionSpec = OptionSpec {
    name: "interval",
    value: "M",
    about: "Metres from one contour to the next [default: a round number that makes 10 to 25]",
    takes: Takes::Number(1e-6, 1e6),
};

/// `--levels`.
pub const LEVELS: OptionSpec = OptionSpec {
    name: "levels",
    value: "A,B,...",
    about: "Heights of contours, instead of an interval",
    takes: Takes::Text,
};

/// `--smooth`.
pub const SMOOTH: OptionSpec = OptionSpec {
    name: "smooth",
    value: "N",
    about: "How often the corners of lines are cut, each time doubling their points, and rivers are evened out \
            [default: 0 for contours, 1 for shores and watersheds, 3 for rivers]",
    takes: Takes::Whole(0, 6),
};

/// Most contours, where nobody says.
const MOST: usize = 25;

/// Lines, and how far apart they are if that is known.
pub struct Contours {
    /// In the order of [`trace::contours`].
    pub lines: Vec<Line>,
    /// Metres from one level to the next.
    pub interval: Option<f64>,
}

/// Bytes beside the rows: the grid, and crossings, of which rough ground has about as many as samples.
pub fn memory(window: &Window, _: &Options) -> u64 {
    whole(window).saturating_mul(8)
}

/// The contours that are asked for.
///
/// Fails as the subject does, or if the levels cannot be read.
pub fn of(subject: &mut Subject, options: &Options) -> io::Result<Contours> {
    check(options)?;
    Ok(on(&subject.whole()?.swap_remove(0), options)?)
}

/// Whether the options that say which contours are wanted go together, and can be read.
///
/// # Errors
/// If not.
pub fn check(options: &Options) -> Result<()> {
    if options.has(INTERVAL.name) && options.has(LEVELS.name) {
        let sentence = "--interval and --levels contradict each other: give one of them";
        return Err(Error::new(ErrorKind::Request, sentence));
    }
    options.text(LEVELS.name).map_or(Ok(()), |text| parse(text).map(drop))
}

/// The contours of a grid.
///
/// # Errors
/// If the levels cannot be read, or there are more lines than can be numbered.
pub fn on(grid: &Grid, options: &Options) -> Result<Contours> {
    let named = options.text(LEVELS.name).map(parse).transpose()?;
    let range = Levels::of(grid);
    let (low, high) = (f64::from(range.low()), f64::from(range.high()));
    let interval = match &named {
        Some(_) => None,
        None => Some(options.number(INTERVAL.name).unwrap_or_else(|| round_interval(high - low, MOST))),
    };
    let levels = match (named, interval) {
        (Some(levels), _) => levels,
        (None, Some(interval)) => every(interval, low, high)?,
        (None, None) => Vec::new(),
    };
    let lines = trace::contours(grid, &levels)?;
    let rounds = options.whole(SMOOTH.name).unwrap_or(0) as usize;
    let lines = if rounds > 0 { lines.iter().map(|line| smooth(line, rounds)).collect() } else { lines };
    Ok(Contours { lines, interval })
}

fn parse(text: &str) -> Result<Vec<f64>> {
    let numbers = text.split(',').map(|part| {
        part.trim().parse::<f64>().map_err(|_| {
            let sentence =
                format!("`{part}` in --levels is no height; they are numbers with commas, such as 0,250.5,500");
            Error::new(ErrorKind::Request, sentence)
        })
    });
    given(&numbers.collect::<Result<Vec<f64>>>()?)
}

impl Contours {
    /// How much there is, in words.
    pub fn words(&self, unit: &str) -> String {
        let levels = self.lines.chunk_by(|a, b| a.level == b.level).count();
        let lines = self.lines.len();
        let apart = self
            .interval
            .map_or(String::new(), |interval| format!(", one each {} {unit}", number(interval)).trim_end().to_string());
        match levels {
            0 => "no contours: no level is crossed".into(),
            _ => format!("{} of {}{apart}", count(lines, "contour line"), count(levels, "height")),
        }
    }
}
