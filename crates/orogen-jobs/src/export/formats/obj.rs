//! Wavefront OBJ with its material and texture.

use std::io;
use std::path::{Path, PathBuf};

use crate::export::files::Files;
use crate::export::format::Format;
use crate::export::layer_source::LayerSource;
use crate::export::mesh::{COLOR, EXAGGERATION, HEIGHT_CURVE, MAX_ERROR, Prepared, color, memory};
use crate::export::mesh_cover::{self, SURFACES};
use crate::export::mesh_tint::COLOR_RANGE;
use crate::options::Options;
use orogen_output::mesh::obj;

/// The format.
pub static FORMAT: Format = Format {
    name: "obj",
    aliases: &[],
    about: "Wavefront OBJ mesh (text): metres, Y up, normals, with NAME.mtl and NAME-texture.png",
    options: &[MAX_ERROR, COLOR, COLOR_RANGE, EXAGGERATION, HEIGHT_CURVE, SURFACES],
    channels: 1,
    features: false,
    memory,
    write,
};

fn write(source: &mut LayerSource, options: &Options, files: &mut Files) -> io::Result<String> {
    let mesh = Prepared::new(source, options, 1)?;
    let color = color(options, "texture", files, true);
    let comments = mesh.comments("x east, y up, z south");
    let path = files.path().map(Path::to_path_buf).filter(|_| color == "texture");
    let library = path.as_deref().map(|path| file_name(&material(path)));
    files.write(|out| obj::write(out, &mesh.surface(0, color == "vertex"), &comments, library.as_deref()))?;
    if let Some(path) = path {
        match mesh_cover::of(source, options, false)? {
            Some(pictures) => files.write_beside(picture, |out| out.write_all(&pictures.base))?,
            None => files.write_beside(picture, |out| mesh.picture(out))?,
        }
        files.write_beside(material, |out| obj::write_material(out, &file_name(&picture(&path))))?;
    }
    Ok(mesh.words())
}

fn material(path: &Path) -> PathBuf {
    path.with_extension("mtl")
}

/// The path of the texture. It is not the plain name with another extension, because a picture of the heights may use
/// that.
fn picture(path: &Path) -> PathBuf {
    let stem = path.file_stem().map(|stem| stem.to_string_lossy().into_owned()).unwrap_or_default();
    path.with_file_name(format!("{stem}-texture.png"))
}

fn file_name(path: &Path) -> String {
    path.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default()
}
