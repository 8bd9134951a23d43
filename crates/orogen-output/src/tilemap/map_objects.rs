//! Scattered objects on a map of tiles.

use std::io;

use orogen_engine::World;
use orogen_engine::recipe::scatter::document::Scatter;
use orogen_engine::world::HEIGHT;
use orogen_grid::autotile::mask::Layout;
use orogen_grid::error::Result;
use orogen_grid::grid::Window;
use orogen_grid::progress::Progress;
use orogen_io::records::{Record, Records};

use super::drawing::Stores;
use super::job::{Tilemap, TilemapJob};

/// The least spacing, in cells, of scattered objects that are on a map: a cell holds few of them.
const MIN_SPACING: f64 = 0.5;

/// Approximate number of cells whose objects are found at once.
const AT_ONCE: usize = 1 << 21;

/// A scattered object on a map.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MapObject {
    /// Its kind: an index of [`Tilemap::kinds`](super::job::Tilemap::kinds).
    pub kind: usize,
    /// Tiles from the left and upper side of the map.
    pub position: [f64; 2],
    /// Scale factor.
    pub size: f64,
    /// Turn in degrees, clockwise.
    pub turn: f64,
}

impl Record for MapObject {
    const BYTES: usize = 40;

    fn put(self, bytes: &mut [u8]) {
        let [x, y] = self.position;
        let numbers = [self.kind as u64, x.to_bits(), y.to_bits(), self.size.to_bits(), self.turn.to_bits()];
        bytes.chunks_exact_mut(8).zip(numbers).for_each(|(bytes, number)| bytes.copy_from_slice(&number.to_le_bytes()));
    }

    fn get(bytes: &[u8]) -> MapObject {
        let number = |at: usize| {
            let bytes = bytes.get(8 * at..8 * at + 8).and_then(|bytes| bytes.try_into().ok());
            bytes.map(u64::from_le_bytes).unwrap_or_default()
        };
        let [x, y, size, turn] = [1, 2, 3, 4].map(|at| f64::from_bits(number(at)));
        MapObject { kind: number(0) as usize, position: [x, y], size, turn }
    }
}

fn is_drawn(entry: &Scatter, cell: f64) -> bool {
    entry.spacing >= MIN_SPACING * cell
}

/// Whether maps of a world with this cell have objects.
pub(super) fn has_objects(world: &World, cell: f64) -> bool {
    let recipe = world.recipe();
    recipe.scatter().iter().any(|entry| is_drawn(entry, cell)) && recipe.outputs().any(|name| name == HEIGHT)
}

impl TilemapJob {
    /// The kinds of the recipe's scattered objects, and those on the map, ordered from back to front.
    pub(super) fn objects(
        &self,
        world: &World,
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
            let [width, height] = self.sides(window);
            let rows = (AT_ONCE / width.max(1)).max(1);
            progress.expect(height as f64);
            for top in (0..height).step_by(rows) {
                let bottom = (top + rows).min(height);
                let part = progress.part((bottom - top) as f64);
                let objects = self.objects_of_rows(world, window, [top, bottom], &kinds, &part)?;
                recorder.push(&objects).map_err(|cause| stores.failed(&cause))?;
            }
        }
        progress.finish();
        Ok((kinds, stores.finished(recorder)?))
    }

    /// The objects on some rows of tiles, ordered from back to front.
    fn objects_of_rows(
        &self,
        world: &World,
        window: &Window,
        [top, bottom]: [usize; 2],
        kinds: &[String],
        progress: &Progress,
    ) -> Result<Vec<MapObject>> {
        let scatter = world.recipe().scatter();
        // Half a tile from the first sample, which is the middle of a cell, to the side of its tile.
        let before = match self.tileset.layout {
            Layout::Corner => 0.0,
            Layout::Dual => 1.0,
            _ => 0.5,
        };
        let origin = [window.x, window.y].map(|at| at as f64 - before);
        let columns = 0.0..self.sides(window)[0] as f64;
        // The world has objects up to a cell beyond its last sample, and a cell before the first of this window.
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
}

impl Tilemap {
    /// Gives each object with its number, from 0.
    pub(super) fn each_object(&self, mut of_object: impl FnMut(u64, MapObject) -> io::Result<()>) -> io::Result<()> {
        let (mut reader, mut objects, mut nth) = (self.objects.reader(), Vec::new(), 0);
        loop {
            reader.read(1024, &mut objects)?;
            if objects.is_empty() {
                return Ok(());
            }
            for object in objects.drain(..) {
                of_object(nth, object)?;
                nth += 1;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_object_is_the_one_of_its_bytes() {
        let object = MapObject { kind: 3, position: [0.1, -7.5], size: 1.25, turn: 359.0 };
        let mut bytes = [0; MapObject::BYTES];
        object.put(&mut bytes);
        assert_eq!(MapObject::get(&bytes), object);
    }
}
