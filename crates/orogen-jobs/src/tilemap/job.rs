//! Making a tilemap from a world.

use std::path::{Path, PathBuf};

use orogen_engine::recipe::class::named::number;
use orogen_engine::recipe::class::standard::classify;
use orogen_engine::recipe::outputs::CLASS;
use orogen_engine::view::View;
use orogen_engine::{Recipe, World};
use orogen_grid::autotile::clean::HALO;
use orogen_grid::autotile::drawable::Drawable;
use orogen_grid::error::Result;
use orogen_grid::grid::Window;
use orogen_grid::progress::Progress;
use orogen_io::records::MEMORY as RECORDS;

use super::class_rows::ClassRows;
use super::drawing::{Drawing, IN_MEMORY, Stores, seen, sides};
use super::map::Tilemap;
use super::map_objects::{has_objects, objects};
use super::tileset::Tileset;

/// Number of cells that are processed at once. It does not affect the map.
#[derive(Debug, Clone, Copy)]
pub(super) struct AtOnce {
    /// Approximate number of cells that are cleaned at once, and minimum number of rows. With fewer rows, most would be
    /// cleaned several times because of the halo.
    pub cleaned: usize,
    pub cleaned_rows: usize,
    /// Approximate number of cells that are drawn at once.
    pub drawn: usize,
}

const AT_ONCE: AtOnce = AtOnce { cleaned: 1 << 22, cleaned_rows: 256, drawn: 1 << 17 };

/// The settings of a tilemap.
#[derive(Debug, Clone)]
#[non_exhaustive]
#[must_use]
pub struct TilemapJob {
    /// The tileset.
    pub tileset: Tileset,
    /// Whether classes are changed where the tileset has no tile.
    pub cleans: bool,
    /// Whether Tiled maps are infinite: chunks of tiles at the positions of the world's cells.
    pub is_infinite: bool,
    /// The files that the tileset was read from.
    pub files: Vec<PathBuf>,
    pub(super) at_once: AtOnce,
}

impl TilemapJob {
    /// Creates a job that draws maps with this tileset and cleans them.
    pub fn new(tileset: Tileset) -> TilemapJob {
        TilemapJob { tileset, cleans: true, is_infinite: false, files: Vec::new(), at_once: AT_ONCE }
    }

    /// Sets whether classes are changed where the tileset has no tile.
    pub fn with_cleans(self, cleans: bool) -> TilemapJob {
        TilemapJob { cleans, ..self }
    }

    /// Sets whether Tiled maps are infinite.
    pub fn with_infinite(self, is_infinite: bool) -> TilemapJob {
        TilemapJob { is_infinite, ..self }
    }

    /// Cells along the longer side of a map, unless a size is chosen.
    #[doc(hidden)]
    pub const SIDE: usize = 128;

    /// The samples of a world that a map has: 128 along the longer side, if no part, cell or size is chosen.
    #[must_use]
    pub fn view(view: &View) -> View {
        view.sized(TilemapJob::SIDE)
    }

    /// Adds what the map needs to a recipe. [Classes](orogen_engine::recipe::class) that the recipe has get the numbers
    /// of the tileset's terrains with the same names. If it has no classes and no output `class`, the [standard
    /// classes](orogen_engine::recipe::class::standard) are added. `cell` is the map's cell in metres; the shares of
    /// classes are exact at this cell.
    ///
    /// # Errors
    /// If the recipe has neither classes nor heights, or if the tileset has no terrain with the name of a class.
    pub fn prepare(&self, recipe: &mut Recipe, cell: f64) -> Result<()> {
        let names: Vec<&str> = self.tileset.terrains.iter().map(|terrain| terrain.name.as_str()).collect();
        number(recipe, &names, &format!("terrain of the tileset `{}`", self.tileset.name), cell)?;
        classify(recipe, cell)
    }

    /// Memory for streaming a map of this window in addition to the memory of the engine, in bytes.
    #[must_use]
    pub fn memory(&self, window: &Window) -> u64 {
        let is_cleaned = self.is_cleaned(&self.tileset.drawable());
        let around = window.grown(1 + cleaning_halo(is_cleaned));
        let (width, layers) = (around.width as u64, self.tileset.layer_names().len() as u64);
        let rows = |at_once: usize| (at_once.min(window.height + 1)) as u64;
        let cleaned = (rows(self.cleaned_rows(window, is_cleaned)) + 2 * cleaning_halo(is_cleaned) as u64 + 4) * width;
        // Classes in memory before and after the clean-up, and copies for drawing; for each drawn cell two numbers per
        // layer.
        let drawn = rows(self.drawn_rows(window)) * width * (8 * layers + 4);
        let stores = (layers + 2) * (RECORDS + IN_MEMORY as u64);
        3 * cleaned + ClassRows::memory(window) + drawn + stores
    }

    /// Whether the clean-up can change anything.
    fn is_cleaned(&self, drawable: &Drawable) -> bool {
        self.cleans && !drawable.is_complete()
    }

    /// Number of rows that are cleaned at once, if the map is cleaned.
    fn cleaned_rows(&self, window: &Window, is_cleaned: bool) -> usize {
        match is_cleaned {
            true => (self.at_once.cleaned / window.width.max(1)).max(self.at_once.cleaned_rows),
            false => self.drawn_rows(window),
        }
    }

    /// Number of rows of tiles that are drawn at once.
    fn drawn_rows(&self, window: &Window) -> usize {
        (self.at_once.drawn / window.width.max(1)).max(1)
    }

    /// Makes the map of the cells of a window in memory. `world` must be made of a [prepared](TilemapJob::prepare)
    /// recipe.
    ///
    /// Any part of a map has the same tiles as the whole map.
    ///
    /// ```
    /// use orogen_engine::{Progress, Window, World, presets};
    /// use orogen_grid::autotile::mask::Layout;
    /// use orogen_jobs::tilemap::{art::set::SETS, job::TilemapJob};
    ///
    /// let job = TilemapJob::new(SETS[0].draw(Layout::Blob));
    /// let mut recipe = presets::find("hills").ok_or("no such preset")?.recipe()?;
    /// job.prepare(&mut recipe, 20.0)?;
    /// let map = job.make(&World::open(recipe)?, &Window::new(24, 16, 20.0), &Progress::none())?;
    /// let water = map.layers[0].tiles.in_memory().ok_or("it is in memory")?;
    /// assert_eq!((water.len(), map.class_counts.iter().sum::<u64>(), map.gap_count), (24 * 16, 24 * 16, 0));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// If the window is not in the world, if a class is not a class of the tileset, or if `progress` is cancelled.
    pub fn make(&self, world: &World, window: &Window, progress: &Progress) -> Result<Tilemap> {
        self.draw(world, window, None, progress)
    }

    /// Makes a map like [`TilemapJob::make`], in [bounded memory](TilemapJob::memory): large amounts of tiles, classes
    /// and objects are packed into temporary files next to `path`.
    ///
    /// # Errors
    /// The errors of [`TilemapJob::make`]; if memory does not suffice; or if the disk is full or fails.
    pub fn stream(&self, world: &World, window: &Window, path: &Path, progress: &Progress) -> Result<Tilemap> {
        self.afford(world, window, 0)?;
        let _held = world.budget().reserve(self.memory(window))?;
        self.draw(world, window, Some(path), progress)
    }

    /// Checks that a map, the classes of its cells while they are computed, and `beside` further bytes fit into memory
    /// together.
    ///
    /// # Errors
    /// If they do not; the message states the total that is needed.
    pub(super) fn afford(&self, world: &World, window: &Window, beside: u64) -> Result<()> {
        world.bands(&[CLASS], window, self.memory(window).saturating_add(beside), &Progress::none()).map(drop)
    }

    fn draw(&self, world: &World, window: &Window, path: Option<&Path>, progress: &Progress) -> Result<Tilemap> {
        world.check(window)?;
        let stores = Stores { path };
        let mut drawing =
            Drawing::new(&self.tileset, window, world.recipe().world.seed, self.drawn_rows(window), &stores);
        let is_cleaned = self.is_cleaned(&drawing.drawable);
        let halo = cleaning_halo(is_cleaned);
        // Tiles depend on one cell around them.
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
        let layout = self.tileset.layout;
        let [width, height] = sides(layout, window);
        cleaning.expect(height as f64);
        let at_once = self.cleaned_rows(window, is_cleaned);
        for top in (0..height).step_by(at_once) {
            let bottom = (top + at_once).min(height);
            let [from, to] = seen(layout, [top, bottom]).map(|row| row + window.y);
            let before = rows.rows(from - halo as i64, to + halo as i64)?;
            let part = cleaning.part((bottom - top) as f64);
            world.install(|| drawing.add(before, is_cleaned, [top, bottom], &part))?;
        }
        let finite = rows.finite();
        drop(rows);
        let (kinds, objects) = objects(world, layout, window, &stores, &placing)?;
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
}

/// The distance in cells that the clean-up depends on.
fn cleaning_halo(is_cleaned: bool) -> usize {
    if is_cleaned { HALO } else { 0 }
}
