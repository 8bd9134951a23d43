//! Text lines of a regular grid: east, north and height.

use std::io::{BufRead, BufReader, Read};

use super::input::{Input, afford};

/// Maximum length of a line, in bytes.
const LONGEST_LINE: u64 = 1 << 10;

/// Maximum deviation of a sample from its position in the grid, in cells.
const BESIDE: f64 = 0.01;

/// The contents of the lines.
pub struct Rows {
    /// The heights, row by row.
    pub heights: Vec<f32>,
    /// Number of heights per row.
    pub width: usize,
    /// East and north of the first sample.
    pub first: [f64; 2],
    /// East of the second sample of a row minus east of the first one.
    pub step: f64,
    /// North of the second row minus north of the first one.
    pub down: f64,
}

/// Reads all lines.
///
/// # Errors
/// A message if a line is not three numbers, if the samples do not form a complete regular grid, or if the heights need
/// more than `allowed` bytes.
pub fn read(input: &mut dyn Input, allowed: u64) -> Result<Rows, String> {
    let mut lines = BufReader::new(input);
    let mut heights: Vec<f32> = Vec::new();
    // The first sample, the second of the first row, and the first of the second row.
    let (mut first, mut second, mut below): ([f64; 2], Option<f64>, Option<f64>) = ([0.0; 2], None, None);
    let (mut width, mut number) = (0usize, 0usize);
    let mut line = Vec::new();
    loop {
        line.clear();
        (&mut lines).take(LONGEST_LINE).read_until(b'\n', &mut line).map_err(|cause| cause.to_string())?;
        if line.is_empty() {
            break;
        }
        number += 1;
        let Some([x, y, z]) = parse(&line, number)? else { continue };
        let k = heights.len();
        if k == 0 {
            first = [x, y];
        } else if k == 1 {
            second = Some(x - first[0]);
        }
        if below.is_none() && y != first[1] {
            (below, width) = (Some(y - first[1]), k);
        }
        if let (Some(step), Some(down)) = (second, below.or(Some(0.0))) {
            let (i, j) = if width > 0 { (k % width, k / width) } else { (k, 0) };
            let expect = [first[0] + i as f64 * step, first[1] + j as f64 * down];
            let cell = step.abs().max(f64::MIN_POSITIVE);
            if !((x - expect[0]).abs() <= BESIDE * cell && (y - expect[1]).abs() <= BESIDE * down.abs().max(cell)) {
                return Err(format!(
                    "line {number} is at {x}, {y}, and a regular grid has its next sample at {}, {}; make a raster of scattered points first, for example with gdal_grid",
                    expect[0], expect[1]
                ));
            }
        }
        if (heights.len() as u64 + 1) * 4 > allowed {
            afford(heights.len() as u64 + 1, 1, allowed)?;
        }
        heights.push(z as f32);
    }
    let (Some(step), Some(down)) = (second, below) else {
        return Err("it has fewer than two rows of samples".into());
    };
    if width < 2 || !heights.len().is_multiple_of(width) || step <= 0.0 {
        return Err(format!(
            "its {} samples are not whole rows of {width} from west to east; make a raster first, for example with gdal_grid",
            heights.len()
        ));
    }
    Ok(Rows { heights, width, first, step, down })
}

/// The numbers of a line; `None` for an empty line, a comment, or the names in the first line.
fn parse(line: &[u8], number: usize) -> Result<Option<[f64; 3]>, String> {
    let text = std::str::from_utf8(line).map_err(|_| format!("line {number} is not text"))?.trim();
    let text = text.trim_start_matches('\u{feff}');
    if text.is_empty() || text.starts_with('#') {
        return Ok(None);
    }
    // If semicolons separate the numbers, commas are decimal commas.
    let is_decimal = text.contains(';');
    let separates = |c: char| matches!(c, ' ' | '\t' | ';') || c == ',' && !is_decimal;
    let mut words = text.split(separates).filter(|word| !word.is_empty());
    let mut next = || words.next()?.replace(',', ".").parse::<f64>().ok();
    match (next(), next(), next()) {
        (Some(x), Some(y), Some(z)) if x.is_finite() && y.is_finite() => Ok(Some([x, y, z])),
        _ if number == 1 && text.starts_with(|c: char| c.is_alphabetic() || c == '"') => Ok(None),
        _ => Err(format!("line {number} is not three numbers: east, north and height")),
    }
}
