//! Objects as MultiMesh resources of Godot 4.

use std::io;
use std::path::Path;

use crate::export::files::{Files, suffixed};
use crate::export::format::{Format, refuse};
use crate::export::layer_source::LayerSource;
use crate::export::mesh_objects::kinds;
use crate::export::vectors::scatter::LAYER;
use crate::options::Options;
use orogen_grid::words::count;
use orogen_io::format::tres;

/// The format.
pub static FORMAT: Format = Format {
    name: "tres",
    aliases: &[],
    about: "Godot 4 MultiMesh resources of the layer scatter, a file NAME_KIND.tres for each kind of objects",
    options: &[],
    channels: 1,
    features: true,
    memory: |_, _| 0,
    write,
};

fn write(source: &mut LayerSource, _: &Options, files: &mut Files) -> io::Result<String> {
    if !matches!(source.vectors(), [layer] if layer.name == LAYER.name) {
        return refuse(format!("a .tres file holds objects: use --layer {}", LAYER.name));
    }
    let Some(path) = files.path().map(Path::to_path_buf) else {
        return refuse(
            "objects are written to a file for each kind, not to standard output; name a file with -o".into(),
        );
    };
    let kinds = kinds(source, |object| object.height as f32)?;
    if kinds.is_empty() {
        return refuse(
            "there are no objects in this window; choose another one, or change the conditions of the recipe's scatter"
                .into(),
        );
    }
    for kind in &kinds {
        let to = suffixed(&path, &format!("_{}", kind.name));
        let transforms = kind.instances.iter().map(|instance| instance.transform());
        files.write_beside(|_| to.clone(), |out| tres::write_multimesh(out, transforms))?;
    }
    let list = kinds.iter().map(|kind| format!("{} of {}", count(kind.instances.len(), "object"), kind.name));
    Ok(list.collect::<Vec<_>>().join(", "))
}
