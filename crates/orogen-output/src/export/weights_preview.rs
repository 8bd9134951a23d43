//! A picture of the surfaces beside their weights: `--preview`.

use std::io::{self, Write};

use super::derived::cover::{self, Cover};
use super::derived::layer::{Nature, RowLayer, nothing};
use super::files::{Files, suffixed};
use super::format::refuse;
use super::layer_source::LayerSource;
use super::notes::SOFTWARE;
use super::options::Options;
use super::place;
use crate::map::shade::{PROBES, Shade, UNDER_WATER};
use crate::sheet::relief::PRINTED;
use orogen_grid::analysis::slope::{Gradient, gradients_between};
use orogen_grid::grid::{Grid, Window};
use orogen_io::format::levels::{NO_SAMPLES, extremes};
use orogen_io::format::png::{self, Picture, Pixel};
use orogen_io::palette::color::{Encoder, Rgb, decode};
use orogen_io::palette::tint::Tint;
use orogen_io::spool::Spool;

/// The end of the picture's name, before the extension.
pub const SUFFIX: &str = "preview";

/// Share of the tint of its depth in the color of ground below the sea.
const WATER: f32 = 0.93;

/// Bytes of a sample in the spool: an sRGB color, a gradient and a height.
const SAMPLE: usize = 15;

/// The albedo, the gradient and the height of each sample, in one pass over the world.
static ROWS: RowLayer = RowLayer {
    unit: "",
    nature: Nature::Color,
    channels: |_| ["R", "G", "B", "east", "north", "height"].map(String::from).to_vec(),
    prepare: nothing,
    layers: cover::shares_and_positions,
    reach: |_| 1,
    make: |around, window| {
        let mut out = Cover::new(around).albedo(window);
        let heights = around.bordered(window);
        let mut parts = vec![Grid::filled(*window, 0.0); 3];
        for j in 0..window.height {
            let rows = [heights.row(j), heights.row(j + 1), heights.row(j + 2)];
            gradients_between(rows, window.cell, |i, gradient| {
                let values = [gradient.east, gradient.north, heights[(i + 1, j + 1)]];
                parts.iter_mut().zip(values).for_each(|(part, value)| part.row_mut(j)[i] = value);
            });
        }
        out.extend(parts);
        out
    },
    lowered: None,
};

/// Writes the picture: the surfaces in their colors, mixed by their weights, with the relief shading of maps. The first row is the northern one.
/// Returns its line of the final message.
///
/// Fails if the world or the files fail.
pub fn write(source: &LayerSource, options: &Options, files: &mut Files) -> io::Result<String> {
    let Some(path) = files.path() else { return refuse("the preview is a file; name a file with -o".into()) };
    let (to, window) = (suffixed(path, &format!("_{SUFFIX}")), *source.window());
    let (mut samples, painter) = spooled(source, files)?;
    let about = format!("surfaces of {}; {} metres a sample", source.layer(), window.cell);
    let notes = [("Software", SOFTWARE), ("Description", about.as_str())];
    let picture = Picture::new(window.width, window.height, Pixel::Rgb8).with_notes(&notes);
    let body = |out: &mut dyn Write| {
        png::write_through(out, &picture, |out| {
            let (mut row, mut pixels) = (vec![0; SAMPLE * window.width], vec![0; 3 * window.width]);
            (0..window.height).try_for_each(|j| {
                samples.read((j * row.len()) as u64, &mut row)?;
                for (pixel, sample) in pixels.chunks_exact_mut(3).zip(row.as_chunks::<SAMPLE>().0) {
                    pixel.copy_from_slice(&painter.pixel(&Sample::of(sample)));
                }
                out.write_all(&pixels)
            })
        })
    };
    files.write_beside(|_| to.clone(), body)?;
    place::write_for(files, &to, source, options, Some(false))?;
    let name = to.file_name().unwrap_or_default().to_string_lossy().into_owned();
    Ok(format!("{name}: the surfaces in their colors"))
}

/// The samples of a window in a spool, row by row, and what paints them.
fn spooled(source: &LayerSource, files: &Files) -> io::Result<(Spool, Painter)> {
    let window: Window = *source.window();
    let encoder = Encoder::new();
    let mut spool = files.spool();
    let mut range = NO_SAMPLES;
    // Steepness and height of the samples of some rows.
    let (mut probes, every, mut row) = (Vec::new(), window.height.div_ceil(PROBES).max(1), 0);
    let mut bytes = Vec::with_capacity(SAMPLE * window.width);
    for band in source.rows_of(&ROWS)? {
        let band = band?.0;
        let [red, green, blue, east, north, heights] = band.as_slice() else {
            return refuse("a preview has six channels".into());
        };
        range = extremes(range, heights.data());
        for j in 0..heights.height() {
            bytes.clear();
            for i in 0..window.width {
                let gradient = Gradient { east: east[(i, j)], north: north[(i, j)] };
                let height = heights[(i, j)];
                bytes.extend(encoder.bytes([red[(i, j)], green[(i, j)], blue[(i, j)]]));
                [gradient.east, gradient.north, height].iter().for_each(|part| bytes.extend(part.to_le_bytes()));
                if row % every == 0 {
                    probes.push((gradient.steepness(), height));
                }
            }
            spool.write_all(&bytes)?;
            row += 1;
        }
    }
    let sea_level = source.world().recipe().world.sea_level as f32;
    let tint = Tint::hypsometric(range[0], range[1], sea_level);
    let shade = Shade::fit_samples(&probes, sea_level);
    Ok((spool, Painter { tint, shade, encoder }))
}

/// A sample as it is spooled.
struct Sample {
    color: Rgb,
    gradient: Gradient,
    height: f32,
}

impl Sample {
    fn of(bytes: &[u8; SAMPLE]) -> Sample {
        let number = |at: usize| f32::from_le_bytes([bytes[at], bytes[at + 1], bytes[at + 2], bytes[at + 3]]);
        Sample {
            color: [bytes[0], bytes[1], bytes[2]],
            gradient: Gradient { east: number(3), north: number(7) },
            height: number(11),
        }
    }
}

/// Paints samples like a map in the colors of its surfaces, except that the ground below the sea is not hidden.
struct Painter {
    tint: Tint,
    shade: Shade,
    encoder: Encoder,
}

impl Painter {
    fn pixel(&self, sample: &Sample) -> Rgb {
        if !sample.height.is_finite() {
            return sample.color;
        }
        let ground = sample.color.map(|part| (decode(part) * PRINTED).min(1.0));
        let factor = self.shade.on(sample.gradient);
        let (color, strength) = match self.tint.is_sea(sample.height) {
            true => {
                let water = self.tint.at(sample.height);
                (std::array::from_fn(|c| ground[c] + (water[c] - ground[c]) * WATER), UNDER_WATER)
            }
            false => (ground, 1.0),
        };
        self.encoder.bytes(std::array::from_fn(|c| color[c] * (1.0 + (factor[c] - 1.0) * strength)))
    }
}
