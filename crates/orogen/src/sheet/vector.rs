//! A sheet as SVG: lines stay lines, words are outlines, the picture beneath them is embedded.

use std::fmt::Write as _;
use std::io::{self, Write};

use super::scene::{Item, Place, Scene, Step};
use crate::format::png::{self, Picture, Pixel};
use crate::palette::color::Rgb;

/// Writes a scene, its unit the millimetre.
///
/// # Errors
/// What writing brings.
pub fn write(out: &mut dyn Write, scene: &Scene) -> io::Result<()> {
    let [width, height] = scene.size;
    writeln!(
        out,
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width:.3}mm\" height=\"{height:.3}mm\" viewBox=\"0 0 {width:.3} {height:.3}\">"
    )?;
    writeln!(out, "<title>{}</title>", escaped(&scene.title))?;
    writeln!(out, "<rect width=\"100%\" height=\"100%\" fill=\"#fff\"/>")?;
    let mut text = String::new();
    for item in &scene.items {
        text.clear();
        match item {
            Item::Picture { area, width, height, pixels } => {
                let mut file = Vec::new();
                let picture = Picture { width: *width, height: *height, pixel: Pixel::Rgb8, notes: &[] };
                png::write(&mut file, &picture, |rows, bytes| {
                    bytes.copy_from_slice(&pixels[3 * rows.start * width..3 * rows.end * width]);
                    Ok(())
                })?;
                let [x, y, w, h] = area;
                write!(
                    out,
                    "<image x=\"{x:.3}\" y=\"{y:.3}\" width=\"{w:.3}\" height=\"{h:.3}\" preserveAspectRatio=\"none\" \
                     href=\"data:image/png;base64,"
                )?;
                base64(out, &file)?;
                writeln!(out, "\"/>")?;
            }
            Item::Lines { lines, width, ink, cover } => {
                for line in lines {
                    let closed = line.len() > 2 && line.first() == line.last();
                    let line = if closed { &line[..line.len() - 1] } else { line };
                    for (k, place) in line.iter().enumerate() {
                        text.push(if k == 0 { 'M' } else { 'L' });
                        spot(&mut text, *place);
                    }
                    if closed {
                        text.push('Z');
                    }
                }
                writeln!(
                    out,
                    "<path fill=\"none\" stroke=\"{}\" stroke-width=\"{width:.3}\" stroke-opacity=\"{cover}\" \
                     stroke-linejoin=\"round\" stroke-linecap=\"round\" d=\"{text}\"/>",
                    hex(*ink)
                )?;
            }
            Item::Area { outline, ink, cover } => {
                for (k, step) in outline.iter().enumerate() {
                    match step {
                        Step::Move(place) => {
                            text.push_str(if k == 0 { "M" } else { "ZM" });
                            spot(&mut text, *place);
                        }
                        Step::Line(place) => {
                            text.push('L');
                            spot(&mut text, *place);
                        }
                        Step::Curve(a, b, end) => {
                            text.push('C');
                            for (k, place) in [a, b, end].into_iter().enumerate() {
                                text.push_str(if k > 0 { " " } else { "" });
                                spot(&mut text, *place);
                            }
                        }
                    }
                }
                writeln!(out, "<path fill=\"{}\" fill-opacity=\"{cover}\" d=\"{text}Z\"/>", hex(*ink))?;
            }
        }
    }
    writeln!(out, "</svg>")
}

/// A place to a hundredth of a millimetre and a bit.
fn spot(text: &mut String, [x, y]: Place) {
    let _ = write!(text, "{} {}", (x * 1000.0).round() / 1000.0, (y * 1000.0).round() / 1000.0);
}

fn hex([red, green, blue]: Rgb) -> String {
    format!("#{red:02x}{green:02x}{blue:02x}")
}

fn escaped(text: &str) -> String {
    let text: String = text.chars().filter(|letter| !letter.is_control()).collect();
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;")
}

/// Writes bytes as base64 (RFC 4648).
fn base64(out: &mut dyn Write, bytes: &[u8]) -> io::Result<()> {
    const LETTERS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let mut text = Vec::with_capacity(4096);
    for chunk in bytes.chunks(3 * 1024) {
        text.clear();
        for three in chunk.chunks(3) {
            let at = |k: usize| u32::from(three.get(k).copied().unwrap_or(0));
            let bits = at(0) << 16 | at(1) << 8 | at(2);
            for k in 0..4 {
                let letter = LETTERS[(bits >> (18 - 6 * k)) as usize & 63];
                text.push(if k > three.len() { b'=' } else { letter });
            }
        }
        out.write_all(&text)?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn base64_is_the_standards() {
        for (bytes, expect) in [("", ""), ("f", "Zg=="), ("fo", "Zm8="), ("foo", "Zm9v"), ("foobar", "Zm9vYmFy")] {
            let mut out = Vec::new();
            base64(&mut out, bytes.as_bytes()).unwrap();
            assert_eq!(String::from_utf8(out).unwrap(), expect);
        }
    }

    #[test]
    fn lines_stay_lines() {
        let items = vec![
            Item::Picture { area: [1.0, 2.0, 3.0, 4.0], width: 1, height: 1, pixels: vec![1, 2, 3] },
            Item::Lines {
                lines: vec![vec![[0.0, 0.0], [1.0, 0.5]], vec![[0.0; 2], [1.0; 2], [2.0, 0.0], [0.0; 2]]],
                width: 0.25,
                ink: [255, 0, 16],
                cover: 0.5,
            },
            Item::Area {
                outline: vec![Step::Move([0.0; 2]), Step::Curve([1.0, 0.0], [2.0, 1.0], [2.0, 2.0])],
                ink: [0; 3],
                cover: 1.0,
            },
        ];
        let mut out = Vec::new();
        write(&mut out, &Scene { size: [210.0, 297.0], title: "A & <B>".into(), items }).unwrap();
        let text = String::from_utf8(out).unwrap();
        for expect in [
            "width=\"210.000mm\"",
            "<title>A &amp; &lt;B&gt;</title>",
            "data:image/png;base64,iVBORw0KGgo",
            "stroke=\"#ff0010\" stroke-width=\"0.250\" stroke-opacity=\"0.5\"",
            "d=\"M0 0L1 0.5M0 0L1 1L2 0Z\"",
            "d=\"M0 0C1 0 2 1 2 2Z\"",
        ] {
            assert!(text.contains(expect), "{expect}: {text}");
        }
    }
}
