//! A picture of the surfaces in addition to their weights: `--preview`.

use std::io::{self, Write};

use super::derived::cover;
use super::derived::layer::{Channels, Nature};
use super::files::{Files, suffixed};
use super::format::refuse;
use super::layer_source::LayerSource;
use super::place;
use crate::options::Options;
use orogen_io::format::notes::SOFTWARE;
use orogen_io::format::png::{self, Picture, Pixel};
use orogen_io::spool::Spool;
use orogen_output::map::surface_picture::{SAMPLE, SurfacePacker, SurfacePainter};

/// The suffix of the picture's name, before the extension.
pub const SUFFIX: &str = "preview";

/// The albedo, the gradient and the height of each sample, in one pass over the world.
static ROWS: Channels = Channels {
    nature: Nature::Color,
    names: |_| ["R", "G", "B", "east", "north", "height"].map(String::from).to_vec(),
    prepare: cover::prepare_with_slopes,
    layers: |recipe| cover::shares_and_positions(recipe).into_iter().chain(cover::slopes()).collect(),
    make: Some(|recipe, layers, window| {
        let mut out = cover::of(recipe, layers).albedo(window);
        if let [heights, .., east, south] = layers {
            out.extend([east, south, heights].into_iter().filter_map(|layer| layer.crop(window)));
            out[4].data_mut().iter_mut().for_each(|rise| *rise = -*rise);
        }
        out
    }),
};

/// Writes the picture: the surfaces in their colors, blended by their weights, with the relief shading of maps. The
/// first row is the northernmost one. Returns its line of the final message.
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
                painter.paint(&row, &mut pixels);
                out.write_all(&pixels)
            })
        })
    };
    files.write_beside(|_| to.clone(), body)?;
    place::write_for(files, &to, source, options, Some(false))?;
    let name = to.file_name().unwrap_or_default().to_string_lossy().into_owned();
    Ok(format!("{name}: the surfaces in their colors"))
}

/// The samples of a window in a spool, row by row, and their painter.
fn spooled(source: &LayerSource, files: &Files) -> io::Result<(Spool, SurfacePainter)> {
    let mut packer = SurfacePacker::new(source.window().height);
    let mut spool = files.spool();
    for band in source.rows_of(&ROWS)? {
        let band = band?.0;
        let Some(band) = band.as_array::<6>() else { return refuse("a preview has six channels".into()) };
        for j in 0..band[0].height() {
            spool.write_all(&packer.pack(band.each_ref().map(|part| part.row(j))))?;
        }
    }
    Ok((spool, packer.painter(source.world().recipe().world.sea_level as f32)))
}
