//! Text on a page, in the built-in font: Latin letters, some Greek letters and symbols.
//!
//! Letters are drawn from their outlines with antialiasing and kerning. Horizontal positions are fractions of a pixel,
//! as the font specifies; baselines are whole pixels, which keeps the feet of letters sharp.

use ab_glyph::{Font, FontRef, Glyph, GlyphId, PxScale, point};

use super::canvas::{Canvas, Ink};
use orogen_grid::error::{Error, ErrorKind, Result};

/// A face of the font.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Face {
    /// For running text.
    Regular,
    /// For headings.
    Bold,
    /// For variables and notes.
    Italic,
}

/// The style of a text.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Style {
    /// The face.
    pub face: Face,
    /// The size in pixels per em; line spacing is usually 1.3 times the size.
    pub size: f32,
    /// The color.
    pub ink: Ink,
}

/// The built-in font.
#[derive(Debug)]
pub struct BuiltinFont {
    faces: [FontRef<'static>; 3],
}

impl BuiltinFont {
    /// Loads the built-in font.
    pub fn new() -> Result<BuiltinFont> {
        let face = |bytes: &'static [u8]| {
            let broken = |cause| Error::new(ErrorKind::File, format!("the built-in font cannot be read: {cause}"));
            FontRef::try_from_slice(bytes).map_err(broken)
        };
        Ok(BuiltinFont {
            faces: [
                face(include_bytes!("../../assets/orogen-sans-regular.ttf"))?,
                face(include_bytes!("../../assets/orogen-sans-bold.ttf"))?,
                face(include_bytes!("../../assets/orogen-sans-italic.ttf"))?,
            ],
        })
    }

    /// The width of a line of text, in pixels.
    #[must_use]
    pub fn width(&self, text: &str, style: Style) -> f32 {
        self.set(text, style, |_, _| {})
    }

    /// Draws a line of text from column `x` with its baseline at row `baseline`, and returns the column where it ends,
    /// from which text of another style may continue.
    pub fn write(&self, canvas: &mut Canvas, x: f32, baseline: i64, text: &str, style: Style) -> f32 {
        let font = self.face(style.face);
        let scale = scale(font, style.size);
        // Whole pixels are added at the end: far from 0, an outline in f32 would lose precision.
        let (whole, rest) = (x.floor(), x - x.floor());
        x + self.set(text, style, |id, at| {
            let start = rest + at;
            let column = start.floor();
            let glyph = Glyph { id, scale, position: point(start - column, 0.0) };
            let Some(outline) = font.outline_glyph(glyph) else {
                return;
            };
            let corner = outline.px_bounds().min;
            let left = (whole as i64).saturating_add((column + corner.x) as i64);
            let top = baseline.saturating_add(corner.y as i64);
            outline.draw(|i, j, share| {
                canvas.cover(left.saturating_add(i64::from(i)), top.saturating_add(i64::from(j)), style.ink, share);
            });
        })
    }

    /// The first character that the font lacks; `None` if it has all of them.
    #[must_use]
    pub fn lacking(&self, text: &str) -> Option<char> {
        text.chars().find(|letter| self.face(Face::Regular).glyph_id(*letter).0 == 0)
    }

    /// Breaks text at spaces into lines of at most `width` pixels. A longer word gets its own line.
    #[must_use]
    pub fn wrap(&self, text: &str, style: Style, width: f32) -> Vec<String> {
        let mut lines: Vec<String> = Vec::new();
        for word in text.split_whitespace() {
            match lines.last_mut() {
                Some(line) if self.width(&format!("{line} {word}"), style) <= width => {
                    line.push(' ');
                    line.push_str(word);
                }
                _ => lines.push(word.to_string()),
            }
        }
        lines
    }

    fn face(&self, face: Face) -> &FontRef<'static> {
        &self.faces[match face {
            Face::Regular => 0,
            Face::Bold => 1,
            Face::Italic => 2,
        }]
    }

    /// Lays out a line: calls `each` for each glyph with its distance from the line's start, and returns the line's
    /// width.
    fn set(&self, text: &str, style: Style, mut each: impl FnMut(GlyphId, f32)) -> f32 {
        let font = self.face(style.face);
        let unit = style.size / font.units_per_em().unwrap_or(1000.0);
        let (mut at, mut before) = (0.0, None);
        for letter in text.chars() {
            let id = font.glyph_id(letter);
            if let Some(before) = before {
                at += font.kern_unscaled(before, id) * unit;
            }
            each(id, at);
            at += font.h_advance_unscaled(id) * unit;
            before = Some(id);
        }
        at
    }
}

/// The font's scale is the height of a line; `size` is the size of an em.
fn scale(font: &FontRef, size: f32) -> PxScale {
    PxScale::from(size * font.height_unscaled() / font.units_per_em().unwrap_or(1000.0))
}

#[cfg(test)]
mod tests {
    use super::*;

    const PLAIN: Style = Style { face: Face::Regular, size: 20.0, ink: [0; 3] };

    /// Columns and rows with ink: the first and one past the last.
    fn inked(canvas: &Canvas) -> Option<[i64; 4]> {
        let mut bounds: Option<[i64; 4]> = None;
        for y in 0..canvas.height() as i64 {
            for x in 0..canvas.width() as i64 {
                if canvas.get(x, y) != Some([255; 3]) {
                    let [left, right, top, bottom] = bounds.unwrap_or([x, x + 1, y, y + 1]);
                    bounds = Some([left.min(x), right.max(x + 1), top.min(y), bottom.max(y + 1)]);
                }
            }
        }
        bounds
    }

    #[test]
    fn letters_stand_on_their_line_and_are_as_long_as_told() {
        let font = BuiltinFont::new().unwrap();
        for face in [Face::Regular, Face::Bold, Face::Italic] {
            let style = Style { face, ..PLAIN };
            let mut canvas = Canvas::new(200, 60, [255; 3]);
            let end = font.write(&mut canvas, 10.0, 40, "HEIGHT", style);
            assert_eq!(end, 10.0 + font.width("HEIGHT", style));
            let [left, right, top, bottom] = inked(&canvas).unwrap();
            assert!((9..=13).contains(&left) && (right as f32 - end).abs() < 4.0, "{left} {right} {end}");
            // Capitals are about 0.7 em high, and G and similar letters extend slightly below the baseline.
            assert!((24..=27).contains(&top) && (40..=41).contains(&bottom), "{top} {bottom}");
        }
    }

    #[test]
    fn smoothed_and_kerned() {
        let font = BuiltinFont::new().unwrap();
        let mut canvas = Canvas::new(60, 40, [255; 3]);
        font.write(&mut canvas, 5.3, 30, "O", PLAIN);
        let greys = (0..60).flat_map(|x| (0..40).map(move |y| (x, y)));
        let greys: Vec<u8> = greys.filter_map(|(x, y)| canvas.get(x, y)).map(|[grey, ..]| grey).collect();
        assert!(greys.contains(&0) && greys.iter().filter(|&&grey| grey > 40 && grey < 215).count() > 20);
        let apart = font.width("A", PLAIN) + font.width("V", PLAIN);
        assert!(font.width("AV", PLAIN) < apart - 0.5);
    }

    #[test]
    fn the_same_bits_at_any_whole_pixel_and_none_off_the_page() {
        let font = BuiltinFont::new().unwrap();
        let draw = |x: f32| {
            let mut canvas = Canvas::new(4200, 30, [255; 3]);
            font.write(&mut canvas, x, 22, "Ridged, k = 10", PLAIN);
            canvas
        };
        let (near, far) = (draw(7.25), draw(4007.25));
        assert!((0..190).all(|x| (0..30).all(|y| near.get(x, y) == far.get(x + 4000, y))));
        let mut canvas = Canvas::new(9, 9, [255; 3]);
        for (x, y) in [(-1e9, 5), (1e9, 5), (0.0, 4000), (1e30, i64::MAX), (f32::NAN, 3)] {
            font.write(&mut canvas, x, y, "gone", PLAIN);
        }
    }

    #[test]
    fn lines_are_cut_at_spaces() {
        let font = BuiltinFont::new().unwrap();
        let text = "heights from black to white, and an extraordinarilylongword among them";
        let lines = font.wrap(text, PLAIN, 120.0);
        assert_eq!(lines.join(" "), text);
        assert!(lines.len() > 4);
        for line in &lines {
            assert!(font.width(line, PLAIN) <= 120.0 || !line.contains(' '), "{line}");
        }
        assert!(font.wrap("  ", PLAIN, 50.0).is_empty());
    }

    #[test]
    fn every_letter_that_labels_may_need_is_there() {
        let font = BuiltinFont::new().unwrap();
        for face in [Face::Regular, Face::Bold, Face::Italic] {
            for letter in ('!'..='~').chain("äöüßéñøŁčλμ∑°±²·×–—’“”…−≈≤≥√".chars())
            {
                assert_ne!(font.face(face).glyph_id(letter).0, 0, "{letter}");
            }
        }
        assert_eq!((font.lacking("Höhe 12 m"), font.lacking("the 山 of")), (None, Some('山')));
    }
}
