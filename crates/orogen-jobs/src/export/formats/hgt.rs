//! SRTM tiles.

use std::io;

use crate::export::files::Files;
use crate::export::format::{Format, refuse};
use crate::export::layer_source::LayerSource;
use crate::options::Options;
use orogen_grid::grid::Window;
use orogen_io::format::dem::Georeference;
use orogen_io::format::hgt::{self, SIZES};

/// The format.
pub static FORMAT: Format = Format {
    name: "hgt",
    aliases: &[],
    about: "SRTM tile of 1201 x 1201 or 3601 x 3601 samples: heights rounded to whole metres, big-endian",
    options: &[],
    channels: 1,
    features: false,
    memory: |_, _| 0,
    write,
};

fn write(source: &mut LayerSource, _: &Options, files: &mut Files) -> io::Result<String> {
    let window = *source.window();
    if !SIZES.contains(&[window.width, window.height]) {
        let Window { width, height, .. } = window;
        let square = if width.max(height) < 2401 { 1201 } else { 3601 };
        // More samples on the same ground are closer together.
        let cell = match square > width.min(height) {
            true => window.cell * width.min(height) as f64 / (square - 1) as f64,
            false => window.cell,
        };
        let finer = if cell == window.cell { String::new() } else { format!("--cell {cell} ") };
        let [x, y] = [window.x, window.y].map(|at| (at as f64 * window.cell / cell).round());
        return refuse(format!(
            "an .hgt must have 1201 x 1201 or 3601 x 3601 samples, not {width} x {height}; the nearest is {finer}--window {x},{y},{square},{square}"
        ));
    }
    let name = files.path().map(|path| path.to_string_lossy().into_owned()).unwrap_or_default();
    files.write(|out| source.rows(|band| hgt::write(out, band[0].data())))?;
    let levels = source.levels();
    let place = match hgt::corner(&name) {
        Some(corner) if source.map().is_some_and(|map| !lies_at(&map, &window, corner)) => {
            "its name gives a south-west corner that is not its position; readers use the name".to_string()
        }
        Some([south, west]) => format!("its south-west corner at {south} north, {west} east"),
        None => "no georeference; readers take the south-west corner from a name such as N46E007.hgt".to_string(),
    };
    Ok(format!("{} to {}, rounded to whole metres; {place}", levels.low(), levels.high()))
}

/// Whether a window on a map is the one-degree tile with this south-west corner.
fn lies_at(map: &Georeference, window: &Window, [south, west]: [f64; 2]) -> bool {
    let [across, _, east, _, down, north] = map.affine(window, false).0;
    let step = [1.0 / (window.width - 1) as f64, 1.0 / (window.height - 1) as f64];
    let near = |a: f64, b: f64, step: f64| (a - b).abs() < 0.1 * step;
    let ends = [(west, east), (west + 1.0, east + across / step[0])];
    map.is_degrees()
        && ends.iter().all(|(wanted, is)| near(*wanted, *is, step[0]))
        && near(south + 1.0, north, step[1])
        && near(south, north + down / step[1], step[1])
}
