//! Pictures of several channels: normal maps, color maps, and splat maps.

use std::io::{self, Write};
use std::path::Path;

use super::files::{Files, suffixed};
use super::format::refuse;
use super::layer_source::LayerSource;
use super::sidecar::{self, SampleEncoding};
use super::{place, quantizer, weights_preview};
use crate::options::{OptionSpec, Options, ValueKind};
use orogen_grid::grid::Grid;
use orogen_io::format::levels::Levels;
use orogen_io::format::notes::SOFTWARE;
use orogen_io::format::png::{self, Picture, Pixel};
use orogen_io::format::weights;
use orogen_io::palette::color::Encoder;
use orogen_io::samples::interleaved;

/// The option for the direction of green in normal maps.
pub const NORMAL: OptionSpec = OptionSpec::new("normal", "WAY", ValueKind::Word(&["opengl", "directx"]))
    .with_about("Direction of green in a normal map: opengl (up) or directx (down) [default: opengl]");

/// The option for the layout of weights.
pub const WEIGHTS: OptionSpec = OptionSpec::new("weights", "HOW", ValueKind::Word(&["rgba", "layers"])).with_about(
    "Weights of a splat map: rgba, four per picture (NAME.png, NAME_2.png, ...), or layers, one grey picture \
             each (NAME_grass.png, ...) [default: rgba]",
);

/// The option for a picture of the surfaces in addition to the weights.
pub const PREVIEW: OptionSpec = OptionSpec::switch("preview").with_about(
    "Write a picture of a splat map beside it: the surfaces in their colors with relief shading \
             (NAME_preview.png)",
);

/// Writes normals as red (east), green (north, or south for DirectX) and blue (up); -1 to 1 is mapped to 0 to 255 or
/// 65535.
///
/// Fails if the source or the files fail.
pub fn write_normals(source: &mut LayerSource, options: &Options, files: &mut Files) -> io::Result<String> {
    let (window, most) = (*source.window(), if options.word("bits") == Some("16") { 65535 } else { 255 });
    let directx = options.word(NORMAL.name) == Some("directx");
    let green = if directx { "south (DirectX)" } else { "north (OpenGL)" };
    let about = format!("normals: red east, green {green}, blue up; {} metres a sample", window.cell);
    let notes = [("Software", SOFTWARE), ("Description", about.as_str())];
    let pixel = if most == 255 { Pixel::Data8 } else { Pixel::Data16 };
    let picture = Picture::new(window.width, window.height, pixel).with_notes(&notes);
    let levels = Levels::new(-1.0, 1.0);
    files.write(|out| {
        png::write_through(out, &picture, |out| {
            source.rows(|band| {
                (0..band[0].height()).try_for_each(|j| {
                    let row = interleaved([0, 1, 2].map(|part| band[part].row(j)), directx);
                    quantizer::write_levels(out, &row, &levels, most)
                })
            })
        })
    })?;
    let told = place::write(files, source, options, Some(false))?;
    Ok(format!("red east, green {green}, blue up{told}"))
}

/// Writes colors as 8-bit sRGB.
///
/// Fails if the source or the files fail.
pub fn write_color(source: &mut LayerSource, files: &mut Files) -> io::Result<String> {
    let window = *source.window();
    let about = format!("{}: unlit color, sRGB; {} metres a sample", source.layer(), window.cell);
    let notes = [("Software", SOFTWARE), ("Description", about.as_str())];
    let picture = Picture::new(window.width, window.height, Pixel::Rgb8).with_notes(&notes);
    let encoder = Encoder::new();
    files.write(|out| {
        png::write_through(out, &picture, |out| {
            source.rows(|band| {
                let [red, green, blue] = band else { return refuse("a color has three channels".into()) };
                let mut bytes = Vec::new();
                encoder.append_bytes(&mut bytes, [red, green, blue].map(Grid::data));
                out.write_all(&bytes)
            })
        })
    })?;
    Ok("unlit color, sRGB".to_string())
}

/// Writes weights, which add up to 255 wherever there is ground.
///
/// Fails if the source or the files fail, or if weights need several files and the output is a stream.
pub fn write_weights(source: &mut LayerSource, options: &Options, files: &mut Files) -> io::Result<String> {
    let Some(path) = files.path().map(Path::to_path_buf) else {
        return refuse("weights are written to several files, not to standard output; name a file with -o".into());
    };
    let (window, names) = (*source.window(), source.channel_names());
    let mut spool = files.spool();
    source.rows(|band| (0..band[0].height()).try_for_each(|row| spool.write_all(&weights::row_bytes(band, row))))?;
    let layers = options.word(WEIGHTS.name) == Some("layers");
    if layers && options.has(PREVIEW.name) && names.iter().any(|name| name == weights_preview::SUFFIX) {
        return refuse(format!("a surface is named `{0}`, as is the file of --{0}; use --weights rgba", PREVIEW.name));
    }
    let groups: Vec<Vec<usize>> = match layers {
        true => (0..names.len()).map(|k| vec![k]).collect(),
        false => (0..names.len()).collect::<Vec<usize>>().chunks(4).map(<[usize]>::to_vec).collect(),
    };
    let mut held =
        SampleEncoding { sample: "u8", from_south: quantizer::from_south(options), ..SampleEncoding::default() };
    for (n, group) in groups.iter().enumerate() {
        let suffix = match (layers, n) {
            (true, _) => format!("_{}", names[group[0]]),
            (false, 0) => String::new(),
            (false, _) => format!("_{}", n + 1),
        };
        let to = suffixed(&path, &suffix);
        let pixel = if layers { Pixel::Grey8 } else { Pixel::Weights8 };
        let channels: Vec<String> = group.iter().map(|k| names[*k].clone()).collect();
        let about = format!("weights of {}; {} metres a sample", channels.join(", "), window.cell);
        let notes = [("Software", SOFTWARE), ("Description", about.as_str())];
        let picture = Picture::new(window.width, window.height, pixel).with_notes(&notes);
        let from_south = held.from_south;
        let body = |out: &mut dyn Write| {
            png::write_through(out, &picture, |out| {
                let mut bytes = vec![0; names.len() * window.width];
                let mut pixels = vec![0; pixel.bytes() * window.width];
                (0..window.height).try_for_each(|j| {
                    let row = if from_south { window.height - 1 - j } else { j };
                    spool.read((row * bytes.len()) as u64, &mut bytes)?;
                    weights::select(&bytes, names.len(), group, &mut pixels, pixel.bytes());
                    out.write_all(&pixels)
                })
            })
        };
        match suffix.is_empty() {
            true => files.write(body)?,
            false => files.write_beside(|_| to.clone(), body)?,
        }
        place::write_for(files, &to, source, options, Some(from_south))?;
        held.channels.push((to, channels));
    }
    let told = sidecar::write(files, source, options, &held)?;
    drop(spool);
    let mut list: Vec<String> = (held.channels.iter())
        .map(|(path, channels)| {
            let file = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
            format!("{file}: {}", channels.join(", "))
        })
        .collect();
    if options.has(PREVIEW.name) {
        list.push(weights_preview::write(source, options, files)?);
    }
    Ok(format!("weights that add up to 255{told}\n  {}", list.join("\n  ")))
}
