//! From a world to a tilemap.

use orogen_engine::recipe::class::document::CLASS;
use orogen_engine::recipe::scatter::document::Scatter;
use orogen_engine::world::HEIGHT;
use orogen_engine::{Recipe, World};
use orogen_grid::analysis::finite::FiniteCount;
use orogen_grid::autotile::choose::layers;
use orogen_grid::autotile::classes::Classes;
use orogen_grid::autotile::clean::{HALO, clean};
use orogen_grid::autotile::drawable::Gap;
use orogen_grid::autotile::mask::Layout;
use orogen_grid::error::{Error, ErrorKind, Result};
use orogen_grid::grid::{Grid, Window};
use orogen_grid::progress::Progress;

use super::named::number;
use super::standard::classify;
use super::tileset::Tileset;

/// Memory for each cell of a map beside the numbers of its tiles, in bytes: its class before and after the clean-up, each with what is around the map, and the
/// layer that is cut or written.
const CELL_BYTES: u64 = 4 + 4;

/// How far a class may be from a whole number, because classes of a cell between two samples would be no class.
const WHOLE: f32 = 1e-3;

/// The least spacing, in cells, of scattered objects that are on a map: a cell holds few of them.
const MIN_SPACING: f64 = 0.5;

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
}

/// A scattered object on a map.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MapObject {
    /// Its kind: an index of [`Tilemap::kinds`].
    pub kind: usize,
    /// Tiles from the left and upper side of the map.
    pub position: [f64; 2],
    /// Scale factor.
    pub size: f64,
    /// Turn in degrees, clockwise.
    pub turn: f64,
}

/// A map of tiles.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct Tilemap {
    /// The tiles.
    pub tileset: Tileset,
    /// The cells of the map: a class each. Their size is in metres.
    pub window: Window,
    /// The class of each cell; of a corner layout the class at each corner of a tile.
    pub classes: Classes,
    /// Tiles per row.
    pub width: usize,
    /// Rows of tiles.
    pub height: usize,
    /// For each class, or for all of a wang tileset, the [numbers](super::tileset::number) of the tiles of its layer, row-major, bottom to top;
    /// [`orogen_grid::autotile::choose::NONE`] where it has none.
    pub layers: Vec<Vec<u32>>,
    /// Places without a tile before the clean-up.
    pub gaps_before: usize,
    /// Places without a tile in the map.
    pub gaps: Vec<Gap>,
    /// Cells whose class the clean-up changed.
    pub changed: usize,
    /// How many of the classes it was made from are numbers. Cells without a class have the first one.
    pub finite: FiniteCount,
    /// The names of the kinds of scattered objects.
    pub kinds: Vec<String>,
    /// The scattered objects on the map.
    pub objects: Vec<MapObject>,
    /// Whether maps of Tiled are infinite.
    pub is_infinite: bool,
    /// The seed by which variants of tiles are chosen: that of the world.
    pub seed: u64,
}

impl TilemapJob {
    /// A map with these tiles, cleaned.
    #[must_use]
    pub fn new(tileset: Tileset) -> TilemapJob {
        TilemapJob { tileset, cleans: true, is_infinite: false }
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

    /// The memory of a map of this window beside that of the engine, in bytes.
    #[must_use]
    pub fn memory(&self, window: &Window) -> u64 {
        let around = window.grown(self.halo());
        around.len() as u64 * CELL_BYTES + 4 * (self.tileset.layer_names().len() * window.len()) as u64
    }

    /// How many cells around a map are computed.
    fn halo(&self) -> usize {
        let is_complete = !self.cleans || self.tileset.drawable().is_complete();
        // Tiles see one cell around them.
        1 + if is_complete { 0 } else { HALO }
    }

    /// The samples around a window, as far as they are in the world. Those beyond the sides of a bounded world have the class of the nearest in it.
    fn around(world: &World, window: &Window, halo: usize) -> Result<Window> {
        let around = window.grown(halo);
        if world.recipe().world.size.is_none() {
            return Ok(around);
        }
        let full = world.full_window(window.cell)?;
        let cut = |start: i64, length: usize, side: usize| {
            let [from, to] = [start, start + length as i64].map(|at| at.clamp(0, side as i64));
            (from, (to - from) as usize)
        };
        let ((x, width), (y, height)) =
            (cut(around.x, around.width, full.width), cut(around.y, around.height, full.height));
        Ok(Window { x, y, width, height, cell: window.cell })
    }

    /// Makes the map of the cells of a window. `world` is of a [prepared](TilemapJob::prepare) recipe.
    ///
    /// Any part of a map has the same tiles as the whole.
    ///
    /// # Errors
    /// If the window is not in the world, if a class is none of the tileset's, or if `progress` is cancelled.
    pub fn make(&self, world: &World, window: &Window, progress: &Progress) -> Result<Tilemap> {
        let plan = world.plan(&[CLASS], &TilemapJob::around(world, window, self.halo())?)?;
        let [computing, cleaning, placing] =
            progress.parts([world.work(&plan)?, 20.0 * window.len() as f64, window.len() as f64]);
        let mut grids = world.run(&plan, &computing)?;
        let Some(grid) = grids.pop() else {
            return Err(Error::new(ErrorKind::Request, "the recipe has no output `class`"));
        };
        let before = self.classes(&grid)?;
        let finite = FiniteCount::of(grid.data());
        drop(grid);
        let mut cleaned = before.clone();
        let drawable = self.tileset.drawable();
        match self.cleans {
            true => clean(&mut cleaned, &drawable, &cleaning)?,
            false => cleaning.finish(),
        }
        // The classes that the tiles of the map see, which of some layouts are more than one for a tile.
        let layout = self.tileset.layout;
        let (start, [width, height]) = match layout {
            Layout::Corner => ([window.x, window.y], [window.width + 1, window.height + 1]),
            _ => ([window.x - 1, window.y - 1], [window.width + 2, window.height + 2]),
        };
        let [before, around] = [&before, &cleaned].map(|classes| classes.part(start, width, height));
        let seed = world.recipe().world.seed;
        let mut tiles = layers(&around, &drawable, &self.tileset.choices(), seed);
        let [mut columns, mut rows] = drawable.tiles(&around);
        let gaps = |classes: &Classes| drawable.gaps(classes);
        let (mut gaps_before, mut left) = (gaps(&before), gaps(&around));
        if !layout.is_on_corners() {
            // Tiles of cells see one cell around the map.
            for layer in &mut tiles {
                let inner = (1..rows - 1).flat_map(|y| (1..columns - 1).map(move |x| y * columns + x));
                *layer = inner.map(|at| layer[at]).collect();
            }
            (columns, rows) = (columns - 2, rows - 2);
            for gaps in [&mut gaps_before, &mut left] {
                gaps.iter_mut().for_each(|gap| (gap.x, gap.y) = (gap.x - 1, gap.y - 1));
                gaps.retain(|gap| (0..columns as i64).contains(&gap.x) && (0..rows as i64).contains(&gap.y));
            }
        }
        let own = match layout {
            Layout::Corner => [window.width + 1, window.height + 1],
            _ => [window.width, window.height],
        };
        let [before, classes] = [&before, &around].map(|classes| classes.part([window.x, window.y], own[0], own[1]));
        let changed = before.data().iter().zip(classes.data()).filter(|(before, after)| before != after).count();
        let (kinds, objects) = self.objects(world, window, &placing)?;
        Ok(Tilemap {
            tileset: self.tileset.clone(),
            window: *window,
            classes,
            width: columns,
            height: rows,
            layers: tiles,
            gaps_before: gaps_before.len(),
            gaps: left,
            changed,
            finite,
            kinds,
            objects,
            is_infinite: self.is_infinite,
            seed,
        })
    }

    /// The kinds of the recipe's scattered objects, and those on the map, ordered from back to front.
    fn objects(&self, world: &World, window: &Window, progress: &Progress) -> Result<(Vec<String>, Vec<MapObject>)> {
        let scatter = world.recipe().scatter();
        let is_drawn = |entry: &Scatter| entry.spacing >= MIN_SPACING * window.cell;
        let has_heights = world.recipe().outputs().any(|name| name == HEIGHT);
        if !scatter.iter().any(is_drawn) || !has_heights {
            progress.finish();
            return Ok((Vec::new(), Vec::new()));
        }
        let mut kinds: Vec<String> = Vec::new();
        for entry in scatter.iter().filter(|entry| is_drawn(entry)) {
            if !kinds.contains(&entry.name) {
                kinds.push(entry.name.clone());
            }
        }
        // Half a tile from the first sample, which is the middle of a cell, to the side of its tile.
        let before = match self.tileset.layout {
            Layout::Corner => 0.0,
            Layout::Dual => 1.0,
            _ => 0.5,
        };
        let origin = [window.x, window.y].map(|at| at as f64 - before);
        let sides = match self.tileset.layout {
            Layout::Dual => [window.width + 1, window.height + 1],
            _ => [window.width, window.height],
        };
        // The world has objects up to a cell beyond its last sample, and half a cell before the first of this window.
        let around = TilemapJob::around(world, window, 1)?;
        let found = world.objects(&around, progress)?;
        let placed = found.iter().filter_map(|object| {
            let [x, y] = object.position;
            let position = [x / window.cell - origin[0], y / window.cell - origin[1]];
            let is_inside = position.iter().zip(sides).all(|(at, side)| (0.0..side as f64).contains(at));
            let entry = &scatter[object.entry];
            let kind = kinds.iter().position(|kind| *kind == entry.name)?;
            (is_inside && is_drawn(entry)).then_some(MapObject { kind, position, size: object.size, turn: object.turn })
        });
        let mut objects: Vec<MapObject> = placed.collect();
        objects.sort_by(|a, b| a.position[1].total_cmp(&b.position[1]).then(a.position[0].total_cmp(&b.position[0])));
        Ok((kinds, objects))
    }

    /// The classes of a layer of numbers; the first one where it has none.
    fn classes(&self, grid: &Grid) -> Result<Classes> {
        let terrains = &self.tileset.terrains;
        let mut classes = Vec::with_capacity(grid.data().len());
        for (at, value) in grid.data().iter().enumerate() {
            if value.is_nan() {
                classes.push(0);
                continue;
            }
            let class = value.round();
            if (value - class).abs() > WHOLE || !(0.0..terrains.len() as f32).contains(&class) {
                let [x, y] = [at % grid.width(), at / grid.width()];
                let names: Vec<String> =
                    terrains.iter().enumerate().map(|(n, terrain)| format!("{n} {}", terrain.name)).collect();
                return Err(Error::new(
                    ErrorKind::Request,
                    format!(
                        "the output `class` is {value} in column {}, row {}; it must be a class of the tileset `{}`: {}",
                        grid.window().x + x as i64,
                        grid.window().y + y as i64,
                        self.tileset.name,
                        names.join(", ")
                    ),
                ));
            }
            classes.push(class as u8);
        }
        Ok(Classes::new([grid.window().x, grid.window().y], grid.width(), grid.height(), classes))
    }
}
