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
use crate::grid::Window;
use crate::words::{count, number};

/// The options of formats of lines.
pub const OPTIONS: &[OptionSpec] = &[
    OptionSpec {
        name: "interval",
        value: "M",
        about: "Metres from one contour to the next [default: a round number that makes 10 to 25]",
        takes: Takes::Number(1e-6, 1e6),
    },
    OptionSpec {
        name: "levels",
        value: "A,B,...",
        about: "Heights of contours, instead of an interval",
        takes: Takes::Text,
    },
    OptionSpec {
        name: "smooth",
        value: "N",
        about: "How often the corners of lines are cut, each time doubling their points [default: 0]",
        takes: Takes::Whole(0, 6),
    },
];

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
    if options.has("interval") && options.has("levels") {
        let sentence = "--interval and --levels contradict each other: give one of them";
        return Err(Error::new(ErrorKind::Request, sentence).into());
    }
    let named = options.text("levels").map(parse).transpose()?;
    let grid = subject.whole()?.swap_remove(0);
    let range = subject.levels();
    let (low, high) = (f64::from(range.low()), f64::from(range.high()));
    let interval = match &named {
        Some(_) => None,
        None => Some(options.number("interval").unwrap_or_else(|| round_interval(high - low, MOST))),
    };
    let levels = match (named, interval) {
        (Some(levels), _) => levels,
        (None, Some(interval)) => every(interval, low, high)?,
        (None, None) => Vec::new(),
    };
    let lines = trace::contours(&grid, &levels)?;
    let rounds = options.whole("smooth").unwrap_or(0) as usize;
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
