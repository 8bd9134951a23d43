//! Objects as tree instances of a Unity terrain.

use std::io;
use std::path::Path;

use serde::Serialize;

use crate::export::files::Files;
use crate::export::format::{Format, refuse};
use crate::export::layer_source::LayerSource;
use crate::export::mesh_objects::within;
use crate::export::quantizer::RANGE;
use crate::export::sidecar;
use crate::export::vectors::scatter::LAYER;
use crate::options::Options;
use orogen_engine::objects::Object;
use orogen_engine::world::HEIGHT;
use orogen_grid::grid::Window;
use orogen_grid::words::count;
use orogen_io::format::levels::Levels;
use orogen_io::format::notes::SOFTWARE;
use orogen_io::fs;

/// The format.
pub static FORMAT: Format = Format {
    name: "json",
    aliases: &[],
    about: "Unity trees: the objects of the layer scatter as JSON for JsonUtility, at shares of the terrain's width, height range and length",
    options: &[RANGE],
    channels: 1,
    features: true,
    memory: |_, _| 0,
    write,
};

/// A position or a size: east, up and north.
#[derive(Debug, Serialize)]
struct Vector3 {
    x: f32,
    y: f32,
    z: f32,
}

/// The fields of a Unity `TreeInstance`, without its colors.
#[derive(Debug, Serialize)]
#[serde(rename_all = "camelCase")]
struct Tree {
    prototype_index: usize,
    position: Vector3,
    width_scale: f32,
    height_scale: f32,
    rotation: f32,
}

fn write(source: &mut LayerSource, options: &Options, files: &mut Files) -> io::Result<String> {
    if !matches!(source.vectors(), [layer] if layer.name == LAYER.name) {
        return refuse(format!(
            "a .json file holds objects: use --layer {}; GeoJSON has the extension .geojson",
            LAYER.name
        ));
    }
    // The sidecar of heights is also JSON written by Orogen, which could be replaced by mistake.
    if let Some((path, described)) = files.path().and_then(|path| Some((path, described(path)?)))
        && !files.replaces_all()
    {
        let stem = path.file_stem().unwrap_or_default().to_string_lossy();
        return refuse(format!(
            "{} describes {described}; name another file, such as {stem}_trees.json",
            path.display()
        ));
    }
    let (window, objects) = (*source.window(), within(source)?);
    if window.width < 2 || window.height < 2 {
        return refuse("a terrain has at least 2 x 2 samples; use a larger window".into());
    }
    let levels = match options.pair(RANGE.name) {
        Some([low, high]) => Levels::new(low as f32, high as f32),
        None => {
            let mut heights = LayerSource::new(source.world(), HEIGHT, window, &source.progress().part(0.0))?;
            heights.rows(|_| Ok(()))?;
            heights.levels()
        }
    };
    let kinds = Kinds::of(source);
    let size = Vector3 {
        x: length(window.width, &window) as f32,
        y: levels.high() - levels.low(),
        z: length(window.height, &window) as f32,
    };
    let head = [text(&SOFTWARE)?, text(&size)?, text(&levels.low())?, text(&kinds.names)?];
    files.write(|out| {
        let [made_by, size, low, prototypes] = &head;
        write!(
            out,
            "{{\"made_by\":{made_by},\n\"size\":{size},\n\"low\":{low},\n\"prototypes\":{prototypes},\n\"trees\":["
        )?;
        for (k, object) in objects.iter().enumerate() {
            let tree = tree(object, kinds.of_entry[object.entry], &window, &levels);
            write!(out, "{}{}", if k > 0 { ",\n" } else { "\n" }, text(&tree)?)?;
        }
        writeln!(out, "\n]}}")
    })?;
    let numbers = kinds.names.iter().enumerate().map(|(kind, name)| {
        let found = objects.iter().filter(|object| kinds.of_entry[object.entry] == kind).count();
        format!("{} of {name} (prototype {kind})", count(found, "object"))
    });
    Ok(numbers.collect::<Vec<_>>().join(", "))
}

/// The kinds of a recipe's objects, also those without an object in the window, so that all tiles use the same numbers.
struct Kinds {
    names: Vec<String>,
    /// The kind of each entry.
    of_entry: Vec<usize>,
}

impl Kinds {
    fn of(source: &LayerSource) -> Kinds {
        let mut kinds = Kinds { names: Vec::new(), of_entry: Vec::new() };
        for entry in source.world().recipe().scatter() {
            let known = kinds.names.iter().position(|name| *name == entry.name);
            kinds.of_entry.push(known.unwrap_or_else(|| {
                kinds.names.push(entry.name.clone());
                kinds.names.len() - 1
            }));
        }
        kinds
    }
}

/// Distance in metres between the first and the last of `samples` samples.
fn length(samples: usize, window: &Window) -> f64 {
    (samples - 1) as f64 * window.cell
}

/// An object on the terrain of a window whose heights lie within `levels`.
fn tree(object: &Object, prototype_index: usize, window: &Window, levels: &Levels) -> Tree {
    let [east, south] = object.position;
    let [low, high] = [levels.low(), levels.high()].map(f64::from);
    let range = if high > low { high - low } else { 1.0 };
    let share = |value: f64| value.clamp(0.0, 1.0) as f32;
    let size = object.size as f32;
    Tree {
        prototype_index,
        position: Vector3 {
            x: share((east - window.east(0)) / length(window.width, window)),
            y: share((object.height - low) / range),
            z: share(1.0 - (south - window.south(0)) / length(window.height, window)),
        },
        width_scale: size,
        height_scale: size,
        // A positive turn about the vertical axis is clockwise in Unity too, because its axes are left-handed.
        rotation: object.turn.to_radians() as f32,
    }
}

/// The file that an Orogen sidecar at a path describes, if that file exists.
fn described(path: &Path) -> Option<String> {
    let file = sidecar::belongs_to(path)?;
    fs::is_present(&path.with_file_name(&file)).then_some(file)
}

fn text(value: &impl Serialize) -> io::Result<String> {
    serde_json::to_string(value).map_err(io::Error::other)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_tree_is_placed_by_shares_from_the_south_west() {
        let window = Window::new(33, 33, 10.0).at(4, 6);
        let object = Object { entry: 0, position: [120.0, 300.0], height: 50.0, size: 1.5, turn: 90.0 };
        let tree = tree(&object, 2, &window, &Levels::new(-50.0, 150.0));
        let expect = "{\"prototypeIndex\":2,\"position\":{\"x\":0.25,\"y\":0.5,\"z\":0.25},\"widthScale\":1.5,\"heightScale\":1.5,\
                      \"rotation\":1.5707964}";
        assert_eq!(text(&tree).unwrap(), expect);
    }
}
