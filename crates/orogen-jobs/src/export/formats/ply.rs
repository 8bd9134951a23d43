//! The Stanford polygon format.

use std::io;

use crate::export::files::Files;
use crate::export::format::Format;
use crate::export::layer_source::LayerSource;
use crate::export::mesh::{COLOR, EXAGGERATION, HEIGHT_CURVE, MAX_ERROR, Prepared, color, memory};
use crate::export::mesh_tint::COLOR_RANGE;
use crate::options::Options;
use orogen_grid::error::{Error, ErrorKind};
use orogen_output::mesh::ply;

/// The format.
pub static FORMAT: Format = Format {
    name: "ply",
    aliases: &[],
    about: "Stanford PLY mesh (binary): metres, Z up, normals, colors or texture coordinates",
    options: &[MAX_ERROR, COLOR, COLOR_RANGE, EXAGGERATION, HEIGHT_CURVE],
    channels: 1,
    features: false,
    memory,
    write,
};

fn write(source: &mut LayerSource, options: &Options, files: &mut Files) -> io::Result<String> {
    let color = color(options, "vertex", files, false);
    if color == "texture" {
        let message = "a .ply file cannot hold a texture; use --color vertex or none, or write .glb or .obj";
        return Err(Error::new(ErrorKind::Request, message).into());
    }
    let colors = color == "vertex";
    let mesh = Prepared::new(source, options, 1)?;
    let comments = mesh.comments("x east, y north, z up");
    files.write(|out| ply::write(out, &mesh.surface(0, colors), &comments))?;
    Ok(mesh.words())
}
