//! Palettes from files: the list of supported formats.

use std::path::Path;

use super::palette::Palette;
use super::{cpt, gdaldem, gpl, own, qgis};
use crate::open;
use orogen_grid::error::{Error, ErrorKind, Result};

/// Maximum size of a palette file, in bytes.
const MOST: u64 = 1 << 20;

/// Reads a palette: GMT's `.cpt`, GIMP's `.gpl`, Orogen's `.toml`; any other extension is read as a QGIS color map or a
/// `gdaldem` color file.
///
/// # Errors
/// If the file cannot be read, or cannot be parsed: the message contains the line.
pub fn read(path: &Path) -> Result<Palette> {
    let refused =
        |why: String| Error::new(ErrorKind::File, format!("cannot read the palette {}: {why}", path.display()));
    let Some(bytes) = open::bytes(path, "read", MOST)? else {
        return Err(refused(format!("it has more than {MOST} bytes, the maximum for a palette")));
    };
    let text = String::from_utf8(bytes).map_err(|_| refused("it is not UTF-8 text".into()))?;
    let name = path.file_stem().unwrap_or_default().to_string_lossy();
    let extension = path.extension().unwrap_or_default().to_string_lossy().to_ascii_lowercase();
    parse(&name, &extension, &text).map_err(refused)
}

/// [`read`] for a text in memory: `extension` determines the format.
///
/// # Errors
/// A message about what is wrong.
pub fn parse(name: &str, extension: &str, text: &str) -> std::result::Result<Palette, String> {
    // Windows editors write a byte order mark.
    let text = text.trim_start_matches('\u{feff}');
    match extension {
        "cpt" => cpt::parse(name, text),
        "gpl" => gpl::parse(name, text),
        "toml" => own::parse(name, text),
        _ if qgis::is_qgis(text) => qgis::parse(name, text),
        _ => gdaldem::parse(name, text),
    }
}

#[cfg(test)]
mod tests {
    use super::super::fitted::Fitted;
    use super::*;

    const TEXTS: [(&str, &str); 5] = [
        (
            "txt",
            "# QGIS Generated Color Map Export File\nINTERPOLATION:DISCRETE\n0,0,97,71,255,0\ninf,255,25,5,255,1, 500\n",
        ),
        (
            "cpt",
            "# COLOR_MODEL = +HSV\n# HINGE = 0\n# RANGE = -5/9\n-1 120-1-1 0 240 1 0.5 L\n0 #fed 1 4/3/2/1 ; sea\nB red\nF 7\nN -\n",
        ),
        (
            "gpl",
            "GIMP Palette\nName: Hills\nColumns: 3\n# by hand\n  0 10 20\tdeep\n 30 40 50\n255 255 255 white snow\n",
        ),
        (
            "toml",
            "name = \"A\"\nunit = \"sea\"\nmix = \"hsv\"\nstops = [[-1, \"navy\"], [0.5, \"#fa0\"]]\nabove = \"white\"\n",
        ),
        ("txt", "# a comment\n100%  white\n0% 0 100 0 255\n\n1500:10,20,30\nnv\tgrey50\ndefault 1 2 3\n-7e2 white\n"),
    ];

    #[test]
    fn a_byte_order_mark_is_ignored() {
        for (extension, text) in TEXTS {
            assert_eq!(parse("t", extension, &format!("\u{feff}{text}")), parse("t", extension, text), "{extension}");
        }
    }

    #[test]
    fn damage_is_no_danger() {
        read_damaged(1_000);
    }

    #[test]
    #[ignore = "long: 200 000 damaged texts of each format"]
    fn much_damage_is_no_danger() {
        read_damaged(200_000);
    }

    /// Damaged texts yield a message or a palette with colors, never a panic.
    fn read_damaged(rounds: usize) {
        let pieces =
            ["-", "/", "1e308", "nan", "#", "\n", " ", "%", "\"", "é", "[", "0", "B ", "=", ",", "99999999999", "\0"];
        let mut state = 0x2545_f491_4f6c_dd1du64;
        let mut next = |below: usize| {
            state ^= state << 13;
            state ^= state >> 7;
            state ^= state << 17;
            (state % below.max(1) as u64) as usize
        };
        for (extension, text) in TEXTS {
            let mut read = 0;
            for _ in 0..rounds {
                let mut letters: Vec<char> = text.chars().collect();
                for _ in 0..=next(4) {
                    let at = next(letters.len());
                    match next(3) {
                        0 => drop(letters.drain(at..(at + 1 + next(5)).min(letters.len()))),
                        1 => drop(letters.splice(at..at, pieces[next(pieces.len())].chars())),
                        _ if !letters.is_empty() => letters[at] = char::from(b' ' + next(95) as u8),
                        _ => {}
                    }
                }
                let text: String = letters.into_iter().collect();
                if let Ok(palette) = parse("damaged", extension, &text) {
                    read += 1;
                    let fitted = Fitted::new(&palette, -100.0, 900.0, 0.0);
                    for height in [f32::MIN, -50.0, 0.0, 7.0, 1e9, f32::NAN] {
                        assert!(fitted.at(height).iter().all(|c| c.is_finite()), "{text}");
                    }
                }
            }
            assert!(read > 0 && read < rounds, "{extension}: {read} of {rounds}");
        }
    }
}
