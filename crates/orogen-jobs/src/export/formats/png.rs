//! Grayscale pictures, heights encoded in colors, normal maps and splat maps.

use std::io;

use crate::export::channels::{self, NORMAL, PREVIEW, WEIGHTS};
use crate::export::derived::layer::Nature;
use crate::export::files::Files;
use crate::export::format::{Format, refuse};
use crate::export::layer_source::LayerSource;
use crate::export::memory::{aside, whole};
use crate::export::place;
use crate::export::quantizer::{self, BITS, FIRST_ROW, Quantizer, RANGE};
use crate::export::sidecar::{NO_SIDECAR, SampleEncoding};
use crate::options::{OptionSpec, Options, ValueKind};
use orogen_engine::recipe::surface::document::MAX_SURFACES;
use orogen_io::format::encoding::Encoding;
use orogen_io::format::notes;
use orogen_io::format::notes::SOFTWARE;
use orogen_io::format::png::{self, Picture, Pixel};

/// The format.
pub static FORMAT: Format = Format {
    name: "png",
    aliases: &[],
    about: "Grey PNG of 16 or 8 bits (black is the lowest value, white the highest), heights encoded as colors (--encoding), normals, weights or colors",
    options: &[BITS, RANGE, FIRST_ROW, ENCODING, NORMAL, WEIGHTS, PREVIEW, NO_SIDECAR],
    channels: MAX_SURFACES,
    features: false,
    memory: |window, _| aside(2 * whole(window)),
    write,
};

/// The option for heights encoded in colors.
const ENCODING: OptionSpec = OptionSpec::new("encoding", "NAME", ValueKind::Word(&["terrarium", "terrain-rgb"]))
    .with_about(
        "Heights encoded in red, green and blue: terrarium, in steps of 1/256 m, or terrain-rgb, in steps of 1/10 m",
    );

fn write(source: &mut LayerSource, options: &Options, files: &mut Files) -> io::Result<String> {
    let fits = |nature: Nature| source.nature() == nature;
    for (option, holds, what) in [
        (NORMAL.name, fits(Nature::Normal), "the layer `normal`"),
        (WEIGHTS.name, fits(Nature::Weights), "the layer `splat`"),
        (PREVIEW.name, fits(Nature::Weights), "the layer `splat`"),
        (RANGE.name, fits(Nature::Numbers), "plain numbers"),
        (ENCODING.name, fits(Nature::Numbers), "plain numbers"),
        (FIRST_ROW.name, fits(Nature::Numbers) || fits(Nature::Weights), "plain numbers and weights"),
        (BITS.name, fits(Nature::Numbers) || fits(Nature::Normal), "plain numbers and normals"),
    ] {
        if options.has(option) && !holds {
            return refuse(format!("--{option} applies to {what}; leave it out for `{}`", source.layer()));
        }
    }
    match source.nature() {
        Nature::Normal => return channels::write_normals(source, options, files),
        Nature::Weights => return channels::write_weights(source, options, files),
        Nature::Color => return channels::write_color(source, files),
        Nature::Numbers => {}
    }
    match Encoding::ALL.into_iter().find(|encoding| options.word("encoding") == Some(encoding.name())) {
        Some(encoding) => write_encoded(source, options, files, encoding),
        None => write_grey(source, options, files),
    }
}

fn write_grey(source: &mut LayerSource, options: &Options, files: &mut Files) -> io::Result<String> {
    let (window, most) = (*source.window(), quantizer::most(options));
    let mut quantized = Quantizer::new(source, options, most, files)?;
    let levels = quantized.levels();
    let pixel = if most == 255 { Pixel::Grey8 } else { Pixel::Grey16 };
    let notes = notes::of_heights(window.cell, &levels);
    let notes: Vec<(&str, &str)> = notes.iter().map(|(keyword, text)| (*keyword, text.as_str())).collect();
    let picture = Picture::new(window.width, window.height, pixel).with_notes(&notes);
    files.write(|out| {
        png::write_through(out, &picture, |out| {
            quantized.rows(|samples| quantizer::write_levels(out, samples, &levels, most))
        })
    })?;
    let encoding = SampleEncoding::of_levels(levels, most, "big", quantizer::from_south(options));
    let told = place::write_with_sidecar(files, source, options, &encoding)?;
    Ok(quantizer::words(&levels, most) + &told)
}

fn write_encoded(
    source: &mut LayerSource,
    options: &Options,
    files: &mut Files,
    encoding: Encoding,
) -> io::Result<String> {
    if let Some(other) = ["bits", "range"].into_iter().find(|name| options.has(name)) {
        return refuse(format!("--encoding {} sets bits and range; leave out --{other}", encoding.name()));
    }
    let window = *source.window();
    let about = format!("heights in metres as {} colors; {} metres a sample", encoding.name(), window.cell);
    let notes = [("Software", SOFTWARE), ("Description", about.as_str())];
    let picture = Picture::new(window.width, window.height, Pixel::Data8).with_notes(&notes);
    let mut quantized = Quantizer::plain(source, options, files)?;
    files.write(|out| {
        png::write_through(out, &picture, |out| {
            quantized.rows(|samples| {
                let bytes: Vec<u8> = samples.iter().flat_map(|height| encoding.bytes(*height)).collect();
                out.write_all(&bytes)
            })
        })
    })?;
    let held = SampleEncoding {
        sample: encoding.name(),
        byte_order: None,
        levels: None,
        from_south: quantizer::from_south(options),
        ..SampleEncoding::default()
    };
    let told = place::write_with_sidecar(files, source, options, &held)?;
    let levels = source.levels();
    Ok(format!("{} to {} as {} colors{told}", levels.low(), levels.high(), encoding.name()))
}
