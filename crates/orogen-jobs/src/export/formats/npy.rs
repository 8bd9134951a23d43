//! NumPy arrays.

use std::io;

use crate::export::files::Files;
use crate::export::format::Format;
use crate::export::layer_source::LayerSource;
use crate::export::place;
use crate::export::sidecar::NO_SIDECAR;
use crate::options::Options;
use orogen_io::format::npy;

/// The format.
pub static FORMAT: Format = Format {
    name: "npy",
    aliases: &[],
    about: "NumPy array of f32 in the layer's unit (metres for heights); channels are the last axis",
    options: &[NO_SIDECAR],
    channels: 8,
    features: false,
    memory: |_, _| 0,
    write,
};

fn write(source: &mut LayerSource, options: &Options, files: &mut Files) -> io::Result<String> {
    let window = *source.window();
    files.write(|out| {
        if source.channels() == 1 {
            npy::write_header(out, window.width, window.height)?;
            return source.rows(|band| npy::write_rows(out, band[0].data()));
        }
        npy::write_shape(out, &[window.height, window.width, source.channels()])?;
        source.rows(|band| {
            (0..band[0].height()).try_for_each(|j| {
                let row: Vec<f32> = (0..window.width).flat_map(|i| band.iter().map(move |grid| grid[(i, j)])).collect();
                npy::write_rows(out, &row)
            })
        })
    })?;
    let levels = source.levels();
    let told = place::write_on_map(files, source, options, "f32")?;
    Ok(format!("{} to {}{told}", levels.low(), levels.high()))
}
