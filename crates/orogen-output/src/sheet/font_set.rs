//! Text as outlines, in the built-in font; characters that it lacks come from a system font.

use std::path::{Path, PathBuf};

use ab_glyph::{Font, FontRef, FontVec, GlyphId, OutlineCurve};

use super::geometry::{Affine, Point};
use super::scene::Step;
use crate::map::text::Face;
use orogen_grid::error::{Error, ErrorKind, Result};
use orogen_io::fs;

/// The fonts of a sheet.
pub struct FontSet {
    faces: [FontRef<'static>; 3],
    /// A system font for characters that the built-in font lacks.
    other: Option<FontVec>,
    /// Characters that no font has.
    lacking: Vec<char>,
}

/// Font folders of common systems.
const FOLDERS: [&str; 6] = [
    "/usr/share/fonts",
    "/usr/local/share/fonts",
    "/System/Library/Fonts",
    "/Library/Fonts",
    "C:\\Windows\\Fonts",
    "/run/current-system/sw/share/fonts",
];

/// Font folders within the user's home.
const OWN_FOLDERS: [&str; 3] = [".local/share/fonts", ".fonts", "Library/Fonts"];

/// Maximum depth of folders, number of fonts, and size of a font file.
const DEPTH: usize = 5;
const MAX_FONTS: usize = 2000;
const MAX_BYTES: u64 = 128 << 20;

impl FontSet {
    /// The fonts for `texts`. If the built-in font lacks characters, the first system font that has the most of them is
    /// added.
    ///
    /// # Errors
    /// If the built-in font cannot be read.
    pub fn for_texts<'a>(texts: impl IntoIterator<Item = &'a str>) -> Result<FontSet> {
        let face = |bytes: &'static [u8]| {
            let broken = |cause| Error::new(ErrorKind::File, format!("the built-in font cannot be read: {cause}"));
            FontRef::try_from_slice(bytes).map_err(broken)
        };
        let faces = [
            face(include_bytes!("../../assets/orogen-sans-regular.ttf"))?,
            face(include_bytes!("../../assets/orogen-sans-bold.ttf"))?,
            face(include_bytes!("../../assets/orogen-sans-italic.ttf"))?,
        ];
        let mut lacking: Vec<char> = texts
            .into_iter()
            .flat_map(str::chars)
            .filter(|letter| !letter.is_control() && faces[0].glyph_id(*letter).0 == 0)
            .collect();
        lacking.sort_unstable();
        lacking.dedup();
        let other = if lacking.is_empty() { None } else { search(&lacking) };
        if let Some(font) = &other {
            lacking.retain(|letter| font.glyph_id(*letter).0 == 0);
        }
        Ok(FontSet { faces, other, lacking })
    }

    /// Characters that neither the built-in font nor the system font has; they are omitted.
    #[must_use]
    pub fn lacking(&self) -> &[char] {
        &self.lacking
    }

    /// The width of a line of text, in millimetres; `size` is the em in millimetres.
    #[must_use]
    pub fn width(&self, text: &str, face: Face, size: f32) -> f32 {
        self.set(text, face, size, |_, _, _| {})
    }

    /// The outlines of a line of text that starts at `at`, along a baseline that rises by `angle` radians
    /// (counter-clockwise).
    #[must_use]
    pub fn write(&self, text: &str, face: Face, size: f32, at: Point, angle: f32) -> Vec<Step> {
        let on_page = Affine::turning(at, angle);
        let mut steps = Vec::new();
        self.set(text, face, size, |font, id, along| {
            outline(font, id, size, |spot| on_page.apply(spot.moved(along, 0.0)), &mut steps);
        });
        steps
    }

    /// The outline of each character separately, at the position that `place` returns for the distance of its center
    /// along the line: for curved text.
    pub fn each(&self, text: &str, face: Face, size: f32, mut place: impl FnMut(f32) -> (Point, f32)) -> Vec<Step> {
        let mut steps = Vec::new();
        self.set(text, face, size, |font, id, along| {
            let half = font.advance(id, size) / 2.0;
            let (at, angle) = place(along + half);
            let on_page = Affine::turning(at, angle);
            outline(font, id, size, |spot| on_page.apply(spot.moved(-half, 0.0)), &mut steps);
        });
        steps
    }

    /// Lays out a line: calls `each` with each character, its font and its position; returns the width of the line.
    fn set(&self, text: &str, face: Face, size: f32, mut each: impl FnMut(&dyn Glyphs, GlyphId, f32)) -> f32 {
        let own = &self.faces[match face {
            Face::Regular => 0,
            Face::Bold => 1,
            Face::Italic => 2,
        }];
        let (mut at, mut before) = (0.0, None);
        for letter in text.chars() {
            let id = own.glyph_id(letter);
            if id.0 != 0 {
                if let Some(before) = before {
                    at += own.kern_unscaled(before, id) * size / own.units_per_em().unwrap_or(1000.0);
                }
                each(own, id, at);
                at += own.advance(id, size);
                before = Some(id);
            } else if let Some(other) = &self.other {
                let id = other.glyph_id(letter);
                before = None;
                if id.0 != 0 {
                    each(other, id, at);
                    at += other.advance(id, size);
                }
            }
        }
        at
    }
}

/// Operations common to both kinds of fonts.
trait Glyphs {
    /// The distance to the next character, in the unit of `size`, an em.
    fn advance(&self, id: GlyphId, size: f32) -> f32;
    /// The outline in ems, y up.
    fn curves(&self, id: GlyphId) -> (Vec<OutlineCurve>, f32);
}

impl<F: Font> Glyphs for F {
    fn advance(&self, id: GlyphId, size: f32) -> f32 {
        self.h_advance_unscaled(id) * size / self.units_per_em().unwrap_or(1000.0)
    }

    fn curves(&self, id: GlyphId) -> (Vec<OutlineCurve>, f32) {
        let curves = self.outline(id).map(|outline| outline.curves).unwrap_or_default();
        (curves, self.units_per_em().unwrap_or(1000.0))
    }
}

fn outline(font: &dyn Glyphs, id: GlyphId, size: f32, place: impl Fn(Point) -> Point, steps: &mut Vec<Step>) {
    let (curves, em) = font.curves(id);
    let at = |x: f32, y: f32| place(Point::new(x * size / em, y * size / em));
    let mut last = None;
    for curve in curves {
        let (start, end) = match curve {
            OutlineCurve::Line(a, b) => (a, b),
            OutlineCurve::Quad(a, _, b) => (a, b),
            OutlineCurve::Cubic(a, _, _, b) => (a, b),
        };
        if last != Some((start.x, start.y)) {
            steps.push(Step::Move(at(start.x, start.y)));
        }
        last = Some((end.x, end.y));
        let end_at = at(end.x, end.y);
        steps.push(match curve {
            OutlineCurve::Line(..) => Step::Line(end_at),
            // A quadratic curve as a cubic one: its handles are two thirds of the way to the control point.
            OutlineCurve::Quad(a, h, b) => {
                let toward = |p: f32, h: f32| p + (h - p) * 2.0 / 3.0;
                Step::Curve(at(toward(a.x, h.x), toward(a.y, h.y)), at(toward(b.x, h.x), toward(b.y, h.y)), end_at)
            }
            OutlineCurve::Cubic(_, h, k, _) => Step::Curve(at(h.x, h.y), at(k.x, k.y), end_at),
        });
    }
}

/// The system font with the most of these characters; of equal ones the first by path.
fn search(lacking: &[char]) -> Option<FontVec> {
    let own = std::env::var_os("HOME").map(PathBuf::from);
    let own = own.iter().flat_map(|home| OWN_FOLDERS.map(|folder| home.join(folder)));
    let mut files = Vec::new();
    FOLDERS.iter().map(PathBuf::from).chain(own).for_each(|folder| gather(&folder, DEPTH, &mut files));
    files.sort();
    files.truncate(MAX_FONTS);
    let mut best: Option<(usize, FontVec)> = None;
    for path in files {
        let Some(font) = read(&path) else { continue };
        let has = lacking.iter().filter(|letter| font.glyph_id(**letter).0 != 0).count();
        if has > best.as_ref().map_or(0, |best| best.0) {
            best = Some((has, font));
        }
        if has == lacking.len() {
            break;
        }
    }
    best.map(|best| best.1)
}

fn gather(folder: &Path, depth: usize, files: &mut Vec<PathBuf>) {
    let Ok(entries) = fs::read_dir(folder) else { return };
    for path in entries.filter_map(|entry| Some(entry.ok()?.path())) {
        let extension = path.extension().unwrap_or_default().to_ascii_lowercase();
        if ["ttf", "otf", "ttc", "otc"].iter().any(|known| extension == *known) {
            files.push(path);
        } else if depth > 0 && fs::is_dir(&path) {
            gather(&path, depth - 1, files);
        }
    }
}

/// Reads a font file; of a collection, its first font.
fn read(path: &Path) -> Option<FontVec> {
    let length = fs::metadata(path).ok()?.len();
    if length > MAX_BYTES {
        return None;
    }
    FontVec::try_from_vec_and_index(fs::read(path).ok()?, 0).ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn outlines_stand_on_their_line_and_turn_with_it() {
        let letters = FontSet::for_texts([]).unwrap();
        let width = letters.width("HIH", Face::Regular, 10.0);
        let ends = |steps: &[Step]| {
            steps.iter().fold([f32::MAX, f32::MIN, f32::MAX, f32::MIN], |[l, r, t, b], step| {
                let (Step::Move(Point { x, y }) | Step::Line(Point { x, y }) | Step::Curve(_, _, Point { x, y })) =
                    *step;
                [l.min(x), r.max(x), t.min(y), b.max(y)]
            })
        };
        let [left, right, top, bottom] = ends(&letters.write("HIH", Face::Regular, 10.0, Point::new(5.0, 20.0), 0.0));
        assert!(left > 5.0 && right < 5.0 + width && right > 3.0 + width && (bottom - 20.0).abs() < 0.01);
        assert!((20.0 - top - 7.0).abs() < 0.6, "capitals are seven tenths of an em: {top}");
        // Rotated upwards: an offset to the right becomes an offset upwards.
        let quarter = std::f32::consts::FRAC_PI_2;
        let [left, right, top, bottom] =
            ends(&letters.write("HIH", Face::Regular, 10.0, Point::new(5.0, 20.0), quarter));
        assert!((right - 5.0).abs() < 0.01 && left < -1.0 && top < 21.0 - width && bottom < 20.0);
    }

    #[test]
    fn letters_that_nobody_has_are_named() {
        // No font has glyphs for noncharacters.
        let letters = FontSet::for_texts(["Höhe \u{fdd0}"]).unwrap();
        assert_eq!(letters.lacking(), ['\u{fdd0}']);
        let widths = ["Höhe", "Höhe\u{fdd0}"].map(|text| letters.width(text, Face::Bold, 5.0));
        assert_eq!(widths[0], widths[1]);
    }
}
