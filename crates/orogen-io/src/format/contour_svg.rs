//! Contours as SVG.

use std::io::{self, Write};

use crate::format::coordinates::append_path;
use crate::format::number::decimals;
use crate::format::svg::{MAX_PATH, pieces};
use orogen_grid::contour::levels::is_index;
use orogen_grid::contour::line::Line;
use orogen_grid::grid::Window;

/// Writes lines as an SVG of the window's extent, in metres, north up. Each height is a group with its name; the lines
/// are in paths of bounded length. Index contours, which are every fifth of `interval`, are thicker.
///
/// # Errors
/// Errors of `out`.
pub fn write(out: &mut dyn Write, lines: &[Line], window: &Window, interval: Option<f64>) -> io::Result<()> {
    let size = [window.width, window.height].map(|samples| samples.saturating_sub(1).max(1) as f64 * window.cell);
    let pixels = 1000.0 / size[0].max(size[1]);
    let decimals = decimals(window.cell);
    let origin = [window.east(0), window.south(0)];
    writeln!(
        out,
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{}\" height=\"{}\" viewBox=\"0 0 {} {}\">",
        (size[0] * pixels).round().max(1.0),
        (size[1] * pixels).round().max(1.0),
        size[0],
        size[1]
    )?;
    writeln!(
        out,
        "<g fill=\"none\" stroke=\"#8a5a2b\" stroke-linejoin=\"round\" vector-effect=\"non-scaling-stroke\">"
    )?;
    let mut text = String::new();
    for level in lines.chunk_by(|a, b| a.level == b.level) {
        let elevation = level[0].elevation;
        let index = interval.is_some_and(|interval| is_index(elevation, interval));
        let width = if index { 1.2 } else { 0.6 } / pixels;
        writeln!(out, "<g id=\"h{elevation}\" stroke-width=\"{width:.4}\">")?;
        text.clear();
        for line in level {
            let ring: Vec<[f64; 2]> = line.path().collect();
            for piece in pieces(&ring) {
                let closed = line.closed && piece.len() == ring.len();
                let piece = if closed { &piece[..piece.len() - 1] } else { piece };
                append_path(&mut text, piece, origin, decimals);
                if closed {
                    text.push('Z');
                }
                if text.len() > MAX_PATH {
                    writeln!(out, "<path d=\"{text}\"/>")?;
                    text.clear();
                }
            }
        }
        if !text.is_empty() {
            writeln!(out, "<path d=\"{text}\"/>")?;
        }
        writeln!(out, "</g>")?;
    }
    writeln!(out, "</g>\n</svg>")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_group_for_each_height() {
        let line = |elevation: f64, level, closed, points: &[[f64; 2]]| Line {
            elevation,
            level,
            closed,
            points: points.to_vec(),
        };
        let lines = [
            line(10.0, 0, false, &[[100.0, 200.0], [110.0, 205.0]]),
            line(10.0, 0, true, &[[101.0, 201.0], [102.0, 201.0], [101.0, 202.0]]),
            line(12.0, 1, false, &[[100.0, 210.0], [110.0, 210.0]]),
        ];
        let mut bytes = Vec::new();
        write(&mut bytes, &lines, &Window::new(11, 21, 1.0).at(100, 200), Some(2.0)).unwrap();
        let text = String::from_utf8(bytes).unwrap();
        assert!(text.contains("viewBox=\"0 0 10 20\"") && text.contains("width=\"500\" height=\"1000\""), "{text}");
        assert!(text.contains("id=\"h10\" stroke-width=\"0.0240\">\n<path d=\"M0 0L10 5M1 1L2 1L1 2Z\"/>"), "{text}");
        assert!(text.contains("id=\"h12\" stroke-width=\"0.0120\">\n<path d=\"M0 10L10 10\"/>"), "{text}");
    }

    #[test]
    fn no_path_is_too_long_for_a_reader() {
        let ring: Vec<[f64; 2]> = (0..9000).map(|k| [f64::from(k % 300), f64::from(k) * 0.01]).collect();
        let line = Line { elevation: 10.0, level: 0, closed: true, points: ring };
        let mut bytes = Vec::new();
        write(&mut bytes, &[line.clone(), line], &Window::new(300, 200, 1.0), None).unwrap();
        let text = String::from_utf8(bytes).unwrap();
        let paths: Vec<&str> = text.lines().filter(|line| line.starts_with("<path")).collect();
        assert!(paths.len() > 1 && paths.iter().all(|path| path.len() < 100_000), "{}", paths.len());
        // Two rings of 9000 segments, in five pieces each.
        assert_eq!(paths.iter().map(|path| path.matches('L').count()).sum::<usize>(), 18_000);
        assert_eq!(paths.iter().map(|path| path.matches('M').count()).sum::<usize>(), 10);
    }
}
