//! A page in memory for pictures and text.

use std::io::{self, Write};
use std::ops::Range;

use orogen_io::format::png::{self, Picture, Pixel};

/// A color in sRGB bytes: red, green, blue.
pub type Ink = [u8; 3];

/// A page of pixels. Columns and rows count from the upper left corner. Writes to pixels outside of it are ignored.
#[derive(Debug, Clone, PartialEq)]
pub struct Canvas {
    width: usize,
    height: usize,
    pixels: Vec<Ink>,
}

impl Canvas {
    /// A page filled with one color.
    #[must_use]
    pub fn new(width: usize, height: usize, paper: Ink) -> Canvas {
        Canvas { width, height, pixels: vec![paper; width * height] }
    }

    /// A page with these pixels, row-major; missing pixels at the end are white.
    #[must_use]
    pub fn of(width: usize, height: usize, mut pixels: Vec<Ink>) -> Canvas {
        pixels.resize(width * height, [255; 3]);
        Canvas { width, height, pixels }
    }

    /// All pixels, row-major.
    #[must_use]
    pub fn pixels(&self) -> &[Ink] {
        &self.pixels
    }

    /// Pixels per row.
    #[must_use]
    pub fn width(&self) -> usize {
        self.width
    }

    /// Number of rows.
    #[must_use]
    pub fn height(&self) -> usize {
        self.height
    }

    /// The pixel in column `x` and row `y`; `None` outside the page.
    #[must_use]
    pub fn get(&self, x: i64, y: i64) -> Option<Ink> {
        self.index(x, y).map(|index| self.pixels[index])
    }

    /// Sets a pixel.
    pub fn set(&mut self, x: i64, y: i64, ink: Ink) {
        if let Some(index) = self.index(x, y) {
            self.pixels[index] = ink;
        }
    }

    /// Blends ink over a pixel with a coverage of 0 to 1.
    ///
    /// Blends bytes instead of linear light: dark letters on light paper then keep their weight.
    pub fn cover(&mut self, x: i64, y: i64, ink: Ink, share: f32) {
        if let Some(index) = self.index(x, y) {
            let share = share.clamp(0.0, 1.0);
            let under = self.pixels[index];
            self.pixels[index] =
                std::array::from_fn(|c| (f32::from(under[c]) * (1.0 - share) + f32::from(ink[c]) * share + 0.5) as u8);
        }
    }

    /// Fills a rectangle.
    pub fn fill(&mut self, columns: Range<i64>, rows: Range<i64>, ink: Ink) {
        let inside = |range: Range<i64>, side: usize| {
            let [start, end] = [range.start, range.end].map(|at| at.clamp(0, side as i64) as usize);
            start..end.max(start)
        };
        let (columns, rows) = (inside(columns, self.width), inside(rows, self.height));
        for y in rows {
            self.pixels[y * self.width..][columns.clone()].fill(ink);
        }
    }

    /// Writes the page as a PNG, in grayscale if it has no colors.
    pub fn write_png(&self, out: &mut dyn Write, notes: &[(&str, &str)]) -> io::Result<()> {
        let grey = self.pixels.iter().all(|[red, green, blue]| red == green && green == blue);
        let pixel = if grey { Pixel::Grey8 } else { Pixel::Rgb8 };
        let picture = Picture::new(self.width, self.height, pixel).with_notes(notes);
        png::write(out, &picture, |rows, bytes| {
            let pixels = &self.pixels[rows.start * self.width..rows.end * self.width];
            match grey {
                true => bytes.iter_mut().zip(pixels).for_each(|(byte, [grey, ..])| *byte = *grey),
                false => bytes.copy_from_slice(pixels.as_flattened()),
            }
            Ok(())
        })
    }

    fn index(&self, x: i64, y: i64) -> Option<usize> {
        let (x, y) = (usize::try_from(x).ok()?, usize::try_from(y).ok()?);
        (x < self.width && y < self.height).then(|| y * self.width + x)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_lies_outside_is_left_out() {
        let mut canvas = Canvas::new(4, 3, [9; 3]);
        let before = canvas.clone();
        for (x, y) in [(-1, 0), (0, -1), (4, 0), (0, 3), (i64::MIN, i64::MAX)] {
            canvas.set(x, y, [0; 3]);
            canvas.cover(x, y, [0; 3], 1.0);
            assert_eq!(canvas.get(x, y), None);
        }
        canvas.fill(4..9, 0..3, [0; 3]);
        canvas.fill(0..4, -5..0, [0; 3]);
        canvas.fill(Range { start: 3, end: 1 }, 0..3, [0; 3]);
        assert_eq!(canvas, before);
        canvas.fill(-3..2, 2..99, [0; 3]);
        assert_eq!((canvas.get(1, 2), canvas.get(2, 2), canvas.get(1, 1)), (Some([0; 3]), Some([9; 3]), Some([9; 3])));
    }

    #[test]
    fn ink_covers_by_its_share() {
        let mut canvas = Canvas::new(1, 1, [200, 100, 0]);
        canvas.cover(0, 0, [0, 100, 200], 0.25);
        assert_eq!(canvas.get(0, 0), Some([150, 100, 50]));
        canvas.cover(0, 0, [1, 2, 3], 7.0);
        assert_eq!(canvas.get(0, 0), Some([1, 2, 3]));
        canvas.cover(0, 0, [9, 9, 9], f32::NAN);
    }

    #[test]
    fn the_file_is_the_page() {
        let mut canvas = Canvas::new(3, 2, [255; 3]);
        canvas.set(2, 1, [1, 2, 3]);
        assert_eq!(written(&canvas), [&[255; 15][..], &[1, 2, 3]].concat());
    }

    #[test]
    fn a_page_without_color_is_written_as_greys() {
        let mut canvas = Canvas::new(3, 2, [255; 3]);
        canvas.set(2, 1, [7; 3]);
        assert_eq!(written(&canvas), [255, 255, 255, 255, 255, 7]);
    }

    fn written(canvas: &Canvas) -> Vec<u8> {
        let mut bytes = Vec::new();
        canvas.write_png(&mut bytes, &[]).unwrap();
        let mut reader = ::png::Decoder::new(io::Cursor::new(bytes)).read_info().unwrap();
        let mut data = vec![0; reader.output_buffer_size().unwrap()];
        reader.next_frame(&mut data).unwrap();
        data
    }
}
