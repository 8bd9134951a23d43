//! Parts of a world, in samples, in metres and in map coordinates.

use std::str::FromStr;

use super::number::{finite, samples};

/// A rectangle relative to the world's north-west corner.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Rectangle {
    /// Column and row of the first sample, samples per row, number of rows.
    Samples(i64, i64, usize, usize),
    /// Metres east and south of the first sample, width and height.
    Metres([f64; 4]),
}

const RECTANGLE: &str =
    "a window must be X,Y,W,H in samples, such as 0,0,512,512, or in metres, such as 0m,500m,2km,2km";

impl FromStr for Rectangle {
    type Err = String;

    fn from_str(text: &str) -> Result<Rectangle, String> {
        let parts: Vec<&str> = text.split(',').map(str::trim).collect();
        let [x, y, width, height] = parts[..] else { return Err(RECTANGLE.into()) };
        let metres = parts.iter().filter(|part| part.ends_with('m')).count();
        if metres == 4 {
            let mut numbers = [0.0; 4];
            for (number, part) in numbers.iter_mut().zip(&parts) {
                *number = length(part)?;
            }
            return match numbers {
                [_, _, width, height] if width > 0.0 && height > 0.0 => Ok(Rectangle::Metres(numbers)),
                _ => Err("the width and height of a window must be greater than 0 m".into()),
            };
        }
        if metres > 0 {
            return Err(format!("`{text}` mixes samples and metres; {RECTANGLE}"));
        }
        let corner = |text: &str| {
            // Beyond this, positions in metres would lose the precision of the cell.
            let number = text.parse::<i64>().ok().filter(|n| n.abs() <= 1 << 52);
            number.ok_or_else(|| format!("`{text}` is not a column or row of samples; {RECTANGLE}"))
        };
        Ok(Rectangle::Samples(corner(x)?, corner(y)?, samples(width)?, samples(height)?))
    }
}

/// Parses a length with its unit, `500m` or `2.5km`, to metres.
fn length(text: &str) -> Result<f64, String> {
    let (number, unit) = match text.strip_suffix("km") {
        Some(number) => (number, 1000.0),
        None => (text.strip_suffix('m').unwrap_or(text), 1.0),
    };
    let metres = finite(number).map(|number| number * unit).ok().filter(|metres| metres.abs() <= 1e12);
    metres.ok_or_else(|| format!("`{text}` is not a length; {RECTANGLE}"))
}

/// A rectangle in the coordinates of a map.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bounds {
    /// Minimum easting.
    pub west: f64,
    /// Minimum northing.
    pub south: f64,
    /// Maximum easting.
    pub east: f64,
    /// Maximum northing.
    pub north: f64,
}

impl FromStr for Bounds {
    type Err = String;

    fn from_str(text: &str) -> Result<Bounds, String> {
        let parts: Option<Vec<f64>> = text.split(',').map(|part| finite(part).ok()).collect();
        match parts.as_deref() {
            Some(&[west, south, east, north]) => Bounds::new(west, south, east, north),
            _ => Err(format!("`{text}` is not W,S,E,N: four coordinates, such as 600000,5100000,610000,5110000")),
        }
    }
}

impl Bounds {
    fn new(west: f64, south: f64, east: f64, north: f64) -> Result<Bounds, String> {
        match (west < east, south < north) {
            (true, true) => Ok(Bounds { west, south, east, north }),
            (false, _) => Err(format!("the west, {west}, must be less than the east, {east}")),
            (true, false) => Err(format!("the south, {south}, must be less than the north, {north}")),
        }
    }

    /// From the upper left corner, then the lower right one, as in gdal_translate's `-projwin`.
    ///
    /// # Errors
    /// If they are not four coordinates, or the corners are swapped.
    pub fn of_corners(corners: &[f64]) -> Result<Bounds, String> {
        match *corners {
            [left, top, right, bottom] => {
                Bounds::new(left, bottom, right, top).map_err(|why| format!("--projwin: {why}"))
            }
            _ => Err("--projwin takes four coordinates: ULX ULY LRX LRY".into()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn windows() {
        let window = |x, y, width, height| Some(Rectangle::Samples(x, y, width, height));
        for (text, expect) in [
            ("0,0,512,512", window(0, 0, 512, 512)),
            (" -5, 7 ,1,2", window(-5, 7, 1, 2)),
            ("0m,-500m,2km,1.5km", Some(Rectangle::Metres([0.0, -500.0, 2000.0, 1500.0]))),
            ("0,0,0,5", None),
            ("0,0,5", None),
            ("0,0,5,5,5", None),
            ("0,0,5m,5m", None),
            ("0m,0m,0m,5m", None),
            ("0m,0m,nanm,5m", None),
            ("9223372036854775807,0,5,5", None),
            ("a,0,5,5", None),
        ] {
            assert_eq!(text.parse::<Rectangle>().ok(), expect, "{text}");
        }
    }

    #[test]
    fn bounds() {
        let bounds = Bounds { west: -1.0, south: 2.0, east: 3.5, north: 4e3 };
        assert_eq!("-1,2, 3.5,4e3".parse(), Ok(bounds));
        assert_eq!(Bounds::of_corners(&[-1.0, 4e3, 3.5, 2.0]), Ok(bounds));
        for (text, expect) in [
            ("3,2,1,4", "the west, 3, must be less than the east, 1"),
            ("1,4,3,2", "the south, 4, must be less"),
            ("1,2,3", "is not W,S,E,N"),
            ("1,2,3,inf", "is not W,S,E,N"),
        ] {
            let why = text.parse::<Bounds>().unwrap_err();
            assert!(why.contains(expect), "{text}: {why}");
        }
    }
}
