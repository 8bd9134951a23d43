//! World files: six lines that state the position of a picture's pixels.
//!
//! Esri's format: column step eastward, rotations (two lines, 0), row step (negative if rows go south), east and north
//! of the center of the first pixel. `NAME.pgw` belongs to `NAME.png`; `NAME.wld` and `NAME.EXTw` to any raster.

use std::io::{self, Write};
use std::path::{Path, PathBuf};

use super::affine::Affine;

/// Maximum length of a file, in bytes.
pub const MAX_LENGTH: u64 = 1 << 12;

/// Writes a world file.
pub fn write(out: &mut dyn Write, affine: &Affine) -> io::Result<()> {
    let [a, b, c, d, e, f] = affine.0;
    [a, d, b, e, c, f].iter().try_for_each(|number| writeln!(out, "{number}"))
}

/// Parses a world file.
///
/// # Errors
/// A message if it does not contain six numbers.
pub fn parse(text: &str) -> Result<Affine, String> {
    let numbers: Option<Vec<f64>> = text.split_whitespace().map(|word| word.replace(',', ".").parse().ok()).collect();
    match numbers.as_deref() {
        Some([a, d, b, e, c, f]) => Ok(Affine([*a, *b, *c, *d, *e, *f])),
        _ => Err("a world file must have six numbers".into()),
    }
}

/// The name of the world file that Orogen writes for a raster: the name that programs look for first.
#[must_use]
pub fn beside(path: &Path) -> PathBuf {
    let is_png = path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("png"));
    path.with_extension(if is_png { "pgw" } else { "wld" })
}

/// The possible names of a raster's world file.
#[must_use]
pub fn names(path: &Path) -> Vec<PathBuf> {
    let extension = path.extension().unwrap_or_default().to_string_lossy().into_owned();
    let mut names = Vec::new();
    let letters: Vec<char> = extension.chars().collect();
    if let [first, .., last] = letters.as_slice() {
        names.push(path.with_extension(format!("{first}{last}w")));
    }
    if !extension.is_empty() {
        names.push(path.with_extension(format!("{extension}w")));
    }
    names.push(path.with_extension("wld"));
    names
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_written_is_read_back() {
        let affine = Affine([30.1, 0.0, 500_015.123_456_789, 0.0, -30.1, 5_199_985.0]);
        let mut bytes = Vec::new();
        write(&mut bytes, &affine).unwrap();
        let text = String::from_utf8(bytes).unwrap();
        assert_eq!(text, "30.1\n0\n0\n-30.1\n500015.123456789\n5199985\n");
        assert_eq!(parse(&text), Ok(affine));
        assert_eq!(parse("1,5 0 0 -1,5 2 3").unwrap().0, [1.5, 0.0, 2.0, 0.0, -1.5, 3.0]);
        assert!(parse("1 2 3").is_err() && parse("a b c d e f").is_err());
        assert_eq!(beside(Path::new("d/a.PNG")), Path::new("d/a.pgw"));
        assert_eq!(names(Path::new("a.png")), ["a.pgw", "a.pngw", "a.wld"].map(PathBuf::from));
    }
}
