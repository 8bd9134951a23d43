//! The Stanford polygon format.

use std::io;

use crate::export::files::Files;
use crate::export::format::Format;
use crate::export::mesh::{COLOR, EXAGGERATION, HEIGHT_CURVE, MAX_ERROR, Prepared, color, memory};
use crate::export::options::Options;
use crate::export::subject::Subject;
use crate::mesh::ply;

/// The format.
pub static FORMAT: Format = Format {
    name: "ply",
    aliases: &[],
    about: "Stanford polygon mesh, binary: metres, z up, normals, colours",
    options: &[MAX_ERROR, COLOR, EXAGGERATION, HEIGHT_CURVE],
    channels: 1,
    memory,
    write,
};

fn write(subject: &mut Subject, options: &Options, files: &mut Files) -> io::Result<String> {
    let mesh = Prepared::new(subject, options, 1)?;
    let colors = color(options, "vertex", files, false) == "vertex";
    let comments = mesh.comments("x east, y north, z up");
    files.write(|out| ply::write(out, &mesh.surface(0, colors), &comments))?;
    Ok(mesh.words())
}
