//! Contours of an exported layer, for all formats of lines.

use super::contour_options::{INTERVAL, LEVELS, SMOOTH, parse};
use super::memory::whole;
use crate::options::Options;
use orogen_grid::contour::chaikin::chaikin;
use orogen_grid::contour::levels::{levels_every, round_interval};
use orogen_grid::contour::line::Line;
use orogen_grid::contour::trace;
use orogen_grid::error::Result;
use orogen_grid::grid::{Grid, Window};
use orogen_grid::words::{count, number};
use orogen_io::format::levels::Levels;

/// Default maximum number of levels.
const MOST: usize = 25;

/// Contour lines, and their interval if there is one.
pub struct Contours {
    /// The lines, in the order of [`trace::contours`].
    pub lines: Vec<Line>,
    /// Distance between levels, in metres.
    pub interval: Option<f64>,
}

/// Memory in addition to the rows, in bytes: the grid, and crossings. Rough ground has about as many crossings as
/// samples.
pub fn memory(window: &Window, _: &Options) -> u64 {
    whole(window).saturating_mul(8)
}

/// The contours of a grid.
///
/// # Errors
/// If the levels cannot be parsed, or there are too many lines.
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
        (None, Some(interval)) => levels_every(interval, low, high)?,
        (None, None) => Vec::new(),
    };
    let lines = trace::contours(grid, &levels)?;
    let rounds = options.whole(SMOOTH.name).unwrap_or(0) as usize;
    let lines = if rounds > 0 { lines.iter().map(|line| chaikin(line, rounds)).collect() } else { lines };
    Ok(Contours { lines, interval })
}

impl Contours {
    /// A summary of the number of lines.
    pub fn words(&self, unit: &str) -> String {
        let levels = self.lines.chunk_by(|a, b| a.level == b.level).count();
        let lines = self.lines.len();
        let apart = self
            .interval
            .map_or(String::new(), |interval| format!(", one each {} {unit}", number(interval)).trim_end().to_string());
        match levels {
            0 => "no contours: the heights cross no level".into(),
            _ => format!("{} of {}{apart}", count(lines, "contour line"), count(levels, "height")),
        }
    }
}
