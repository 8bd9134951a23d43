//! Hillshaded maps of 4096 x 4096 heights in memory, up to the last byte of the picture: all cores, wall time.

use std::io::{self, Write};
use std::time::Instant;

use orogen::Grid;
use orogen::io::palette::named;
use orogen::output::map::Painter;
use orogen::output::sheet::{SheetOptions, draw, raster};

use super::ground::ground;
use crate::measure::median;
use crate::options::Options;
use crate::world::figure::{Figure, Target};

const SIDE: usize = 4096;

/// Maximum time for a map, in seconds.
const MOST: f64 = 1.5;

/// Measures the plain map, one pixel per sample, and the map sheet at its default size.
pub fn measure(options: &Options) -> Result<Vec<Figure>, String> {
    let ground = ground(SIDE)?;
    let figure = |case: String, work: &dyn Fn(&Grid) -> Result<(), String>| {
        let mut times = Vec::new();
        for _ in 0..options.repetitions {
            let start = Instant::now();
            work(&ground)?;
            times.push(start.elapsed().as_secs_f64());
        }
        Ok::<Figure, String>(Figure {
            case,
            ours: median(&mut times),
            unit: "s",
            other: None,
            target: Target::AtMost(MOST),
        })
    };
    Ok(vec![
        figure(format!("hillshaded map of {SIDE} x {SIDE}, tint and shading, a pixel a sample, as PNG"), &|ground| {
            Painter::fit(ground, 0.0).write_png(&mut Counted(0), ground, None, &[]).map_err(|e| e.to_string())
        })?,
        figure(
            format!("map sheet of {SIDE} x {SIDE} heights, contours, labels, rivers, at 150 dpi, as PNG"),
            &|ground| {
                let drawn = draw(ground, &sheet(), &orogen::Progress::none()).map_err(|e| e.to_string())?;
                raster::draw(&drawn.scene, drawn.dpi).write_png(&mut Counted(0), &[]).map_err(|e| e.to_string())
            },
        )?,
    ])
}

fn sheet() -> SheetOptions {
    SheetOptions::new(named::all()[0].palette()).with_title("PreparedDem").with_sea_level(0.0)
}

/// Counts bytes.
struct Counted(u64);

impl Write for Counted {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.0 += bytes.len() as u64;
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}
