//! A sheet as SVG: lines as paths, text as outlines, the picture embedded in tiles.

use std::fmt::Write as _;
use std::io::{self, Write};

use super::geometry::{Point, Rect, Size};
use super::scene::{Item, Scene, Step, WHITE};
use crate::markup::{base64, escaped};
use orogen_io::format::png::{self, Picture, Pixel};
use orogen_io::format::svg::{self, MAX_PATH};
use orogen_io::palette::color::hex;

/// Side of a picture tile in pixels: even an incompressible tile takes less than 1 MiB in base64.
const TILE: usize = 432;

/// Overlap of a tile with its right and lower neighbors, in pixels. Viewers blend the edge of a picture with the
/// background. Because of the overlap, the background of a tile's left and upper edge is the same picture, down to a
/// scale of 1 to this many pixels.
const OVERLAP: usize = 16;

/// Writes a scene, in millimetres.
///
/// # Errors
/// Errors of `out`.
pub fn write(out: &mut dyn Write, scene: &Scene) -> io::Result<()> {
    let Size { width, height } = scene.size;
    writeln!(
        out,
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width:.3}mm\" height=\"{height:.3}mm\" viewBox=\"0 0 {width:.3} {height:.3}\">"
    )?;
    writeln!(out, "<title>{}</title>", escaped(&scene.title))?;
    let page = if scene.page == WHITE { "#fff".into() } else { hex(scene.page) };
    writeln!(out, "<rect width=\"100%\" height=\"100%\" fill=\"{page}\"/>")?;
    let mut text = String::new();
    for item in &scene.items {
        text.clear();
        match item {
            Item::Picture { area, width, height, pixels } => embed(out, *area, [*width, *height], pixels)?,
            Item::Lines { lines, width, ink, cover } => {
                let paths = paths(lines);
                // Translucent lines must have uniform opacity where two paths meet.
                let (group, stroke) = if paths.len() > 1 { (*cover, 1.0) } else { (1.0, *cover) };
                if paths.len() > 1 {
                    writeln!(out, "<g opacity=\"{group}\">")?;
                }
                for path in &paths {
                    writeln!(
                        out,
                        "<path fill=\"none\" stroke=\"{}\" stroke-width=\"{width:.3}\" stroke-opacity=\"{stroke}\" \
                         stroke-linejoin=\"round\" stroke-linecap=\"round\" d=\"{path}\"/>",
                        hex(*ink)
                    )?;
                }
                if paths.len() > 1 {
                    writeln!(out, "</g>")?;
                }
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
                if text.len() > MAX_PATH {
                    svg::pad(out)?;
                }
            }
        }
    }
    writeln!(out, "</svg>")
}

/// Embeds a picture as overlapping tiles.
fn embed(out: &mut dyn Write, area: Rect, size: [usize; 2], pixels: &[u8]) -> io::Result<()> {
    let [x, y, w, h] = [area.left, area.top, area.width, area.height].map(f64::from);
    let (across, down) = (w / size[0] as f64, h / size[1] as f64);
    for top in (0..size[1]).step_by(TILE) {
        for left in (0..size[0]).step_by(TILE) {
            let width = (TILE + OVERLAP).min(size[0] - left);
            let height = (TILE + OVERLAP).min(size[1] - top);
            let mut file = Vec::new();
            let picture = Picture::new(width, height, Pixel::Rgb8);
            png::write(&mut file, &picture, |rows, bytes| {
                for (row, bytes) in rows.zip(bytes.chunks_exact_mut(3 * width)) {
                    let from = 3 * ((top + row) * size[0] + left);
                    bytes.copy_from_slice(&pixels[from..from + 3 * width]);
                }
                Ok(())
            })?;
            write!(
                out,
                "<image x=\"{:.4}\" y=\"{:.4}\" width=\"{:.4}\" height=\"{:.4}\" preserveAspectRatio=\"none\" \
                 href=\"data:image/png;base64,",
                x + left as f64 * across,
                y + top as f64 * down,
                width as f64 * across,
                height as f64 * down
            )?;
            base64(out, &file)?;
            writeln!(out, "\"/>")?;
            svg::pad(out)?;
        }
    }
    Ok(())
}

/// Lines as path data, each not much longer than [`MAX_PATH`].
fn paths(lines: &[Vec<Point>]) -> Vec<String> {
    let mut paths = vec![String::new()];
    let mut text = String::new();
    for line in lines.iter().flat_map(|line| svg::pieces(line)) {
        let closed = line.len() > 2 && line.first() == line.last();
        let line = if closed { &line[..line.len() - 1] } else { line };
        text.clear();
        let mut last = [0, 0];
        for (k, place) in line.iter().enumerate() {
            // Relative to the rounded previous point, so that rounding errors do not accumulate.
            let here = [place.x, place.y].map(|part| (f64::from(part) * 1000.0).round() as i64);
            match k {
                0 => text.push('M'),
                1 => text.push('l'),
                _ => {}
            }
            thousandths(&mut text, here[0] - last[0], k > 1);
            thousandths(&mut text, here[1] - last[1], true);
            last = here;
        }
        if closed {
            text.push('Z');
        }
        match paths.last_mut() {
            Some(path) if path.is_empty() || path.len() + text.len() <= MAX_PATH => path.push_str(&text),
            _ => paths.push(text.clone()),
        }
    }
    paths
}

/// Writes a number of thousandths in as few characters as possible, after a space if `follows` requires one.
fn thousandths(text: &mut String, number: i64, follows: bool) {
    if follows && number >= 0 {
        text.push(' ');
    }
    if number < 0 {
        text.push('-');
    }
    let (whole, part) = (number.unsigned_abs() / 1000, number.unsigned_abs() % 1000);
    if whole > 0 || part == 0 {
        let _ = write!(text, "{whole}");
    }
    if part > 0 {
        let _ = write!(text, "{}", format!(".{part:03}").trim_end_matches('0'));
    }
}

/// A position with three decimals.
fn spot(text: &mut String, Point { x, y }: Point) {
    let _ = write!(text, "{} {}", (x * 1000.0).round() / 1000.0, (y * 1000.0).round() / 1000.0);
}

#[cfg(test)]
mod tests {
    use super::super::scene::line;
    use super::*;

    #[test]
    fn lines_stay_lines() {
        let items = vec![
            Item::Picture { area: Rect::new(1.0, 2.0, 3.0, 4.0), width: 1, height: 1, pixels: vec![1, 2, 3] },
            Item::Lines {
                lines: vec![line([[0.0, 0.0], [1.0, 0.5]]), line([[0.0; 2], [1.0; 2], [2.0, 0.0], [0.0; 2]])],
                width: 0.25,
                ink: [255, 0, 16],
                cover: 0.5,
            },
            Item::Area {
                outline: vec![
                    Step::Move(Point::default()),
                    Step::Curve(Point::new(1.0, 0.0), Point::new(2.0, 1.0), Point::new(2.0, 2.0)),
                ],
                ink: [0; 3],
                cover: 1.0,
            },
        ];
        let mut out = Vec::new();
        write(&mut out, &Scene { items, ..Scene::new(Size::new(210.0, 297.0), "A & <B>") }).unwrap();
        let text = String::from_utf8(out).unwrap();
        for expect in [
            "width=\"210.000mm\"",
            "<title>A &amp; &lt;B&gt;</title>",
            "data:image/png;base64,iVBORw0KGgo",
            "stroke=\"#ff0010\" stroke-width=\"0.250\" stroke-opacity=\"0.5\"",
            "d=\"M0 0l1 .5M0 0l1 1 1-1Z\"",
            "d=\"M0 0C1 0 2 1 2 2Z\"",
        ] {
            assert!(text.contains(expect), "{expect}: {text}");
        }
    }

    #[test]
    fn numbers_are_short() {
        let line = line([[1.5, -2.0], [1.562, -2.104], [1.562, -2.1], [0.0, 0.0], [12.0004, 0.0006]]);
        assert_eq!(paths(&[line]), ["M1.5-2l.062-.104 0 .004-1.562 2.1 12 .001"]);
    }

    #[test]
    fn no_element_is_too_long_for_a_reader() {
        // Noise does not compress.
        let [width, height] = [1100, 700];
        let pixels = (0..3 * width * height).map(|k: u32| (k.wrapping_mul(2_654_435_761) >> 13) as u8).collect();
        let picture = Item::Picture { area: Rect::new(0.0, 0.0, 110.0, 70.0), width: 1100, height: 700, pixels };
        let wave = |k: usize| line((0..400).map(|i| [i as f32 * 0.37, (k * i % 97) as f32 * 0.123]));
        let lines = Item::Lines { lines: (0..90).map(wave).collect(), width: 0.1, ink: [0; 3], cover: 0.5 };
        let mut out = Vec::new();
        write(&mut out, &Scene { items: vec![picture, lines], ..Scene::new(Size::new(110.0, 70.0), String::new()) })
            .unwrap();
        let text = String::from_utf8(out).unwrap();
        let longest = |tag: &str| {
            let lengths = text.lines().filter(|line| line.starts_with(tag)).map(str::len);
            (lengths.clone().count(), lengths.max().unwrap())
        };
        let ((pictures, image), (paths, path)) = (longest("<image"), longest("<path"));
        assert!(pictures == 6 && image > 900_000 && image < 1 << 20, "{pictures} of {image}");
        assert!(paths > 2 && path < (1 << 16) + 200, "{paths} of {path}");
        // All paths have the same opacity and are drawn as one group.
        assert!(text.contains("<g opacity=\"0.5\">") && text.matches("stroke-opacity=\"1\"").count() == paths);
        // Tiles overlap, and the last ones end at the edge of the picture.
        assert!(text.contains("<image x=\"0.0000\" y=\"0.0000\" width=\"44.8000\" height=\"44.8000\""));
        assert!(text.contains("<image x=\"86.4000\" y=\"43.2000\" width=\"23.6000\" height=\"26.8000\""));
    }
}
