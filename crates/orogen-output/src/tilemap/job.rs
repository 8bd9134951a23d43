//! From a world to a tilemap.

use std::path::Path;

use orogen_engine::recipe::class::document::CLASS;
use orogen_engine::{Recipe, World};
use orogen_grid::analysis::finite::FiniteCount;
use orogen_grid::autotile::clean::HALO;
use orogen_grid::autotile::drawable::{Drawable, Gap};
use orogen_grid::autotile::mask::Layout;
use orogen_grid::error::Result;
use orogen_grid::grid::Window;
use orogen_grid::progress::Progress;
use orogen_io::records::{MEMORY as RECORDS, Records};

use super::class_rows::ClassRows;
use super::drawing::{Drawing, IN_MEMORY, Stores};
use super::map_objects::{MapObject, has_objects};
use super::named::number;
use super::standard::classify;
use super::tileset::Tileset;

/// How many cells are made at once. Maps are the same for any numbers.
#[derive(Debug, Clone, Copy)]
pub(super) struct AtOnce {
    /// Approximate number of cells that are cleaned at once, and minimum number of rows: fewer would be cleaned several times, because of the halo.
    pub cleaned: usize,
    pub cleaned_rows: usize,
    /// Approximate number of cells that are drawn at once.
    pub drawn: usize,
}

const AT_ONCE: AtOnce = AtOnce { cleaned: 1 << 22, cleaned_rows: 256, drawn: 1 << 17 };

/// What a map is made with.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct TilemapJob {
    /// The tiles.
    pub tileset: Tileset,
    /// Whether classes are changed where the tileset has no tile.
    pub cleans: bool,
    /// Whether maps of Tiled are infinite: chunks of tiles at the positions of the world's cells.
    pub is_infinite: bool,
    pub(super) at_once: AtOnce,
}

/// A layer of tiles.
#[derive(Debug)]
#[non_exhaustive]
pub struct TileLayer {
    /// The tiles, row-major, as the files of a map have them: 0 where there is none, and otherwise 1 more than the [number](super::tileset::number) of the tile.
    pub tiles: Records<u32>,
    /// Whether it has any tile.
    pub is_used: bool,
    /// Whether any tile is turned by a quarter.
    pub is_turned: bool,
}

/// A map of tiles.
#[derive(Debug)]
#[non_exhaustive]
pub struct Tilemap {
    /// The tiles.
    pub tileset: Tileset,
    /// The cells of the map: a class each. Their size is in metres.
    pub window: Window,
    /// The class of each cell, row-major; of a corner layout the class at each corner of a tile.
    pub classes: Records<u8>,
    /// How many cells have each class of the tileset.
    pub class_counts: Vec<u64>,
    /// Tiles per row.
    pub width: usize,
    /// Rows of tiles.
    pub height: usize,
    /// A layer for each class, bottom to top, or one for all of a wang tileset.
    pub layers: Vec<TileLayer>,
    /// Places without a tile before the clean-up.
    pub gaps_before: u64,
    /// Places without a tile in the map.
    pub gap_count: u64,
    /// The first of them, up to 1000.
    pub gaps: Vec<Gap>,
    /// Cells whose class the clean-up changed.
    pub changed: u64,
    /// How many of the classes it was made from are numbers. Cells without a class have the first one.
    pub finite: FiniteCount,
    /// The names of the kinds of scattered objects.
    pub kinds: Vec<String>,
    /// The scattered objects on the map, from back to front.
    pub objects: Records<MapObject>,
    /// Whether maps of Tiled are infinite.
    pub is_infinite: bool,
    /// The seed by which variants of tiles are chosen: that of the world.
    pub seed: u64,
}

impl Tilemap {
    /// Cells per row of [`Tilemap::classes`].
    #[must_use]
    pub fn class_columns(&self) -> usize {
        self.window.width + usize::from(self.tileset.layout == Layout::Corner)
    }
}

impl TilemapJob {
    /// A map with these tiles, cleaned.
    #[must_use]
    pub fn new(tileset: Tileset) -> TilemapJob {
        TilemapJob { tileset, cleans: true, is_infinite: false, at_once: AT_ONCE }
    }

    /// Sets whether classes are changed where the tileset has no tile.
    #[must_use]
    pub fn with_cleans(self, cleans: bool) -> TilemapJob {
        TilemapJob { cleans, ..self }
    }

    /// Sets whether maps of Tiled are infinite.
    #[must_use]
    pub fn with_infinite(self, is_infinite: bool) -> TilemapJob {
        TilemapJob { is_infinite, ..self }
    }

    /// Adds what the map needs to a recipe: its own [classes](orogen_engine::recipe::class) with the numbers of the tileset's terrains of their names, or the
    /// [standard ones](super::standard), if it has none and no output `class`. `cell` is the map's cell in metres, at which shares of classes are exact.
    ///
    /// # Errors
    /// If the recipe has neither classes nor heights, or if the tileset has no terrain with the name of a class.
    pub fn prepare(&self, recipe: &mut Recipe, cell: f64) -> Result<()> {
        let names: Vec<&str> = self.tileset.terrains.iter().map(|terrain| terrain.name.as_str()).collect();
        number(recipe, &names, &format!("terrain of the tileset `{}`", self.tileset.name), cell)?;
        classify(recipe, cell)
    }

    /// The memory for streaming a map of this window beside that of the engine, in bytes.
    #[must_use]
    pub fn memory(&self, window: &Window) -> u64 {
        let is_cleaned = self.is_cleaned(&self.tileset.drawable());
        let around = window.grown(1 + cleaning_halo(is_cleaned));
        let (width, layers) = (around.width as u64, self.tileset.layer_names().len() as u64);
        let rows = |at_once: usize| (at_once.min(window.height + 1)) as u64;
        let cleaned = (rows(self.cleaned_rows(window, is_cleaned)) + 2 * cleaning_halo(is_cleaned) as u64 + 4) * width;
        // Classes that are held, before and after the clean-up, and copies for drawing; of a drawn cell two numbers in each layer.
        let drawn = rows(self.drawn_rows(window)) * width * (8 * layers + 4);
        let stores = (layers + 2) * (RECORDS + IN_MEMORY as u64);
        3 * cleaned + ClassRows::memory(window) + drawn + stores
    }

    /// Whether the clean-up can change anything.
    fn is_cleaned(&self, drawable: &Drawable) -> bool {
        self.cleans && !drawable.is_complete()
    }

    /// Rows that are cleaned at once, if any are.
    fn cleaned_rows(&self, window: &Window, is_cleaned: bool) -> usize {
        match is_cleaned {
            true => (self.at_once.cleaned / window.width.max(1)).max(self.at_once.cleaned_rows),
            false => self.drawn_rows(window),
        }
    }

    /// Rows of tiles that are drawn at once.
    pub(super) fn drawn_rows(&self, window: &Window) -> usize {
        (self.at_once.drawn / window.width.max(1)).max(1)
    }

    /// Tiles per row, and rows of tiles, of the map of a window.
    pub(super) fn sides(&self, window: &Window) -> [usize; 2] {
        let more = usize::from(self.tileset.layout == Layout::Dual);
        [window.width + more, window.height + more]
    }

    /// Makes the map of the cells of a window in memory. `world` is of a [prepared](TilemapJob::prepare) recipe.
    ///
    /// Any part of a map has the same tiles as the whole.
    ///
    /// # Errors
    /// If the window is not in the world, if a class is none of the tileset's, or if `progress` is cancelled.
    pub fn make(&self, world: &World, window: &Window, progress: &Progress) -> Result<Tilemap> {
        self.draw(world, window, None, progress)
    }

    /// Makes a map as [`TilemapJob::make`] does, in [bounded memory](TilemapJob::memory): tiles, classes and objects are packed in temporary files beside `path`, if
    /// they are many.
    ///
    /// # Errors
    /// Also if memory does not suffice, or if the disk is full or fails.
    pub fn stream(&self, world: &World, window: &Window, path: &Path, progress: &Progress) -> Result<Tilemap> {
        let _held = world.budget().reserve(self.memory(window))?;
        self.draw(world, window, Some(path), progress)
    }

    fn draw(&self, world: &World, window: &Window, path: Option<&Path>, progress: &Progress) -> Result<Tilemap> {
        world.check(window)?;
        let stores = Stores { path };
        let mut drawing = Drawing::new(self, window, world.recipe().world.seed, &stores);
        let is_cleaned = self.is_cleaned(&drawing.drawable);
        let halo = cleaning_halo(is_cleaned);
        // Tiles see one cell around them.
        let around = world.surroundings(window, 1 + halo);
        let some = Window { height: around.height.min(AT_ONCE.cleaned_rows), ..around };
        let work = world.work(&world.plan(&[CLASS], &some)?)?;
        let cells = window.len() as f64;
        let [computing, cleaning, placing] = progress.parts([
            work * around.height as f64 / some.height.max(1) as f64,
            cells * if is_cleaned { 40.0 } else { 20.0 },
            cells * if has_objects(world, window.cell) { 20.0 } else { 1.0 },
        ]);
        let mut rows = ClassRows::new(world, &self.tileset, &around, &computing)?;
        let [width, height] = self.sides(window);
        cleaning.expect(height as f64);
        let at_once = self.cleaned_rows(window, is_cleaned);
        for top in (0..height).step_by(at_once) {
            let bottom = (top + at_once).min(height);
            let [from, to] = self.seen(top, bottom).map(|row| row + window.y);
            let before = rows.rows(from - halo as i64, to + halo as i64)?;
            let part = cleaning.part((bottom - top) as f64);
            world.install(|| drawing.add(before, is_cleaned, [top, bottom], &part))?;
        }
        let finite = rows.finite();
        drop(rows);
        let (kinds, objects) = self.objects(world, window, &stores, &placing)?;
        let drawn = drawing.finish()?;
        Ok(Tilemap {
            tileset: self.tileset.clone(),
            window: *window,
            width,
            height,
            finite,
            kinds,
            objects,
            is_infinite: self.is_infinite,
            seed: world.recipe().world.seed,
            classes: drawn.classes,
            class_counts: drawn.class_counts,
            layers: drawn.layers,
            gaps_before: drawn.gaps_before,
            gap_count: drawn.gap_count,
            gaps: drawn.gaps,
            changed: drawn.changed,
        })
    }

    /// The rows of cells that rows of tiles see, from the first to, but not including, the last.
    pub(super) fn seen(&self, top: usize, bottom: usize) -> [i64; 2] {
        let [top, bottom] = [top, bottom].map(|row| row as i64);
        match self.tileset.layout {
            Layout::Corner => [top, bottom + 1],
            Layout::Dual => [top - 1, bottom],
            _ => [top - 1, bottom + 1],
        }
    }
}

/// How far the clean-up looks.
fn cleaning_halo(is_cleaned: bool) -> usize {
    if is_cleaned { HALO } else { 0 }
}
