//! Scattered objects for meshes: `--objects`.

use std::io;

use super::format::refuse;
use super::layer_source::LayerSource;
use super::mesh::Prepared;
use crate::options::{OptionSpec, Options};
use orogen_engine::objects::Object;
use orogen_engine::world::HEIGHT;
use orogen_grid::grid::Window;
use orogen_grid::triangles;
use orogen_grid::words::count;
use orogen_output::mesh::objects::{Instance, ObjectMesh};

/// `--objects`.
pub const OBJECTS: OptionSpec = OptionSpec::switch("objects").with_about(
    "Add the objects of the recipe's scatter: a node for each kind with a placeholder mesh and an instance for \
             each object",
);

/// Memory of an object and its instance, in bytes.
const OBJECT_MEMORY: u64 = 160;

/// Width of a placeholder, as a share of the spacing of its kind.
const WIDTH: f64 = 0.4;

/// Linear red, green and blue of the kinds, used in turn.
const COLORS: [[f32; 3]; 6] = [
    [0.03, 0.11, 0.03],
    [0.22, 0.20, 0.18],
    [0.35, 0.10, 0.05],
    [0.18, 0.22, 0.05],
    [0.30, 0.22, 0.10],
    [0.08, 0.16, 0.20],
];

/// The objects on a mesh, if requested, each at the height of the mesh.
///
/// Fails if the source fails, or the mesh is not made from heights.
pub fn of(source: &LayerSource, mesh: &Prepared, options: &Options) -> io::Result<Vec<ObjectMesh>> {
    if !options.has(OBJECTS.name) {
        return Ok(Vec::new());
    }
    if source.layer() != HEIGHT {
        return refuse(format!("--objects applies to the layer `{HEIGHT}`, not to `{}`", source.layer()));
    }
    let window = *source.window();
    kinds(source, |object| {
        let [column, row] = object.position.map(|at| at / window.cell);
        let (i, j) = (column.floor() as i64 - window.x, row.floor() as i64 - window.y);
        let corner = |i: i64, j: i64| mesh.grid.get(i as usize, j as usize).unwrap_or(f32::NAN);
        let corners = [corner(i, j), corner(i + 1, j), corner(i, j + 1), corner(i + 1, j + 1)];
        triangles::height(corners, [column - column.floor(), row - row.floor()]) as f32 * mesh.exaggeration()
    })
}

/// The objects within the samples of a source's window, omitted where `height` is not finite. Entries with the same
/// name are one kind.
///
/// Fails if the world has no objects, or memory does not suffice.
pub fn kinds(source: &LayerSource, height: impl Fn(&Object) -> f32) -> io::Result<Vec<ObjectMesh>> {
    let (world, window) = (source.world(), *source.window());
    let objects = within(source)?;
    let mut kinds: Vec<ObjectMesh> = Vec::new();
    for object in &objects {
        let height = height(object);
        let Some(entry) = world.recipe().scatter().get(object.entry).filter(|_| height.is_finite()) else { continue };
        let [east, south] = object.position;
        let position = [(east - window.east(0)) as f32, height, (south - window.south(0)) as f32];
        let instance = Instance { position, turn: object.turn, size: object.size as f32 };
        match kinds.iter_mut().find(|kind| kind.name == entry.name) {
            Some(kind) => kind.instances.push(instance),
            None => kinds.push(ObjectMesh {
                name: entry.name.clone(),
                color: COLORS[kinds.len() % COLORS.len()],
                width: (entry.spacing * WIDTH) as f32,
                instances: vec![instance],
            }),
        }
    }
    Ok(kinds)
}

/// The objects between the first and the last samples of a source's window.
///
/// Fails if the world has no objects, or memory does not suffice.
pub fn within(source: &LayerSource) -> io::Result<Vec<Object>> {
    let (world, window) = (source.world(), *source.window());
    // The cells of the mesh: meshes that share a row or a column of samples share no object.
    let cells = Window { width: window.width.saturating_sub(1), height: window.height.saturating_sub(1), ..window };
    let objects = world.objects(&cells, source.progress())?;
    world.budget().afford(objects.len() as u64 * OBJECT_MEMORY)?;
    Ok(objects)
}

/// The number of objects of each kind: ", 12 of tree, 3 of rock".
#[must_use]
pub fn words(objects: &[ObjectMesh]) -> String {
    objects.iter().map(|kind| format!(", {} of {}", count(kind.instances.len(), "object"), kind.name)).collect()
}
