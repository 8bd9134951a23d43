//! ESRI ASCII grid, `.asc`: a header of keys and numbers, then the heights as text, row by row from the north.
//!
//! Keys read: `ncols`, `nrows`, `xllcorner` or `xllcenter`, `yllcorner` or `yllcenter`, `cellsize` (or GDAL's `dx` and
//! `dy`), `nodata_value`, in any case and order. The format does not store its unit: without a `.prj` file, the unit is
//! [guessed](Unit::guess).

use std::io::{self, Write};

use super::affine::{Affine, Lattice};
use super::crs::unit::Unit;
use super::dem::{Dem, Georeference, Input, Placement, afford, refused};
use super::number::append_row;
use super::words::{Words, number};
use orogen_grid::error::Result;
use orogen_grid::grid::{Grid, Window};

/// The nodata value in written files.
const NODATA: f32 = -9999.0;

/// Writes a grid. Its samples are pixel centers, as the format requires.
pub fn write(out: &mut dyn Write, grid: &Grid) -> io::Result<()> {
    write_head(out, grid.window(), None)?;
    write_rows(out, grid.width(), grid.data())
}

/// Writes the header for the samples of a window: in local metres, or in the coordinates of `map`. All samples must
/// follow with [`write_rows`].
pub fn write_head(out: &mut dyn Write, window: &Window, map: Option<&Georeference>) -> io::Result<()> {
    let local = Georeference::LOCAL;
    let map = map.unwrap_or(&local);
    let [west, south] = map.at(window.east(0), window.south(window.height.max(1) - 1));
    let (_, [across, down]) = map.of(window);
    writeln!(out, "ncols {}\nnrows {}\nxllcenter {west}\nyllcenter {south}", window.width, window.height)?;
    // GDAL writes oblong cells this way.
    match across == down {
        true => writeln!(out, "cellsize {across}")?,
        false => writeln!(out, "dx {across}\ndy {down}")?,
    }
    writeln!(out, "NODATA_value {NODATA}")
}

/// Writes the next rows, `width` samples each; samples that are not finite become nodata.
pub fn write_rows(out: &mut dyn Write, width: usize, samples: &[f32]) -> io::Result<()> {
    let mut text = String::new();
    for row in samples.chunks(width.max(1)) {
        text.clear();
        append_row(&mut text, row, NODATA);
        out.write_all(text.as_bytes())?;
    }
    Ok(())
}

/// Reads a grid whose heights take at most `allowed` bytes. `name` is the file's name in errors.
///
/// # Errors
/// If it is not an ASCII grid, is truncated, or is too large.
pub fn read(input: &mut dyn Input, name: &str, allowed: u64) -> Result<Dem> {
    open(input, allowed).map_err(|why| refused(name, why))
}

#[derive(Default)]
struct Head {
    columns: Option<u64>,
    rows: Option<u64>,
    /// The coordinate of the lower left pixel, and whether it refers to the pixel's center.
    west: Option<(f64, bool)>,
    south: Option<(f64, bool)>,
    step: [Option<f64>; 2],
    nodata: Option<f64>,
    /// Whether the nodata value was stated; the value `null` states that there is none.
    has_nodata: bool,
}

/// The size and position of a grid, without reading its samples.
///
/// # Errors
/// If it is not an ASCII grid.
pub fn head(input: &mut dyn Input, name: &str) -> Result<([usize; 2], Option<Placement>)> {
    let mut words = Words::new(input);
    let (head, [columns, rows], _) = read_head(&mut words).map_err(|why| refused(name, why))?;
    let place = head.place(rows).map_err(|why| refused(name, why))?;
    Ok(([columns as usize, rows as usize], place))
}

/// The header, the size it states, and the first word after it.
fn read_head(words: &mut Words) -> std::result::Result<(Head, [u64; 2], Option<String>), String> {
    let mut head = Head::default();
    words.skip_mark()?;
    // The header ends where a number is found instead of a key.
    let mut first = words.next()?;
    while let Some(word) = first.as_deref()
        && word.starts_with(|c: char| c.is_ascii_alphabetic())
        && number(word).is_none()
    {
        let key = word.to_ascii_lowercase();
        let value = words.next()?.ok_or_else(|| format!("it ends after `{key}`"))?;
        head.take(&key, &value)?;
        first = words.next()?;
    }
    let (Some(columns), Some(rows)) = (head.columns, head.rows) else {
        return Err("it is not an ASCII grid: its header has no ncols and nrows".into());
    };
    Ok((head, [columns, rows], first))
}

fn open(input: &mut dyn Input, allowed: u64) -> std::result::Result<Dem, String> {
    let mut words = Words::new(input);
    let (head, [columns, rows], first) = read_head(&mut words)?;
    afford(columns, rows, allowed)?;
    let heights = words.heights(first, [columns as usize, rows as usize], head.nodata)?;
    if let Some(word) = words.next()? {
        return Err(format!("it continues with `{}` after its {columns} x {rows} heights", word.escape_debug()));
    }
    let place = head.place(rows)?;
    Dem::new([columns as usize, rows as usize], heights, place)
}

impl Head {
    fn take(&mut self, key: &str, value: &str) -> std::result::Result<(), String> {
        let given = match key {
            "ncols" => self.columns.is_some(),
            "nrows" => self.rows.is_some(),
            "xllcorner" | "xllcenter" => self.west.is_some(),
            "yllcorner" | "yllcenter" => self.south.is_some(),
            "cellsize" => self.step.iter().any(Option::is_some),
            "dx" => self.step[0].is_some(),
            "dy" => self.step[1].is_some(),
            "nodata_value" => self.has_nodata,
            _ => false,
        };
        if given {
            return Err(format!(
                "its header states `{key}` after it, or another key with the same meaning, was stated"
            ));
        }
        self.has_nodata |= key == "nodata_value";
        if key == "nodata_value" && value.eq_ignore_ascii_case("null") {
            return Ok(());
        }
        let number =
            number(value).ok_or_else(|| format!("`{key}` is `{}`, which is not a number", value.escape_debug()))?;
        let whole = || {
            let sound = (1.0..1e15).contains(&number) && number.fract() == 0.0;
            if sound {
                Ok(Some(number as u64))
            } else {
                Err(format!("`{key}` is {number}, which is not a number of samples"))
            }
        };
        match key {
            "ncols" => self.columns = whole()?,
            "nrows" => self.rows = whole()?,
            "xllcorner" => self.west = Some((number, false)),
            "xllcenter" => self.west = Some((number, true)),
            "yllcorner" => self.south = Some((number, false)),
            "yllcenter" => self.south = Some((number, true)),
            "cellsize" => self.step = [Some(number); 2],
            "dx" => self.step[0] = Some(number),
            "dy" => self.step[1] = Some(number),
            "nodata_value" => self.nodata = Some(number),
            _ => return Err(format!("its header has an unknown key `{}`", key.escape_debug())),
        }
        if matches!(key, "xllcorner" | "xllcenter" | "yllcorner" | "yllcenter") && !number.is_finite() {
            return Err(format!("`{key}` is {number}, which is not a coordinate"));
        }
        if matches!(key, "cellsize" | "dx" | "dy") && !(number.is_finite() && number > 0.0) {
            return Err(format!("`{key}` is {number}, and must be greater than 0"));
        }
        Ok(())
    }

    /// The position of the samples, if the header states it.
    fn place(&self, rows: u64) -> std::result::Result<Option<Placement>, String> {
        let ([Some(dx), Some(dy)], Some(west), Some(south)) = (self.step, self.west, self.south) else {
            return Ok(None);
        };
        let middle = |(at, is_middle): (f64, bool), step: f64| if is_middle { at } else { at + 0.5 * step };
        let (east, bottom) = (middle(west, dx), middle(south, dy));
        let Lattice { origin, step, .. } =
            Affine([dx, 0.0, east, 0.0, -dy, bottom + (rows as f64 - 1.0) * dy]).lattice(rows as usize)?;
        let unit = Unit::guess([east, bottom], step);
        Ok(Some(Placement { origin, step, unit, cell: None, keys: None }))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use orogen_grid::grid::Window;
    use std::io::Cursor;

    fn parse(text: &str) -> Result<Dem> {
        read(&mut Cursor::new(text.as_bytes()), "a.asc", 1 << 20)
    }

    #[test]
    fn what_is_written_is_read_back() {
        let mut heights: Vec<f32> = (0..15).map(|i| i as f32 * 0.37 - 2.1).collect();
        heights[7] = f32::NAN;
        let grid = Grid::from_data(Window::new(5, 3, 10.24).at(-3, 7), heights.clone()).unwrap();
        let mut bytes = Vec::new();
        write(&mut bytes, &grid).unwrap();
        let dem = read(&mut Cursor::new(bytes), "a.asc", 1 << 20).unwrap();
        assert_eq!((dem.width, dem.height, dem.missing()), (5, 3, 1));
        assert!(dem.heights.iter().zip(&heights).all(|(a, b)| a == b || b.is_nan()));
        let place = dem.place.unwrap();
        assert_eq!((place.step, place.unit), ([10.24; 2], Unit::Metres(1.0)));
        assert!((place.origin[0] + 30.72).abs() < 1e-9 && (place.origin[1] + 71.68).abs() < 1e-9);
    }

    #[test]
    fn corners_middles_and_degrees() {
        let head = |rest: &str| format!("NCOLS 2\nNROWS 2\n{rest}\n1 2\n3 4\n");
        let place = |rest: &str| parse(&head(rest)).unwrap().place.unwrap();
        assert_eq!(place("xllcorner 100\nyllcorner 200\ncellsize 10").origin, [105.0, 215.0]);
        assert_eq!(place("xllcenter 100\nyllcenter 200\ncellsize 10").origin, [100.0, 210.0]);
        let degrees = place("xllcorner 7\r\nyllcorner 46\r\ndx 0.1\r\ndy 0.05");
        assert_eq!((degrees.unit, degrees.step), (Unit::Degrees, [0.1, 0.05]));
        assert_eq!(parse(&head("")).unwrap().place, None);
        assert_eq!(parse(&head("nodata_value 3")).unwrap().missing(), 1);
        assert_eq!(parse(&head("NODATA_value null")).unwrap().missing(), 0);
        assert_eq!(parse("ncols 2\nnrows 1\n1,5 -2,5").unwrap().heights, [1.5, -2.5]);
    }

    #[test]
    fn damaged_grids_are_sentences() {
        for (text, expect) in [
            ("", "has no ncols"),
            ("ncols 2\nnrows", "ends after `nrows`"),
            ("ncols 2\nnrows 2\n1 2 3", "ends after 3 heights; its header declares 2 x 2"),
            ("ncols 2\nnrows 2\n1 2 3 4 5", "continues with `5`"),
            ("ncols 2\nnrows 2\n1 2 x 4", "`x` in row 2, column 1"),
            ("ncols 4000000000\nnrows 4\n1", "4000000000 x 4 samples"),
            ("ncols -2\nnrows 2\n1", "`ncols` is -2"),
            ("ncols 2\nnrows 2\ncellsize 0\n1 2 3 4", "must be greater than 0"),
            ("ncols 2\nnrows 1\nnodata_value -9999\n-9999 -9999", "samples are nodata"),
            ("colour 2\n", "unknown key `colour`"),
            (
                "ncols 2\nnrows 1\nxllcorner nan\nyllcorner 0\ncellsize 1\n1 2",
                "`xllcorner` is NaN, which is not a coordinate",
            ),
            ("ncols 2\nnrows 1\nxllcorner 1e308\nyllcorner 0\ncellsize 1\n1 2", "1e308 is not on a map"),
            ("ncols 2\nncols 2\nnrows 1\n1 2", "states `ncols` after it"),
            ("ncols 2\nnrows 1\nxllcorner 0\nxllcenter 0\n1 2", "states `xllcenter` after it"),
            ("ncols 2\nnrows 1\ndx 1\ncellsize 1\n1 2", "states `cellsize` after it"),
            ("\u{89}PNG\r\n", "not an ASCII grid"),
        ] {
            let error = parse(text).unwrap_err().to_string();
            assert!(error.starts_with("cannot read a.asc: ") && error.contains(expect), "{text:?}: {error}");
        }
    }
}
