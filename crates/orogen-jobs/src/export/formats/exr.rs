//! OpenEXR.

use std::io;

use crate::export::files::Files;
use crate::export::format::Format;
use crate::export::layer_source::LayerSource;
use crate::export::memory::{aside, whole};
use crate::export::place;
use crate::export::sidecar::NO_SIDECAR;
use crate::options::{OptionSpec, Options};
use orogen_engine::recipe::surface::document::MAX_SURFACES;
use orogen_grid::grid::Window;
use orogen_io::format::exr::{Picture, Sample, Writer};
use orogen_io::format::notes::SOFTWARE;

/// The format.
pub static FORMAT: Format = Format {
    name: "exr",
    aliases: &[],
    about: "OpenEXR of f32 in the layer's unit (metres for heights), one channel Y, ZIP compression",
    options: &[HALF, RGB, NO_SIDECAR],
    channels: MAX_SURFACES,
    features: false,
    memory,
    write,
};

/// The option for half floats.
pub const HALF: OptionSpec =
    OptionSpec::switch("half").with_about("16-bit floats instead of 32-bit; above 2048 m the resolution is 2 m");

/// The option for three channels.
pub const RGB: OptionSpec =
    OptionSpec::switch("rgb").with_about("Write the samples to the channels R, G and B instead of Y");

/// Compressed rows that are not yet written, and rows that are being arranged into blocks.
fn memory(window: &Window, _: &Options) -> u64 {
    aside(3 * whole(window)).saturating_add((window.width as u64).saturating_mul(4 * 3 * 600))
}

fn write(source: &mut LayerSource, options: &Options, files: &mut Files) -> io::Result<String> {
    let window = *source.window();
    let rgb = options.has("rgb") && source.channels() == 1;
    let channels = match rgb {
        true => ["R", "G", "B"].map(String::from).to_vec(),
        false if source.channels() == 1 => vec!["Y".to_string()],
        false => source.channel_names(),
    };
    let sample = if options.has("half") { Sample::Half } else { Sample::Float };
    let unit = if source.unit().is_empty() { "plain numbers" } else { source.unit() };
    let comments = format!("{SOFTWARE}: {} in {unit}; {} metres a sample", source.layer(), window.cell);
    let picture = Picture { width: window.width, height: window.height, channels, sample, comments };
    let mut writer = Writer::new(picture, files.spool())?;
    files.write(|out| {
        source.rows(|band| {
            let samples: Vec<&[f32]> = match rgb {
                true => vec![band[0].data(); 3],
                false => band.iter().map(|grid| grid.data()).collect(),
            };
            writer.rows(&samples)
        })?;
        writer.finish(out)
    })?;
    let levels = source.levels();
    let rounded = match sample {
        Sample::Half => format!(", the highest to steps of {}", half_step(levels.low().abs().max(levels.high().abs()))),
        Sample::Float => String::new(),
    };
    let told = place::write_on_map(files, source, options, if sample == Sample::Half { "f16" } else { "f32" })?;
    Ok(format!("{} to {}{rounded}{told}", levels.low(), levels.high()))
}

/// The distance between half floats at this magnitude.
fn half_step(value: f32) -> f32 {
    use orogen_io::format::half::{from_f32, to_f32};
    let half = from_f32(value.min(65000.0));
    to_f32(half + 1) - to_f32(half)
}
