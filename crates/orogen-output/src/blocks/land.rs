//! The columns of a part of a world, from which its blocks are computed.

use super::cover::Cover;
use super::density::{DENSITY, Offsets};
use super::levels::{Extent, Levels, MAX_BELOW, MAX_LEVEL};
use super::reach::{ABOVE, SOIL_REACH, TREE_HEIGHT};
use orogen_engine::recipe::biomes::biomes;
use orogen_engine::recipe::class::named::number;
use orogen_engine::recipe::class::standard::{NAMES, classify};
use orogen_engine::recipe::outputs::CLASS;
use orogen_engine::world::{HEIGHT, LAKES};
use orogen_engine::{Recipe, World};
use orogen_grid::analysis::finite::FiniteCount;
use orogen_grid::error::{Error, ErrorKind, Result};
use orogen_grid::grid::{Grid, Window};
use orogen_grid::progress::Progress;
use orogen_grid::words;

/// Columns around a window that its blocks depend on: trees there may have crowns that reach into the window.
pub const HALO: usize = 4;

/// Memory for each column in addition to that of the engine, in bytes: its layers and the data computed from them.
pub const COLUMN_BYTES: u64 = 32;

/// Levels above the ground that a density may fill.
pub const ROOM: i32 = 32;

/// Minimum depth of a lake in metres.
const DEPTH: f32 = 0.01;

/// How far a class may be from a whole number.
const WHOLE: f32 = 1e-3;

/// A column of blocks.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Column {
    /// Height of the ground in metres; NaN where there is none.
    pub height: f32,
    /// Altitude of the water surface in metres; negative infinity where there is none.
    pub water: f32,
    /// The uppermost blocks.
    pub cover: Cover,
}

impl Column {
    /// Gives a column of the class water at least one block of water, also where the water is shallower than a block or
    /// the surface of a river is unknown.
    fn drowned(self, cell: f64) -> Column {
        if self.cover != Cover::Bed {
            return self;
        }
        let water = if self.water == f32::NEG_INFINITY { self.height } else { self.water };
        Column { height: self.height.min(water - cell as f32), water, ..self }
    }

    /// The highest level of the ground.
    pub(super) fn ground(&self, cell: f64) -> i32 {
        Levels::of(f64::from(self.height) - 0.5 * cell, cell)
    }
}

/// The columns of a window and of the halo around it.
#[derive(Debug)]
pub struct Land {
    /// The window, with one column of blocks per sample. A block is as high as a cell is wide.
    pub window: Window,
    /// The levels of its blocks.
    pub levels: Levels,
    /// Number of finite heights in the window. Columns without a height have no blocks.
    pub finite: FiniteCount,
    pub(super) around: Window,
    pub(super) columns: Vec<Column>,
    /// The offsets of the density, if the recipe has one.
    pub(super) offsets: Option<Offsets>,
    pub(super) has_trees: bool,
    pub(super) seed: u64,
    /// The sea level in metres, multiplied by the exaggeration.
    pub(super) sea_level: f64,
}

/// Adds to a recipe what blocks need. Classes that the recipe has get the numbers of the standard classes with the same
/// names; if it has no classes and no output `class`, the [standard classes](orogen_engine::recipe::class::standard)
/// are added. `cell` is the size of a block in metres.
///
/// # Errors
/// If the recipe has no output `height`, or a class that is not a standard one.
pub fn prepare(recipe: &mut Recipe, cell: f64) -> Result<()> {
    if !recipe.outputs().any(|name| name == HEIGHT) {
        let message = "the recipe has no output `height`, so there is no ground to build of blocks; name the heights in [outputs]";
        return Err(Error::new(ErrorKind::Recipe, message));
    }
    number(recipe, &NAMES, "ground of blocks", cell)?;
    classify(recipe, cell)
}

impl Land {
    /// The columns of a window, with heights and water multiplied by `exaggeration`. `world` must be made of a
    /// [prepared](prepare) recipe. `fits` checks the levels once they are known, before the density of the ground is
    /// computed.
    ///
    /// # Errors
    /// If the window is not in the world or has no height, if a class is not a whole number from 0 to 5, if heights are
    /// more than [`MAX_LEVEL`] blocks from 0, if `fits` fails, or if `progress` is cancelled.
    pub fn of(
        world: &World,
        window: &Window,
        extent: Extent,
        exaggeration: f64,
        fits: &dyn Fn(Levels) -> Result<()>,
        progress: &Progress,
    ) -> Result<Land> {
        world.check(window)?;
        let [reading, shaping] = progress.parts([1.0, 1.0]);
        let around = world.surroundings(window, HALO);
        let recipe = world.recipe();
        let biome = biomes(recipe).filter(|(name, _)| *name == "biome");
        let has_lakes = recipe.outputs().any(|name| name == LAKES);
        let mut layers = vec![HEIGHT, CLASS];
        layers.extend(has_lakes.then_some(LAKES));
        layers.extend(biome.map(|(name, _)| name));
        let mut grids = world.grids(&layers, &around, &reading)?.into_iter();
        let (Some(heights), Some(classes)) = (grids.next(), grids.next()) else {
            return Err(Error::new(ErrorKind::Internal, "the layers of blocks were not computed"));
        };
        let lakes = has_lakes.then(|| grids.next()).flatten();
        let biomes = biome.and_then(|(_, scheme)| Some((grids.next()?, scheme)));
        let sea_level = recipe.world.sea_level * exaggeration;
        let (sea, steep) = (sea_level as f32, exaggeration as f32);
        let mut columns = Vec::with_capacity(heights.data().len());
        for (k, height) in heights.data().iter().copied().enumerate() {
            let mut cover = cover(&classes, k)?;
            if let Some((biomes, scheme)) = &biomes {
                cover = cover.in_biome(*scheme, biomes.data()[k] as u8);
            }
            let lake = lakes.as_ref().map_or(0.0, |lakes| lakes.data()[k]);
            let height = height * steep;
            let water = match lake > DEPTH {
                true => height + lake * steep,
                false if height < sea => sea,
                false => f32::NEG_INFINITY,
            };
            columns.push(
                Column { height: if height.is_finite() { height } else { f32::NAN }, water, cover }
                    .drowned(window.cell),
            );
        }
        let finite = heights.crop(window).map_or_else(FiniteCount::default, |own| FiniteCount::of(own.data()));
        let has_density = recipe.outputs().any(|name| name == DENSITY);
        let mut land = Land {
            window: *window,
            levels: Levels::between(0, 0),
            finite,
            around,
            columns,
            offsets: None,
            has_trees: true,
            seed: recipe.world.seed,
            sea_level,
        };
        if let Extent::Levels(levels) = extent {
            land.levels = levels;
        }
        // Without a height there are no blocks.
        let Some(range) = land.range(&around) else { return Ok(land) };
        if range.iter().any(|altitude| (f64::from(*altitude) / window.cell).abs() >= f64::from(MAX_LEVEL)) {
            let message = format!(
                "the heights are {} to {} m, and blocks of {} m reach up to {} m from height 0; scale the heights, or use a larger cell",
                words::number(range[0].into()),
                words::number(range[1].into()),
                words::number(window.cell),
                words::number(f64::from(MAX_LEVEL) * window.cell)
            );
            return Err(Error::new(ErrorKind::Request, message));
        }
        let levels_of = |range: [f32; 2]| range.map(|altitude| Levels::of(f64::from(altitude), window.cell));
        let [low, high] = levels_of(range);
        if let (Extent::Below(below), Some([low, high])) = (extent, land.range(window).map(levels_of)) {
            let room = TREE_HEIGHT + if has_density { ROOM } else { 0 };
            land.levels = Levels::between(low - below.min(MAX_BELOW) as i32, high + 1 + room);
        }
        let levels = land.levels;
        fits(levels)?;
        // Whether a tree stands depends on the ground around its foot.
        let reach = Levels::between(low - SOIL_REACH, high + SOIL_REACH + 1);
        land.has_trees = levels.top() > reach.bottom && levels.bottom < reach.top() + TREE_HEIGHT;
        if has_density {
            let mut shaped = Levels::between(levels.bottom, levels.top() + ABOVE);
            if land.has_trees {
                shaped = Levels::between(shaped.bottom.min(reach.bottom), shaped.top().max(reach.top()));
            }
            land.offsets = Some(Offsets::of(world, &around, shaped, exaggeration, &shaping)?);
        }
        shaping.finish();
        Ok(land)
    }

    /// The column at a position; `None` outside the window and its halo.
    #[inline]
    pub(super) fn column(&self, x: i64, y: i64) -> Option<&Column> {
        let (x, y) = (x - self.around.x, y - self.around.y);
        let is_inside = (0..self.around.width as i64).contains(&x) && (0..self.around.height as i64).contains(&y);
        is_inside.then(|| &self.columns[y as usize * self.around.width + x as usize])
    }

    /// The lowest altitude of the ground and the highest of ground or water in a part of the land; `None` if there is
    /// neither.
    fn range(&self, part: &Window) -> Option<[f32; 2]> {
        let left = (part.x - self.around.x) as usize;
        let rows = ((part.y - self.around.y) as usize..).take(part.height).map(|row| row * self.around.width + left);
        let columns = rows.flat_map(|start| &self.columns[start..start + part.width]);
        let mut range: Option<[f32; 2]> = None;
        for column in columns.filter(|column| column.height.is_finite()) {
            let [low, high] = [column.height, column.height.max(column.water)];
            let [lowest, highest] = range.unwrap_or([low, high]);
            range = Some([lowest.min(low), highest.max(high)]);
        }
        range
    }
}

/// The cover for the class of a sample.
fn cover(classes: &Grid, at: usize) -> Result<Cover> {
    let value = classes.data()[at];
    if value.is_nan() {
        return Ok(Cover::Rock);
    }
    let class = value.round();
    let is_whole = (value - class).abs() <= WHOLE && class >= 0.0;
    match Cover::OF_CLASSES.get(class as usize).filter(|_| is_whole) {
        Some(cover) => Ok(*cover),
        None => {
            let (window, width) = (classes.window(), classes.width());
            let message = format!(
                "the output `class` is {value} in column {}, row {}; it must be one of 0 water, 1 sand, 2 grass, 3 forest, 4 rock, 5 snow",
                window.x + (at % width) as i64,
                window.y + (at / width) as i64
            );
            Err(Error::new(ErrorKind::Request, message))
        }
    }
}
