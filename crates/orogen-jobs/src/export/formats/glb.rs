//! glTF 2.0 as a single file.

use std::io;

use serde_json::{Map, json};

use crate::export::files::Files;
use crate::export::format::Format;
use crate::export::layer_source::LayerSource;
use crate::export::memory::whole;
use crate::export::mesh::{COLOR, EXAGGERATION, HEIGHT_CURVE, MAX_ERROR, Prepared, color, memory};
use crate::export::mesh_cover::{self, SURFACES};
use crate::export::mesh_objects::{self, OBJECTS};
use crate::export::mesh_tint::COLOR_RANGE;
use crate::export::mesh_water::{self, WATER, memory as water_memory};
use crate::options::{OptionSpec, Options, ValueKind};
use orogen_grid::grid::Window;
use orogen_output::mesh::glb::{Model, write as write_model};
use orogen_output::mesh::surface::Surface;

const LODS: OptionSpec = OptionSpec::new("lods", "N", ValueKind::Whole(1, 12)).with_about(
    "Number of levels of detail: each halves the samples, or doubles the error of --max-error [default: 1]",
);

/// The format.
pub static FORMAT: Format = Format {
    name: "glb",
    aliases: &[],
    about: "glTF 2.0 mesh in one binary file: metres, Y up, normals, texture",
    options: &[MAX_ERROR, LODS, COLOR, COLOR_RANGE, EXAGGERATION, HEIGHT_CURVE, WATER, OBJECTS, SURFACES],
    channels: 1,
    features: false,
    // Includes the picture, which must be compressed before its size is known.
    memory: |window, options| reserved(window, options).saturating_add(water_memory(window, options)),
    write,
};

fn reserved(window: &Window, options: &Options) -> u64 {
    memory(window, options).saturating_add(whole(window)).saturating_add(mesh_cover::memory(window, options))
}

fn write(source: &mut LayerSource, options: &Options, files: &mut Files) -> io::Result<String> {
    let mesh = Prepared::new(source, options, options.whole(LODS.name).unwrap_or(1) as usize)?;
    let color = color(options, "texture", files, false);
    let levels: Vec<Surface> = (0..mesh.shapes.len()).map(|level| mesh.surface(level, color == "vertex")).collect();
    // Before the pictures, so that too many objects are refused in less memory.
    let objects = mesh_objects::of(source, &mesh, options)?;
    let mut texture = Vec::new();
    let mut material = Vec::new();
    let mut normal_maps = Vec::new();
    match mesh_cover::of(source, options, true)? {
        Some(pictures) => {
            (texture, material) = (pictures.base, pictures.material);
            for (nth, level) in levels.iter().enumerate() {
                // A mesh of all samples already has their normals at its vertices.
                let is_full = nth == 0 && mesh.max_error().is_none();
                normal_maps.push(if is_full { None } else { Some(mesh_cover::normal_map(level)?) });
            }
        }
        None if color == "texture" => mesh.picture(&mut texture)?,
        None => {}
    }
    let window = mesh.grid.window();
    let extras: Map<String, serde_json::Value> = [
        ("cell".to_string(), json!(window.cell)),
        ("columns".to_string(), json!(window.width)),
        ("rows".to_string(), json!(window.height)),
    ]
    .into_iter()
    .chain(mesh.extras())
    .collect();
    let [texture, material] = [&texture, &material].map(|picture| (!picture.is_empty()).then_some(picture.as_slice()));
    let water = mesh_water::of(source, &mesh, options, reserved(source.window(), options))?;
    files.write(|out| {
        write_model(
            out,
            &Model {
                levels: &levels,
                texture,
                material,
                normal_maps: &normal_maps,
                bodies: &[],
                water: &water,
                objects: &objects,
                extras,
            },
        )
    })?;
    let also: String = water.iter().map(|water| format!(", {}", water.name)).collect();
    Ok(mesh.words() + &also + &mesh_objects::words(&objects))
}
