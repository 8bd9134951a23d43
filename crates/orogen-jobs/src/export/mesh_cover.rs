//! The surfaces of a recipe as textures of a mesh's material.

use std::io::{self, Write};

use super::derived::appended::{Appended, AppendedNode};
use super::derived::layer::Derived;
use super::derived::rows::Rows;
use super::derived::{albedo, cover, occlusion, roughness};
use super::format::refuse;
use super::layer_source::LayerSource;
use super::mesh::COLOR;
use crate::options::{OptionSpec, Options};
use orogen_engine::recipe::document::Recipe;
use orogen_grid::grid::{Grid, Window};
use orogen_io::format::png::{self, Picture, Pixel};
use orogen_io::palette::color::Encoder;
use orogen_output::mesh::normal_map;
use orogen_output::mesh::surface::Surface;

/// `--surfaces`.
pub const SURFACES: OptionSpec = OptionSpec::switch("surfaces").with_about(
    "Use the colors of the recipe's surfaces (or of the standard ones) instead of map colors; in glb with \
             roughness, occlusion, and normal maps for meshes with few triangles",
);

/// Adds the nodes to a recipe that compute its surfaces and occlusion, if the options request them; call it before the
/// world is opened.
pub fn prepare(recipe: &mut Recipe, options: &Options) {
    let none = Options::default();
    if let Some(mut to) = options.has(SURFACES.name).then(|| Appended::new(recipe, &none)).flatten() {
        cover::prepare(&mut to);
        occlusion::append(&mut to);
    }
}

/// Memory of the textures in addition to the mesh, in bytes.
#[must_use]
pub fn memory(window: &Window, options: &Options) -> u64 {
    let samples = (window.width as u64).saturating_mul(window.height as u64);
    // Albedo, roughness and occlusion as f32, and two compressed pictures of three bytes per sample; then normals as
    // f32, and the compressed normal maps.
    let levels = options.whole("lods").unwrap_or(1);
    if options.has(SURFACES.name) { samples.saturating_mul(26 + 3 * levels) } else { 0 }
}

/// PNG pictures with one pixel per sample.
pub struct Pictures {
    /// The base color, sRGB.
    pub base: Vec<u8>,
    /// Occlusion in red, roughness in green, metalness (0) in blue, linear, as in glTF.
    pub material: Vec<u8>,
}

/// The pictures, if the options request them; the picture for glTF's material is only made if `packed`.
///
/// Fails if the source fails, if the recipe was not [prepared](prepare), or if `--color` contradicts them.
pub fn of(source: &LayerSource, options: &Options, packed: bool) -> io::Result<Option<Pictures>> {
    if !options.has(SURFACES.name) {
        return Ok(None);
    }
    if options.word(COLOR.name).is_some_and(|color| color != "texture") {
        return refuse("--surfaces writes a texture; leave out --color, or use --color texture".into());
    }
    if source.world().recipe().expanded().is_empty() {
        return refuse("the surfaces of this recipe were not prepared before its world was opened".into());
    }
    let window = *source.window();
    let notes = [("Software", concat!("Orogen ", env!("CARGO_PKG_VERSION")))];
    let picture = |pixel| Picture::new(window.width, window.height, pixel).with_notes(&notes);
    let encoder = Encoder::new();
    let color = made(source, &albedo::LAYER)?;
    let base = packed_rows(&picture(Pixel::Rgb8), |row, bytes| {
        let mut pixels = Vec::with_capacity(bytes.len());
        encoder.append_bytes(&mut pixels, [0, 1, 2].map(|part| color[part].row(row)));
        bytes.copy_from_slice(&pixels);
    })?;
    drop(color);
    let mut material = Vec::new();
    if packed {
        let (rough, open) = (made(source, &roughness::LAYER)?, open(source)?);
        let byte = |share: f32| (share.clamp(0.0, 1.0) * 255.0 + 0.5) as u8;
        material = packed_rows(&picture(Pixel::Data8), |row, bytes| {
            let pairs = open.row(row).iter().zip(rough[0].row(row));
            for (pixel, (open, rough)) in bytes.chunks_exact_mut(3).zip(pairs) {
                pixel.copy_from_slice(&[byte(*open), byte(*rough), 0]);
            }
        })?;
    }
    Ok(Some(Pictures { base, material }))
}

/// The normal map of a level as PNG.
///
/// Fails if the picture cannot be compressed.
pub fn normal_map(level: &Surface) -> io::Result<Vec<u8>> {
    let (width, height) = (level.grid.width(), level.grid.height());
    let texels = normal_map::bake(level)?;
    let notes = [("Software", concat!("Orogen ", env!("CARGO_PKG_VERSION")))];
    packed_rows(&Picture::new(width, height, Pixel::Data8).with_notes(&notes), |row, bytes| {
        bytes.copy_from_slice(&texels[3 * width * row..][..3 * width]);
    })
}

/// A derived layer over the source's window.
fn made(source: &LayerSource, layer: &'static Derived) -> io::Result<Vec<Grid>> {
    let Some(channels) = layer.channels() else { return refuse(format!("`{}` has no channels", layer.name)) };
    let progress = source.progress().part(0.0);
    Ok(Rows::new(channels, source.world(), source.window(), 0, &progress)?.whole()?)
}

/// The occlusion over the source's window.
fn open(source: &LayerSource) -> io::Result<Grid> {
    let layer = AppendedNode::of("occlusion").name_of("occlusion");
    let mut all = Grid::filled(*source.window(), 0.0);
    for band in source.world().bands(&[&layer], source.window(), 0, &source.progress().part(0.0))? {
        band?.iter().for_each(|band| all.paste(band));
    }
    Ok(all)
}

/// A picture as PNG whose rows are computed by `fill`.
fn packed_rows(picture: &Picture, fill: impl Fn(usize, &mut [u8]) + Sync) -> io::Result<Vec<u8>> {
    let mut out = Vec::new();
    png::write_through(&mut out, picture, |out: &mut dyn Write| {
        let mut bytes = vec![0; picture.pixel.bytes() * picture.width];
        (0..picture.height).try_for_each(|row| {
            fill(row, &mut bytes);
            out.write_all(&bytes)
        })
    })?;
    Ok(out)
}
