//! Scattered objects on a map of tiles.

use orogen_engine::World;
use orogen_engine::recipe::scatter::document::Scatter;
use orogen_engine::world::HEIGHT;
use orogen_grid::autotile::mask::Layout;
use orogen_grid::error::Result;
use orogen_grid::grid::Window;
use orogen_grid::progress::Progress;
use orogen_io::records::Records;

use super::drawing::{Stores, sides};
use super::map::MapObject;

/// Minimum spacing, in cells, of scattered objects on a map, so that a cell holds only a few.
const MIN_SPACING: f64 = 0.5;

/// Approximate number of cells whose objects are found at once.
const AT_ONCE: usize = 1 << 21;

fn is_drawn(entry: &Scatter, cell: f64) -> bool {
    entry.spacing >= MIN_SPACING * cell
}

/// Whether maps of a world with this cell have objects.
pub(super) fn has_objects(world: &World, cell: f64) -> bool {
    let recipe = world.recipe();
    recipe.scatter().iter().any(|entry| is_drawn(entry, cell)) && recipe.outputs().any(|name| name == HEIGHT)
}

/// The kinds of the recipe's scattered objects, and the objects on the map, ordered from back to front.
pub(super) fn objects(
    world: &World,
    layout: Layout,
    window: &Window,
    stores: &Stores,
    progress: &Progress,
) -> Result<(Vec<String>, Records<MapObject>)> {
    let scatter = world.recipe().scatter();
    let mut kinds: Vec<String> = Vec::new();
    let mut recorder = stores.recorder();
    if has_objects(world, window.cell) {
        for entry in scatter.iter().filter(|entry| is_drawn(entry, window.cell)) {
            if !kinds.contains(&entry.name) {
                kinds.push(entry.name.clone());
            }
        }
        let [width, height] = sides(layout, window);
        let rows = (AT_ONCE / width.max(1)).max(1);
        progress.expect(height as f64);
        for top in (0..height).step_by(rows) {
            let bottom = (top + rows).min(height);
            let part = progress.part((bottom - top) as f64);
            let objects = objects_of_rows(world, layout, window, [top, bottom], &kinds, &part)?;
            recorder.push(&objects).map_err(|cause| stores.failed(&cause))?;
        }
    }
    progress.finish();
    Ok((kinds, stores.finished(recorder)?))
}

/// The objects on some rows of tiles, ordered from back to front.
fn objects_of_rows(
    world: &World,
    layout: Layout,
    window: &Window,
    [top, bottom]: [usize; 2],
    kinds: &[String],
    progress: &Progress,
) -> Result<Vec<MapObject>> {
    let scatter = world.recipe().scatter();
    // Half a tile from the first sample, which is the center of a cell, to the side of its tile.
    let before = match layout {
        Layout::Corner => 0.0,
        Layout::Dual => 1.0,
        _ => 0.5,
    };
    let origin = [window.x, window.y].map(|at| at as f64 - before);
    let columns = 0.0..sides(layout, window)[0] as f64;
    // The world has objects up to one cell beyond its last sample, and one cell before the first sample of this window.
    let rows = Window { y: window.y + top as i64, height: bottom - top, ..*window };
    let around = world.surroundings(&rows, 1);
    let found = world.objects(&around, progress)?;
    let placed = found.iter().filter_map(|object| {
        let [x, y] = object.position;
        let position = [x / window.cell - origin[0], y / window.cell - origin[1]];
        let is_inside = columns.contains(&position[0]) && (top as f64..bottom as f64).contains(&position[1]);
        let entry = &scatter[object.entry];
        let kind = kinds.iter().position(|kind| *kind == entry.name)?;
        (is_inside && is_drawn(entry, window.cell)).then_some(MapObject {
            kind,
            position,
            size: object.size,
            turn: object.turn,
        })
    });
    let mut objects: Vec<MapObject> = placed.collect();
    objects.sort_by(|a, b| a.position[1].total_cmp(&b.position[1]).then(a.position[0].total_cmp(&b.position[0])));
    Ok(objects)
}
