//! A sheet as PDF (ISO 32000-1, version 1.4): one page, lines as paths, text as outlines, the picture as a compressed
//! image.

use std::fmt::Write as _;
use std::io::{self, Write};

use miniz_oxide::deflate::compress_to_vec_zlib;

use super::geometry::{Point, Rect, Size};
use super::scene::{Item, Scene, Step, WHITE, polygon};

/// Points per millimetre.
const POINT: f32 = 72.0 / 25.4;

/// Compression level of streams: 0 to 10.
const EFFORT: u8 = 6;

/// Writes a scene as a PDF with one page of the same size.
///
/// # Errors
/// Errors of `out`.
pub fn write(out: &mut dyn Write, scene: &Scene) -> io::Result<()> {
    let mut file = File { bytes: b"%PDF-1.4\n%\xe2\xe3\xcf\xd3\n".to_vec(), starts: Vec::new() };
    let mut page = Drawn { text: String::new(), height: scene.size.height, pictures: Vec::new(), covers: Vec::new() };
    if scene.page != WHITE {
        let corners = Rect::new(0.0, 0.0, scene.size.width, scene.size.height).corners();
        page.area(&polygon(corners), scene.page, 1.0);
    }
    scene.items.iter().for_each(|item| page.draw(item));
    let Size { width, height } = scene.size.map(|side| side * POINT);
    // Objects: 1 catalogue, 2 pages, 3 the page, 4 its content, 5 information, then pictures.
    let pictures: String = (0..page.pictures.len()).fold(String::new(), |mut text, k| {
        let _ = write!(text, "/P{k} {} 0 R ", 6 + k);
        text
    });
    let covers: String = page.covers.iter().enumerate().fold(String::new(), |mut text, (k, cover)| {
        let _ = write!(text, "/C{k} << /CA {cover:.3} /ca {cover:.3} >> ");
        text
    });
    file.object("<< /Type /Catalog /Pages 2 0 R >>");
    file.object("<< /Type /Pages /Kids [3 0 R] /Count 1 >>");
    file.object(&format!(
        "<< /Type /Page /Parent 2 0 R /MediaBox [0 0 {width:.3} {height:.3}] /Contents 4 0 R \
         /Resources << /XObject << {pictures}>> /ExtGState << {covers}>> >> >>"
    ));
    file.stream("", &compress_to_vec_zlib(page.text.as_bytes(), EFFORT));
    file.object(&format!("<< /Title <{}> /Producer (Orogen {}) >>", utf16(&scene.title), env!("CARGO_PKG_VERSION")));
    for (width, height, pixels) in &page.pictures {
        // Each row as differences from the one above (PNG filter 2), which halves the size.
        let stride = 3 * width;
        let mut rows = Vec::with_capacity((stride + 1) * height);
        let zeros = vec![0u8; stride];
        for j in 0..*height {
            let row = &pixels[j * stride..(j + 1) * stride];
            let above = if j > 0 { &pixels[(j - 1) * stride..j * stride] } else { &zeros };
            rows.push(2);
            rows.extend(row.iter().zip(above).map(|(byte, above)| byte.wrapping_sub(*above)));
        }
        let about = format!(
            "/Type /XObject /Subtype /Image /Width {width} /Height {height} /ColorSpace /DeviceRGB /BitsPerComponent 8 \
             /DecodeParms << /Predictor 15 /Colors 3 /Columns {width} >> "
        );
        file.stream(&about, &compress_to_vec_zlib(&rows, EFFORT));
    }
    file.end(out)
}

/// Objects written so far, and their offsets.
struct File {
    bytes: Vec<u8>,
    starts: Vec<usize>,
}

impl File {
    fn object(&mut self, body: &str) {
        self.begin();
        self.bytes.extend_from_slice(body.as_bytes());
        self.bytes.extend_from_slice(b"\nendobj\n");
    }

    fn stream(&mut self, about: &str, packed: &[u8]) {
        self.begin();
        let head = format!("<< {about}/Filter /FlateDecode /Length {} >>\nstream\n", packed.len());
        self.bytes.extend_from_slice(head.as_bytes());
        self.bytes.extend_from_slice(packed);
        self.bytes.extend_from_slice(b"\nendstream\nendobj\n");
    }

    fn begin(&mut self) {
        self.starts.push(self.bytes.len());
        self.bytes.extend_from_slice(format!("{} 0 obj\n", self.starts.len()).as_bytes());
    }

    fn end(mut self, out: &mut dyn Write) -> io::Result<()> {
        let table = self.bytes.len();
        let count = self.starts.len() + 1;
        let mut text = format!("xref\n0 {count}\n0000000000 65535 f \n");
        for start in &self.starts {
            let _ = writeln!(text, "{start:010} 00000 n ");
        }
        let _ = write!(text, "trailer\n<< /Size {count} /Root 1 0 R /Info 5 0 R >>\nstartxref\n{table}\n%%EOF\n");
        self.bytes.extend_from_slice(text.as_bytes());
        out.write_all(&self.bytes)
    }
}

/// The content of the page.
struct Drawn<'a> {
    text: String,
    /// The page's height in millimetres: y points up in PDF.
    height: f32,
    pictures: Vec<(usize, usize, &'a [u8])>,
    covers: Vec<f32>,
}

impl<'a> Drawn<'a> {
    fn draw(&mut self, item: &'a Item) {
        match item {
            Item::Picture { area, width, height, pixels } => {
                let (x, y) = (area.left * POINT, (self.height - area.top - area.height) * POINT);
                let number = self.pictures.len();
                let (w, h) = (area.width * POINT, area.height * POINT);
                let _ = writeln!(self.text, "q {w:.3} 0 0 {h:.3} {x:.3} {y:.3} cm /P{number} Do Q");
                self.pictures.push((*width, *height, pixels));
            }
            Item::Lines { lines, width, ink, cover } => {
                self.inks(*ink, *cover, "RG");
                let _ = writeln!(self.text, "{:.3} w 1 J 1 j", width * POINT);
                for line in lines {
                    let closed = line.len() > 2 && line.first() == line.last();
                    for (k, place) in line[..line.len() - usize::from(closed)].iter().enumerate() {
                        self.spot(*place);
                        self.text.push_str(if k == 0 { "m\n" } else { "l\n" });
                    }
                    self.text.push_str(if closed { "h\n" } else { "" });
                }
                self.text.push_str("S Q\n");
            }
            Item::Area { outline, ink, cover } => self.area(outline, *ink, *cover),
        }
    }

    fn area(&mut self, outline: &[Step], ink: [u8; 3], cover: f32) {
        self.inks(ink, cover, "rg");
        for (k, step) in outline.iter().enumerate() {
            match step {
                Step::Move(place) => {
                    self.text.push_str(if k > 0 { "h\n" } else { "" });
                    self.spot(*place);
                    self.text.push_str("m\n");
                }
                Step::Line(place) => {
                    self.spot(*place);
                    self.text.push_str("l\n");
                }
                Step::Curve(a, b, end) => {
                    [a, b, end].into_iter().for_each(|place| self.spot(*place));
                    self.text.push_str("c\n");
                }
            }
        }
        self.text.push_str("h f Q\n");
    }

    fn inks(&mut self, ink: [u8; 3], cover: f32, operator: &str) {
        let [red, green, blue] = ink.map(|byte| f32::from(byte) / 255.0);
        let number = self.covers.iter().position(|known| *known == cover).unwrap_or_else(|| {
            self.covers.push(cover);
            self.covers.len() - 1
        });
        let _ = writeln!(self.text, "q /C{number} gs {red:.3} {green:.3} {blue:.3} {operator}");
    }

    fn spot(&mut self, Point { x, y }: Point) {
        let _ = write!(self.text, "{:.2} {:.2} ", x * POINT, (self.height - y) * POINT);
    }
}

/// A text as hexadecimal UTF-16 with a byte order mark, as PDF requires for non-ASCII text.
fn utf16(text: &str) -> String {
    text.encode_utf16().fold(String::from("FEFF"), |mut hex, unit| {
        let _ = write!(hex, "{unit:04X}");
        hex
    })
}

#[cfg(test)]
mod tests {
    use super::super::geometry::Rect;
    use super::super::scene::{line, polygon};
    use super::*;
    use miniz_oxide::inflate::decompress_to_vec_zlib;

    #[test]
    fn objects_are_where_the_table_says() {
        let items = vec![
            Item::Picture { area: Rect::new(10.0, 20.0, 30.0, 40.0), width: 2, height: 2, pixels: (0..12).collect() },
            Item::Lines { lines: vec![line([[0.0, 0.0], [25.4, 0.0]])], width: 0.25, ink: [255, 0, 0], cover: 0.5 },
            Item::Area { outline: polygon([[0.0; 2], [1.0, 0.0], [1.0; 2]]), ink: [0; 3], cover: 1.0 },
        ];
        let mut out = Vec::new();
        write(&mut out, &Scene { items, ..Scene::new(Size::new(100.0, 50.0), "Höhe") }).unwrap();
        let find = |wanted: &[u8]| out.windows(wanted.len()).position(|window| window == wanted);
        let text = String::from_utf8_lossy(&out).to_string();
        let table: usize = text.rsplit("startxref\n").next().unwrap().lines().next().unwrap().parse().unwrap();
        assert_eq!(find(b"xref\n0 7\n"), Some(table));
        let rows =
            String::from_utf8_lossy(&out[table..]).lines().skip(3).take(6).map(str::to_string).collect::<Vec<_>>();
        for (k, row) in rows.iter().enumerate() {
            let start: usize = row[..10].parse().unwrap();
            assert!(out[start..].starts_with(format!("{} 0 obj", k + 1).as_bytes()), "{row}");
        }
        // The uncompressed drawing: 25.4 mm are 72 points, and y counts from the bottom.
        let start = find(b"4 0 obj").unwrap();
        let stream = start + out[start..].windows(7).position(|window| window == b"stream\n").unwrap() + 7;
        let drawn =
            String::from_utf8(decompress_to_vec_zlib(&out[stream..]).unwrap_or_else(|failed| failed.output)).unwrap();
        assert!(drawn.contains("72.00 141.73 l\nS Q"), "{drawn}");
        assert!(drawn.contains("/C0 gs 1.000 0.000 0.000 RG") && drawn.contains("/P0 Do Q"), "{drawn}");
        assert!(text.contains("/Title <FEFF004800F600680065>") && text.contains("/CA 0.500"));
    }
}
