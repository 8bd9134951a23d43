//! Points and samples as comma-separated values.

use std::io;

use crate::export::features::drawing::Drawing;
use crate::export::features::options::PROMINENCE;
use crate::export::files::Files;
use crate::export::format::{Format, refuse};
use crate::export::layer_source::LayerSource;
use crate::options::Options;
use orogen_io::format::csv;
use orogen_io::format::geojson::decimals;

/// The format.
pub static FORMAT: Format = Format {
    name: "csv",
    aliases: &[],
    about: "Comma-separated values: a line with x, y, z and attributes for each point, or with x, y and the value for each sample",
    options: &[PROMINENCE],
    channels: 1,
    features: true,
    memory: |_, _| 0,
    write,
};

fn write(source: &mut LayerSource, options: &Options, files: &mut Files) -> io::Result<String> {
    if source.vectors().is_empty() {
        if options.has(PROMINENCE.name) {
            return refuse(format!("--{} has no effect here; it applies to summits", PROMINENCE.name));
        }
        return samples(source, files);
    }
    let mut drawing = Drawing::of(source, options)?;
    drawing.place();
    let layer = drawing.only("csv")?;
    files.write(|out| csv::write(out, layer, decimals(drawing.step())))?;
    Ok(drawing.words() + without_crs(source))
}

/// The addition to the message for a world on a map: the file has no coordinate system.
fn without_crs(source: &LayerSource) -> &'static str {
    match source.map() {
        Some(map) if map.is_on_map() => "; without its coordinate system, which .csv cannot hold",
        _ => "",
    }
}

/// Writes a line for each sample, row by row from the north. A sample that is not finite has an empty value.
fn samples(source: &mut LayerSource, files: &mut Files) -> io::Result<String> {
    let (map, cell, layer) = (source.map(), source.window().cell, source.layer().to_string());
    let digits = decimals(map.as_ref().map_or(cell, |map| cell * map.per_metre[0].min(map.per_metre[1])));
    let mut lines = 0_u64;
    files.write(|out| {
        writeln!(out, "x,y,{layer}")?;
        let mut text = String::new();
        source.rows(|band| {
            let Some(grid) = band.first() else { return Ok(()) };
            for j in 0..grid.height() {
                let place = |i: usize| {
                    let [east, south] = [grid.window().east(i), grid.window().south(j)];
                    map.as_ref().map_or([east, -south], |map| map.at(east, south))
                };
                let places: Vec<[f64; 2]> = (0..grid.width()).map(place).collect();
                text.clear();
                csv::append_samples(&mut text, &places, digits, grid.row(j));
                lines += grid.width() as u64;
                out.write_all(text.as_bytes())?;
            }
            Ok(())
        })
    })?;
    Ok(format!("{lines} lines{}", without_crs(source)))
}
