//! A law during its test.

use super::law::{Law, Verdict, Violation};
use super::recipes::{SIDES, full};
use crate::recipe::document::Recipe;
use crate::world::World;
use crate::world::session::Options;
use orogen_grid::error::Result;
use orogen_grid::grid::{Grid, Window};
use orogen_grid::progress::Progress;
use orogen_grid::random::Random;
use orogen_ops::declare::MARGIN;
use orogen_ops::value::Value;

/// A law during its test.
pub(super) struct Case {
    pub op: String,
    pub law: Law,
    pub window: Option<Window>,
}

impl Case {
    pub fn in_window(&self, window: Window) -> Case {
        Case { op: self.op.clone(), law: self.law, window: Some(window) }
    }

    pub fn violation(&self, message: String) -> Violation {
        Violation { op: self.op.clone(), law: self.law, window: self.window, message }
    }

    pub fn breaks<T>(&self, message: String) -> std::result::Result<T, Violation> {
        Err(self.violation(message))
    }

    pub fn of<T>(&self, result: Result<T>) -> std::result::Result<T, Violation> {
        result.map_err(|error| self.violation(error.to_string()))
    }

    pub fn open(&self, recipe: &Recipe, threads: usize) -> std::result::Result<World, Violation> {
        self.of(World::with_options(recipe.clone(), Options { threads: Some(threads), ..Options::default() }))
    }

    /// Sets the margin of the op's nodes.
    pub fn set_margin(&self, recipe: &mut Recipe, metres: f64) -> Verdict {
        let mut refused = None;
        recipe.change(|node| {
            let param = node.spec().params.iter().position(|param| param.name == MARGIN);
            if let (true, Some(param)) = (node.spec().op == self.op, param) {
                refused = node.set_param(param, &Value::Number(metres)).err();
            }
        });
        refused.map_or(Ok(()), |message| self.breaks(message))
    }

    /// All layers, from a new world.
    pub fn layers(&self, recipe: &Recipe, window: &Window) -> std::result::Result<Vec<Grid>, Violation> {
        let layers: Vec<&str> = recipe.outputs().collect();
        self.of(self.open(recipe, 2)?.grids(&layers, window, &Progress::none()))
    }

    /// Whether a tile has the bits of the part of the whole that it covers.
    pub fn same(&self, what: &str, whole: &Grid, tile: &Grid) -> Verdict {
        let Some(crop) = whole.crop(tile.window()) else {
            return self.breaks(format!("{what}: {:?} is not part of {:?}", tile.window(), whole.window()));
        };
        let differs = |(a, b): (&f32, &f32)| a.to_bits() != b.to_bits();
        match crop.data().iter().zip(tile.data()).position(differs) {
            Some(k) => {
                let (i, j) = (k % tile.width(), k / tile.width());
                self.breaks(format!("{what}: {} and {} at ({i}, {j})", crop[(i, j)], tile[(i, j)]))
            }
            None => Ok(()),
        }
    }
}

/// Tile == crop for every layer of one recipe: compares the whole with tiles of several sizes and offsets, for several
/// numbers of threads, with new and with filled stores.
pub(super) fn tiles_equal_crop(case: &Case, what: &str, recipe: &Recipe, cell: f64) -> Verdict {
    let whole = full(cell);
    let layers: Vec<&str> = recipe.outputs().collect();
    let wholes = case.in_window(whole).layers(recipe, &whole)?;
    let warm = case.open(recipe, 1)?;
    let mut random = Random::of_state(case.op.len() as u64);
    let mut tiles = vec![(Window::new(31, 17, cell).at(13, 44), true), (whole, true), (whole, false)];
    for size in [1usize, 2, 7, 33, 64] {
        for _ in 0..2 {
            let [x, y] = SIDES.map(|side| (random.draw() % ((side - size) as u64 + 1)) as i64);
            tiles.push((Window::new(size, size, cell).at(x, y), false));
        }
    }
    for (tile, fresh) in tiles {
        let case = case.in_window(tile);
        let made = match fresh {
            true => case.layers(recipe, &tile)?,
            false => case.of(warm.grids(&layers, &tile, &Progress::none()))?,
        };
        for ((layer, whole), made) in layers.iter().zip(&wholes).zip(&made) {
            case.same(&format!("{what}layer `{layer}`, the whole and the tile"), whole, made)?;
        }
    }
    // A point on the lattice is the sample there.
    let [i, j] = SIDES.map(|side| (random.draw() % side as u64) as usize);
    let case = case.in_window(Window::new(1, 1, cell).at(i as i64, j as i64));
    for (layer, grid) in layers.iter().zip(&wholes) {
        let points = case.of(warm.points(layer, &[whole.east(i)], &[whole.south(j)]))?;
        if points.first().is_none_or(|point| point.to_bits() != grid[(i, j)].to_bits()) {
            return case
                .breaks(format!("{what}layer `{layer}`: {} in the whole, {points:?} at that point", grid[(i, j)]));
        }
    }
    Ok(())
}
