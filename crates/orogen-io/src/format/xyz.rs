//! Regular grids as text, `.xyz`: a line of east, north and height for each sample, separated by blanks, commas,
//! semicolons or tabs, row by row, from the north or from the south. A line of names may come first.

use std::io::{BufRead, BufReader, Read};

use super::affine::{Affine, Lattice};
use super::crs::unit::Unit;
use super::dem::{Dem, Input, Placement, afford, refused, turn_rows};
use orogen_grid::error::Result;

/// Maximum length of a line, in bytes.
const LONGEST_LINE: u64 = 1 << 10;

/// Maximum deviation of a sample from its place, in cells.
const BESIDE: f64 = 0.01;

/// Reads a grid. `name` is the file's name in errors.
///
/// # Errors
/// If a line is not three numbers, the samples are not all of a regular grid, or heights take more than `allowed`
/// bytes.
pub fn read(input: &mut dyn Input, name: &str, allowed: u64) -> Result<Dem> {
    open(input, allowed).map_err(|why| refused(name, why))
}

fn open(input: &mut dyn Input, allowed: u64) -> std::result::Result<Dem, String> {
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
    let rows = heights.len() / width;
    let Lattice { origin, step, from_south } = Affine([step, 0.0, first[0], 0.0, down, first[1]]).lattice(rows)?;
    if from_south {
        turn_rows(&mut heights, width);
    }
    let unit = Unit::guess(origin, step);
    Dem::new([width, rows], heights, Some(Placement { origin, step, unit, cell: None, keys: None }))
}

/// The numbers of a line; none for an empty line, a comment, or the names in the first line.
fn parse(line: &[u8], number: usize) -> std::result::Result<Option<[f64; 3]>, String> {
    let text = std::str::from_utf8(line).map_err(|_| format!("line {number} is not text"))?.trim();
    let text = text.trim_start_matches('\u{feff}');
    if text.is_empty() || text.starts_with('#') {
        return Ok(None);
    }
    // Where semicolons separate the numbers, commas are those of decimals.
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

#[cfg(test)]
mod tests {
    use super::*;
    use std::io::Cursor;

    fn grid(text: &str) -> std::result::Result<Dem, String> {
        open(&mut Cursor::new(text.as_bytes()), 1 << 20)
    }

    #[test]
    fn rows_from_the_north_and_from_the_south() {
        // As GDAL writes it, and with names, commas and rows from the south.
        let north = "600050 5199950 1\n600150 5199950 2\n600250 5199950 3\n600050 5199850 4\n600150 5199850 -5\n600250 5199850 6\n";
        let south = "x,y,z\n600050,5199850,4\n600150,5199850,-5\n600250,5199850,6\r\n600050,5199950,1\n600150,5199950,2\n600250,5199950,3";
        let commas = north.replace(' ', ";").replace(";5", ",0;5");
        assert!(commas.starts_with("600050,0;5199950;1\n"));
        for text in [north, south, &commas] {
            let dem = grid(text).unwrap();
            assert_eq!((dem.width, dem.height, &dem.heights[..]), (3, 2, &[1.0, 2.0, 3.0, 4.0, -5.0, 6.0][..]));
            let place = dem.place.unwrap();
            assert_eq!((place.origin, place.step), ([600_050.0, 5_199_950.0], [100.0; 2]));
        }
    }

    #[test]
    fn what_is_no_regular_grid_is_a_message() {
        for (text, expect) in [
            ("", "fewer than two rows"),
            ("1 2 3\n", "fewer than two rows"),
            ("0 0 1\n1 0 2\n", "fewer than two rows"),
            ("0 0 1\n1 0 2\n0 -1 3\n", "not whole rows of 2"),
            ("0 0 1\n1 0 2\n0.5 -1 3\n1 -1 3\n", "line 3 is at 0.5, -1"),
            ("0 0 1\n1 0 2\n3 0 2\n", "line 3 is at 3, 0"),
            ("0 0 1\n1 x 2\n", "line 2 is not three numbers"),
            ("0 0 1\n0 1 2\n0 2 3\n", "not whole rows"),
            ("1 0 1\n0 0 2\n1 -1 3\n0 -1 3\n", "from west to east"),
        ] {
            let why = grid(text).unwrap_err();
            assert!(why.contains(expect), "{text:?}: {why}");
        }
        let many = "0 0 1\n1 0 2\n0 -1 3\n1 -1 3\n";
        assert!(open(&mut Cursor::new(many.as_bytes()), 8).unwrap_err().contains("is allowed"));
    }
}
