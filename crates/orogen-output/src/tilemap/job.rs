//! From a world to a tilemap.

use std::path::Path;

use orogen_engine::recipe::class::document::CLASS;
use orogen_engine::{Recipe, World};
use orogen_grid::analysis::finite::FiniteCount;
use orogen_grid::autotile::choose::{NONE, layers};
use orogen_grid::autotile::classes::Classes;
use orogen_grid::autotile::clean::{HALO, clean};
use orogen_grid::autotile::drawable::Gap;
use orogen_grid::autotile::mask::Layout;
use orogen_grid::error::{Error, Result};
use orogen_grid::grid::Window;
use orogen_grid::progress::Progress;
use orogen_io::records::{MEMORY as RECORDS, Recorder, Records};
use orogen_io::spool::Spool;
use rayon::prelude::*;

use super::class_rows::ClassRows;
use super::map_objects::{MapObject, has_objects};
use super::named::number;
use super::standard::classify;
use super::tileset::{Tileset, parts};

/// Maximum number of places without a tile that a map lists.
const MAX_GAPS: usize = 1000;

/// How many cells are made at once. Maps are the same for any numbers.
#[derive(Debug, Clone, Copy)]
pub(super) struct AtOnce {
    /// Approximate number of cells that are cleaned at once, and minimum number of rows: fewer would be cleaned several times, because of the halo.
    pub cleaned: usize,
    pub cleaned_rows: usize,
    /// Approximate number of cells that are drawn at once.
    pub drawn: usize,
}

const AT_ONCE: AtOnce = AtOnce { cleaned: 1 << 22, cleaned_rows: 256, drawn: 1 << 19 };

/// Bytes of tiles or classes that stay in memory.
const IN_MEMORY: usize = 1 << 20;

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
        let around = window.grown(self.halo());
        let (width, layers) = (around.width as u64, self.tileset.layer_names().len() as u64);
        let rows = |at_once: usize| (at_once.min(window.height + 1)) as u64;
        let cleaned = (rows(self.cleaned_rows(window)) + 2 * self.halo() as u64 + 4) * width;
        // Classes that are held, before and after the clean-up, and copies for drawing; of a drawn cell two numbers in each layer.
        let drawn = rows(self.drawn_rows(window)) * width * (8 * layers + 4);
        let stores = (layers + 2) * (RECORDS + IN_MEMORY as u64);
        3 * cleaned + ClassRows::memory(window) + drawn + stores
    }

    /// How many cells around a map are computed.
    pub(super) fn halo(&self) -> usize {
        // Tiles see one cell around them.
        1 + if self.is_cleaned() { HALO } else { 0 }
    }

    /// Whether the clean-up can change anything.
    fn is_cleaned(&self) -> bool {
        self.cleans && !self.tileset.drawable().is_complete()
    }

    /// Rows that are cleaned at once.
    fn cleaned_rows(&self, window: &Window) -> usize {
        match self.is_cleaned() {
            true => (self.at_once.cleaned / window.width.max(1)).max(self.at_once.cleaned_rows),
            false => self.drawn_rows(window),
        }
    }

    /// Rows of tiles that are drawn at once.
    fn drawn_rows(&self, window: &Window) -> usize {
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
        let failed = |cause: std::io::Error| Error::file("work beside", path.unwrap_or(Path::new("")), &cause);
        let spool = || path.map(|path| Spool::beside(path).with_most(IN_MEMORY));
        world.check(window)?;
        let [width, height] = self.sides(window);
        let names = self.tileset.layer_names().len();
        let mut drawing = Drawing {
            job: self,
            window,
            seed: world.recipe().world.seed,
            classes: recorder(spool()),
            layers: (0..names).map(|_| Layer { tiles: recorder(spool()), is_used: false, is_turned: false }).collect(),
            class_counts: vec![0; self.tileset.terrains.len()],
            gaps_before: 0,
            gap_count: 0,
            gaps: Vec::new(),
            changed: 0,
        };
        let around = world.surroundings(window, self.halo());
        let some = Window { height: around.height.min(AT_ONCE.cleaned_rows), ..around };
        let work = world.work(&world.plan(&[CLASS], &some)?)?;
        let cells = window.len() as f64;
        let [computing, cleaning, placing] = progress.parts([
            work * around.height as f64 / some.height.max(1) as f64,
            cells * if self.is_cleaned() { 40.0 } else { 20.0 },
            cells * if has_objects(world, window.cell) { 20.0 } else { 1.0 },
        ]);
        let mut rows = ClassRows::new(world, &self.tileset, &around, &computing)?;
        cleaning.expect(height as f64);
        let at_once = self.cleaned_rows(window);
        for top in (0..height).step_by(at_once) {
            let bottom = (top + at_once).min(height);
            let [from, to] = self.seen(top, bottom).map(|row| row + window.y);
            let halo = (self.halo() - 1) as i64;
            let before = rows.rows(from - halo, to + halo)?;
            let part = cleaning.part((bottom - top) as f64);
            world.install(|| drawing.add(before, top, bottom, &part, &failed))?;
        }
        let finite = rows.finite();
        drop(rows);
        let (kinds, objects) = self.objects(world, window, recorder(spool()), &failed, &placing)?;
        let layers = drawing.layers.into_iter().map(|layer| {
            let tiles = layer.tiles.finish()?;
            Ok(TileLayer { tiles, is_used: layer.is_used, is_turned: layer.is_turned })
        });
        Ok(Tilemap {
            tileset: self.tileset.clone(),
            window: *window,
            classes: drawing.classes.finish().map_err(failed)?,
            class_counts: drawing.class_counts,
            width,
            height,
            layers: layers.collect::<std::io::Result<_>>().map_err(failed)?,
            gaps_before: drawing.gaps_before,
            gap_count: drawing.gap_count,
            gaps: drawing.gaps,
            changed: drawing.changed,
            finite,
            kinds,
            objects,
            is_infinite: self.is_infinite,
            seed: drawing.seed,
        })
    }

    /// The rows of cells that rows of tiles see, from the first to, but not including, the last.
    fn seen(&self, top: usize, bottom: usize) -> [i64; 2] {
        let [top, bottom] = [top, bottom].map(|row| row as i64);
        match self.tileset.layout {
            Layout::Corner => [top, bottom + 1],
            Layout::Dual => [top - 1, bottom],
            _ => [top - 1, bottom + 1],
        }
    }
}

fn recorder<T: orogen_io::records::Record>(spool: Option<Spool>) -> Recorder<T> {
    spool.map_or_else(Recorder::in_memory, Recorder::packed)
}

/// A layer that is drawn.
struct Layer {
    tiles: Recorder<u32>,
    is_used: bool,
    is_turned: bool,
}

/// A map whose rows are drawn from the first to the last.
struct Drawing<'a> {
    job: &'a TilemapJob,
    window: &'a Window,
    seed: u64,
    classes: Recorder<u8>,
    layers: Vec<Layer>,
    class_counts: Vec<u64>,
    gaps_before: u64,
    gap_count: u64,
    gaps: Vec<Gap>,
    changed: u64,
}

impl Drawing<'_> {
    /// Cleans classes, and draws the rows of tiles from `top` up to `bottom`, which see them.
    fn add(
        &mut self,
        before: Classes,
        top: usize,
        bottom: usize,
        progress: &Progress,
        failed: &dyn Fn(std::io::Error) -> Error,
    ) -> Result<()> {
        let job = self.job;
        progress.expect((bottom - top) as f64 * 2.0);
        let drawable = job.tileset.drawable();
        let choices = job.tileset.choices();
        let mut cleaned = None;
        if job.is_cleaned() {
            let mut classes = before.clone();
            clean(&mut classes, &drawable, &progress.part((bottom - top) as f64))?;
            cleaned = Some(classes);
        }
        let layout = job.tileset.layout;
        let (x, width) = match layout {
            Layout::Corner => (self.window.x, self.window.width + 1),
            _ => (self.window.x - 1, self.window.width + 2),
        };
        let [columns, height] = job.sides(self.window);
        // Of tiles of cells, those beside the map are drawn, too.
        let beside = usize::from(!layout.is_on_corners());
        let at_once = job.drawn_rows(self.window);
        for first in (top..bottom).step_by(at_once) {
            progress.check()?;
            let last = (first + at_once).min(bottom);
            let [from, to] = job.seen(first, last);
            let part = |classes: &Classes| classes.part([x, self.window.y + from], width, (to - from) as usize);
            let around = part(cleaned.as_ref().unwrap_or(&before));
            let gaps = |classes: &Classes| -> Vec<Gap> {
                let mut gaps = drawable.gaps(classes);
                let inside = beside as i64;
                gaps.iter_mut().for_each(|gap| (gap.x, gap.y) = (gap.x - inside, gap.y - inside));
                gaps.retain(|gap| (0..columns as i64).contains(&gap.x) && (0..(last - first) as i64).contains(&gap.y));
                gaps
            };
            if !drawable.is_complete() {
                let left = gaps(&around);
                self.gap_count += left.len() as u64;
                self.gaps_before += match cleaned {
                    Some(_) => gaps(&part(&before)).len() as u64,
                    None => left.len() as u64,
                };
                let room = MAX_GAPS - self.gaps.len();
                self.gaps.extend(left.into_iter().take(room).map(|gap| Gap { y: gap.y + first as i64, ..gap }));
            }
            let own_rows = first..if last == height { self.class_rows() } else { last.min(self.class_rows()) };
            for row in own_rows {
                let row = self.window.y + row as i64;
                let own = |classes: &Classes| classes.part([self.window.x, row], self.class_columns(), 1);
                let (found, now) = (own(&before), own(cleaned.as_ref().unwrap_or(&before)));
                self.changed += found.data().iter().zip(now.data()).filter(|(found, now)| found != now).count() as u64;
                for (class, count) in now.counts().into_iter().enumerate() {
                    if let Some(counted) = self.class_counts.get_mut(class) {
                        *counted += count as u64;
                    }
                }
                self.classes.push(now.data()).map_err(failed)?;
            }
            let tiles = layers(&around, &drawable, &choices, self.seed);
            let of_row = columns + 2 * beside;
            let store = |(layer, tiles): (&mut Layer, Vec<u32>)| {
                let rows = tiles.chunks(of_row).skip(beside).take(last - first);
                let own: Vec<u32> = rows.flat_map(|row| &row[beside..beside + columns]).copied().collect();
                layer.is_used |= own.iter().any(|tile| *tile != NONE);
                layer.is_turned |= own.iter().any(|tile| *tile != NONE && parts(*tile).1.diagonal);
                let own: Vec<u32> = own.into_iter().map(|tile| tile.wrapping_add(1)).collect();
                layer.tiles.push(&own)
            };
            self.layers.par_iter_mut().zip(tiles).map(store).collect::<std::io::Result<()>>().map_err(failed)?;
            progress.advance((last - first) as f64 * if cleaned.is_some() { 1.0 } else { 2.0 });
        }
        Ok(())
    }

    /// Cells per row of the classes.
    fn class_columns(&self) -> usize {
        self.window.width + usize::from(self.job.tileset.layout == Layout::Corner)
    }

    /// Rows of the classes.
    fn class_rows(&self) -> usize {
        self.window.height + usize::from(self.job.tileset.layout == Layout::Corner)
    }
}
