//! What stands beside a file of heights that does not tell everything itself: NAME.json or NAME.toml, for NAME.r16 also NAME.r16.json.
//!
//! Keys: `width`, `height` (samples); `cell` (metres from one to the next); `low`, `high` (metres of 0 and 65535, or of 0 and 255);
//! `byte_order` ("little", unless "big"); `first_row` ("north", unless "south"); `nodata` (a sample that is no height). Others are left alone, so that the `summary.json`
//! which `orogen generate` writes beside `height.png` is one too.

use std::fs::File;
use std::io::Read;
use std::path::{Path, PathBuf};

use serde::Deserialize;

use super::dem::{Place, Unit, refused};
use crate::error::Result;

/// The longest text read.
const LONGEST: u64 = 1 << 20;

/// What a sidecar tells.
#[derive(Debug, Clone, Default, PartialEq, Deserialize)]
#[serde(default)]
pub struct Sidecar {
    /// Samples a row.
    pub width: Option<u64>,
    /// Rows.
    pub height: Option<u64>,
    /// Metres from one sample to the next.
    pub cell: Option<f64>,
    /// The height of a sample of 0.
    #[serde(alias = "height_min")]
    pub low: Option<f64>,
    /// The height of the largest sample there can be.
    #[serde(alias = "height_max")]
    pub high: Option<f64>,
    /// "little" or "big".
    pub byte_order: Option<String>,
    /// "north" or "south".
    pub first_row: Option<String>,
    /// The sample that is no height.
    pub nodata: Option<f64>,
}

impl Sidecar {
    /// The one beside `path`; none if there is none.
    ///
    /// # Errors
    /// If there is one that cannot be read.
    pub fn beside(path: &Path) -> Result<Option<Sidecar>> {
        let mut places: Vec<PathBuf> = vec![own(path), path.with_extension("json"), path.with_extension("toml")];
        if path.file_name().is_some_and(|name| name == "height.png" || name == "height8.png") {
            places.push(path.with_file_name("summary.json"));
        }
        match places.into_iter().find(|place| place.is_file()) {
            Some(place) => Sidecar::read(&place).map(Some),
            None => Ok(None),
        }
    }

    fn read(path: &Path) -> Result<Sidecar> {
        let name = path.display().to_string();
        let mut text = String::new();
        let opened = File::open(path).and_then(|file| file.take(LONGEST).read_to_string(&mut text));
        opened.map_err(|cause| refused(&name, cause.to_string()))?;
        let toml = path.extension().is_some_and(|extension| extension == "toml");
        Sidecar::parse(&text, toml).map_err(|why| refused(&name, why))
    }

    /// From a text of TOML or JSON.
    ///
    /// # Errors
    /// A sentence.
    pub fn parse(text: &str, toml: bool) -> std::result::Result<Sidecar, String> {
        let read: std::result::Result<Sidecar, String> = match toml {
            true => toml::from_str(text).map_err(|fault| fault.message().to_string()),
            false => serde_json::from_str(text).map_err(|fault| fault.to_string()),
        };
        let sidecar = read.map_err(|fault| format!("it is no sidecar of heights: {fault}"))?;
        if sidecar.cell.is_some_and(|cell| !(cell.is_finite() && cell > 0.0)) {
            return Err("its `cell` is not above 0".into());
        }
        if [sidecar.low, sidecar.high].into_iter().flatten().any(|number| !number.is_finite()) {
            return Err("its `low` and `high` are not both numbers".into());
        }
        Ok(sidecar)
    }

    /// Whether samples of several bytes begin with the highest.
    ///
    /// # Errors
    /// If it says neither.
    pub fn big_endian(&self) -> std::result::Result<bool, String> {
        match self.byte_order.as_deref() {
            None | Some("little") => Ok(false),
            Some("big") => Ok(true),
            Some(other) => {
                Err(format!("the `byte_order` beside it is \"{}\", not \"little\" or \"big\"", other.escape_debug()))
            }
        }
    }

    /// Samples as they should be, row after row from the north.
    ///
    /// # Errors
    /// If it does not tell which row is first.
    pub fn from_north(&self, mut samples: Vec<f32>, width: usize) -> std::result::Result<Vec<f32>, String> {
        match self.first_row.as_deref() {
            None | Some("north") => Ok(samples),
            Some("south") => {
                let rows = samples.len() / width.max(1);
                for j in 0..rows / 2 {
                    let (upper, lower) = samples.split_at_mut((rows - 1 - j) * width);
                    upper[j * width..(j + 1) * width].swap_with_slice(&mut lower[..width]);
                }
                Ok(samples)
            }
            Some(other) => {
                Err(format!("the `first_row` beside it is \"{}\", not \"north\" or \"south\"", other.escape_debug()))
            }
        }
    }

    /// The heights of the least and the greatest sample.
    ///
    /// # Errors
    /// If it does not tell them.
    pub fn range(&self) -> std::result::Result<[f64; 2], String> {
        match (self.low, self.high) {
            (Some(low), Some(high)) => Ok([low, high]),
            _ => Err(needs("low and high, the metres of its least and greatest sample")),
        }
    }

    /// Where samples stand of which only the cell is known: from the origin.
    pub fn place(&self, rows: u64) -> Option<Place> {
        let cell = self.cell?;
        Some(Place { origin: [0.0, rows as f64 * cell - cell], step: [cell; 2], unit: Unit::Metres(1.0), keys: None })
    }
}

/// The sidecar of this file alone, whatever else is called NAME: NAME.r16.json.
pub fn own(path: &Path) -> PathBuf {
    let mut name = path.file_name().unwrap_or_default().to_os_string();
    name.push(".json");
    path.with_file_name(name)
}

/// The sentence for a file that does not tell enough.
pub fn needs(what: &str) -> String {
    format!("it does not tell {what}: write them into a file of the same name that ends in .json or .toml, beside it")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn toml_and_json_say_the_same() {
        let toml =
            Sidecar::parse("width = 3\nheight = 2\ncell = 10\nlow = -5\nhigh = 95.5\nother = 'x'", true).unwrap();
        let json =
            "{\"width\": 3, \"height\": 2, \"cell\": 10.0, \"height_min\": -5, \"height_max\": 95.5, \"seed\": 7}";
        assert_eq!(toml, Sidecar::parse(json, false).unwrap());
        assert_eq!((toml.range(), toml.big_endian()), (Ok([-5.0, 95.5]), Ok(false)));
        assert_eq!(toml.place(2).unwrap().origin, [0.0, 10.0]);
    }

    #[test]
    fn rows_from_the_south_are_turned() {
        let south = Sidecar { first_row: Some("south".into()), ..Sidecar::default() };
        for (samples, expect) in [
            (vec![1.0, 2.0, 3.0, 4.0], vec![3.0, 4.0, 1.0, 2.0]),
            (vec![1.0, 2.0, 3.0, 4.0, 5.0, 6.0], vec![5.0, 6.0, 3.0, 4.0, 1.0, 2.0]),
            (vec![1.0, 2.0], vec![1.0, 2.0]),
        ] {
            assert_eq!(south.from_north(samples, 2).unwrap(), expect);
        }
        assert_eq!(own(Path::new("a/b.r16")), Path::new("a/b.r16.json"));
    }

    #[test]
    fn wrong_ones_are_sentences() {
        for (text, expect) in [
            ("width = 'a'", "no sidecar of heights"),
            ("= 3", "no sidecar of heights"),
            ("cell = 0", "`cell` is not above 0"),
            ("low = nan", "not both numbers"),
        ] {
            let why = Sidecar::parse(text, true).unwrap_err();
            assert!(why.contains(expect), "{text}: {why}");
        }
        let across = Sidecar { first_row: Some("east".into()), ..Sidecar::default() };
        assert!(across.from_north(vec![1.0], 1).unwrap_err().contains("\"east\""));
        let middle = Sidecar { byte_order: Some("middle".into()), ..Sidecar::default() };
        assert!(middle.big_endian().unwrap_err().contains("\"middle\""));
        assert!(middle.range().unwrap_err().contains("low and high"));
    }
}
