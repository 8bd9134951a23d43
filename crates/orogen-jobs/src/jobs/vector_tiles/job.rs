//! Vector tiles.

use std::sync::{Arc, Mutex, PoisonError};

use super::tile_layers::{ALL, CONTOURS, LAKES, OBJECTS, RIVERS, SUMMITS, TileLayerSpec, values};
use super::world_features::{BoundedLayer, WorldFeatures};
use crate::builder::tile_grid::TileGrid;
use crate::export::features::layer::Maker;
use crate::export::features::options::FeatureOptions;
use crate::export::features::source::FeatureSource;
use crate::export::vectors;
use crate::jobs::map_water;
use crate::options::Options;
use orogen_engine::budget::Reservation;
use orogen_engine::recipe::network::OwnNetwork;
use orogen_engine::world::{HEIGHT, World};
use orogen_grid::error::{Error, ErrorKind, Result};
use orogen_grid::grid::{Grid, Window};
use orogen_grid::hydrography::peaks::peaks;
use orogen_grid::progress::Progress;
use orogen_grid::resample::LayerKind;
use orogen_grid::words;
use orogen_io::format::features::{Feature, FeatureLayer, Geometry, Value};
use orogen_io::format::mvt::{self, TileFeature, TileLayer};
use orogen_output::vector_tile::frame::{BUFFER, EXTENT, TileFrame};
use orogen_output::vector_tile::tile_contours::{contours, default_interval};
use sha2::{Digest, Sha256};

/// Samples around a tile whose contours belong to its buffer.
const MARGIN: usize = BUFFER as usize * VectorTiles::SIDE / EXTENT as usize + 1;

/// Distance in samples within which a summit of an unbounded world is the highest ground.
const RADIUS: usize = 48;

/// Minimum drainage area of a river and minimum area of a lake, in samples of the tile.
const RIVER: f64 = 400.0;
const LAKE: f64 = 16.0;

/// Summits per tile, on average over the tiles of the world.
const SUMMITS_PER_TILE: f64 = 12.0;

/// Maximum number of objects for which there is room in a tile.
const MAX_OBJECTS: f64 = 50_000.0;

/// Memory per sample of a tile beside its heights, in bytes: the pixels and the crossings of contours.
const SAMPLE_MEMORY: u64 = 64;

/// Where the water of tiles comes from.
enum WaterSource {
    /// The recipe's own network of levels, of which any window has the same rivers.
    Network(OwnNetwork),
    /// The heights of the whole world.
    World,
    /// Nowhere.
    None,
}

/// The vector tiles of a world.
pub struct VectorTiles {
    world: Arc<World>,
    water: WaterSource,
    has_lakes: bool,
    found: Mutex<Option<Arc<WorldFeatures>>>,
}

impl VectorTiles {
    /// Samples along the side of a tile from which its contours are made: those of the raster tiles that a map shows
    /// with it.
    pub const SIDE: usize = 512;

    /// The tiles of a world. `is_place`: it is a real place, a file of heights, whose depressions are no lakes.
    #[must_use]
    pub fn new(world: Arc<World>, is_place: bool) -> VectorTiles {
        let recipe = world.recipe();
        let water = match OwnNetwork::of(recipe) {
            _ if world.unit(HEIGHT).is_err() => WaterSource::None,
            Some(network) => WaterSource::Network(network),
            None if recipe.world.size.is_some() && (is_place || map_water::is_drained(recipe)) => WaterSource::World,
            None => WaterSource::None,
        };
        VectorTiles { world, water, has_lakes: !is_place, found: Mutex::default() }
    }

    /// The layers that the world has.
    #[must_use]
    pub fn layers(&self) -> Vec<&'static TileLayerSpec> {
        ALL.into_iter().filter(|spec| self.why_absent(spec).is_none()).collect()
    }

    /// The layers with these names, separated by commas.
    ///
    /// # Errors
    /// If there is no layer with a name, or the world does not have it.
    pub fn chosen(&self, names: &str) -> Result<Vec<&'static TileLayerSpec>> {
        let refuse = |message: String| Err(Error::new(ErrorKind::Request, message));
        let mut chosen = Vec::new();
        for name in names.split(',').map(str::trim) {
            let Some(spec) = ALL.into_iter().find(|spec| spec.name == name) else {
                let known = words::suggestion(name, ALL.iter().map(|spec| spec.name));
                return refuse(format!("vector tiles have no layer `{name}`; {known}"));
            };
            if let Some(why) = self.why_absent(spec) {
                return refuse(format!("this world has no {}: {why}", spec.name));
            }
            chosen.push(spec);
        }
        // In the order of their declaration, each once.
        Ok(ALL.into_iter().filter(|spec| chosen.iter().any(|own| own.name == spec.name)).collect())
    }

    /// Why the world does not have a layer.
    fn why_absent(&self, spec: &TileLayerSpec) -> Option<&'static str> {
        let recipe = self.world.recipe();
        let is_water = spec.name == RIVERS.name || spec.name == LAKES.name;
        match (&self.water, spec.name) {
            _ if self.world.unit(HEIGHT).is_err() => Some("it has no layer `height`"),
            (WaterSource::None, _) if is_water && recipe.world.size.is_some() => {
                Some("nothing drains its land, such as erosion or an output `rivers`")
            }
            (WaterSource::None, _) if is_water => {
                Some("it is unbounded, and its recipe has no network of rivers (outputs `flow` and `receiver`)")
            }
            (_, name) if name == LAKES.name && !self.has_lakes => {
                Some("depressions of a file of heights are mostly valleys that its samples dam")
            }
            (_, name) if name == OBJECTS.name && recipe.scatter().is_empty() => {
                Some("its recipe has no table `[[scatter]]`")
            }
            _ => None,
        }
    }

    /// A hash of everything that the features depend on, besides the tile.
    ///
    /// # Errors
    /// If the world has no heights.
    pub fn key(&self) -> Result<Vec<u8>> {
        let recipe = self.world.recipe();
        let given = Options::default();
        let options = FeatureOptions::new(&given, recipe)?;
        let mut hash = Sha256::new();
        for output in [HEIGHT].into_iter().chain(recipe.outputs()) {
            hash.update(self.world.key(output)?);
        }
        for scatter in recipe.expanded_scatter() {
            hash.update(self.world.key(&scatter.density)?);
        }
        let FeatureOptions { river, lake, sea, channel, .. } = options;
        hash.update(format!("{river:?} {lake} {sea} {channel:?} {:?} {}", recipe.scatter(), self.has_lakes));
        Ok(hash.finalize().to_vec())
    }

    /// Whether features of the whole world that these layers need are known; [`find`](VectorTiles::find) finds them.
    #[must_use]
    pub fn is_ready(&self, layers: &[&TileLayerSpec]) -> bool {
        let needs = |spec: &&TileLayerSpec| {
            spec.name == SUMMITS.name && self.world.recipe().world.size.is_some()
                || (spec.name == RIVERS.name || spec.name == LAKES.name) && matches!(self.water, WaterSource::World)
        };
        !layers.iter().any(needs) || self.found().is_some()
    }

    fn found(&self) -> Option<Arc<WorldFeatures>> {
        self.found.lock().unwrap_or_else(PoisonError::into_inner).clone()
    }

    /// Finds the features of the whole world, which may need the solution of it.
    ///
    /// # Errors
    /// If memory does not suffice, or the work was cancelled.
    pub fn find(&self, progress: &Progress) -> Result<()> {
        let found = Arc::new(WorldFeatures::of(&self.world, matches!(self.water, WaterSource::World), progress)?);
        *self.found.lock().unwrap_or_else(PoisonError::into_inner) = Some(found);
        Ok(())
    }

    /// The default interval of contours of a grid of tiles, in metres.
    #[must_use]
    pub fn interval(grid: &TileGrid) -> f64 {
        default_interval(metres(grid))
    }

    /// The tile at a column and a row of a grid whose tiles have [`SIDE`](VectorTiles::SIDE) pixels, as Mapbox Vector
    /// Tile; no bytes without any feature.
    ///
    /// # Errors
    /// If the interval gives too many contours, memory does not suffice, or the work was cancelled.
    pub fn tile(
        &self,
        grid: &TileGrid,
        [column, row]: [u64; 2],
        layers: &[&'static TileLayerSpec],
        interval: f64,
        progress: &Progress,
    ) -> Result<Vec<u8>> {
        let unit = f64::from(EXTENT) / VectorTiles::SIDE as f64;
        let (origin, per_metre) = grid.corner(column, row);
        let tile = Tile {
            tiles: self,
            grid,
            at: [column, row],
            frame: TileFrame { origin, scale: per_metre.map(|pixels| pixels * unit) },
            progress,
        };
        let has = |spec: &TileLayerSpec| layers.iter().any(|layer| layer.name == spec.name);
        let is_bounded = self.world.recipe().world.size.is_some();
        let margin = if has(&SUMMITS) && !is_bounded { RADIUS.max(MARGIN) } else { MARGIN };
        let heights = match has(&CONTOURS) || has(&SUMMITS) && !is_bounded {
            true => Some(tile.heights(margin)?),
            false => None,
        };
        let mut water = match &self.water {
            WaterSource::Network(network) if has(&RIVERS) || has(&LAKES) => tile.water(network)?,
            _ => None,
        };
        let mut made = Vec::new();
        for spec in layers.iter().copied() {
            progress.check()?;
            let features = match spec.name {
                name if name == CONTOURS.name => match &heights {
                    Some((heights, _)) => self.world.install(|| contours(heights, interval, unit, grid.shift()))?,
                    None => Vec::new(),
                },
                name if name == SUMMITS.name && !is_bounded => {
                    heights.as_ref().map_or(Vec::new(), |(heights, _)| tile.peaks(heights, unit))
                }
                name if name == OBJECTS.name => tile.objects()?,
                _ => match water.iter_mut().flatten().find(|(own, _)| own.name == spec.name) {
                    Some((_, layer)) => tile.features(spec, layer),
                    None => self.found().map_or(Vec::new(), |found| match found.layer(spec) {
                        Some(layer) => tile.known(spec, layer),
                        None => Vec::new(),
                    }),
                },
            };
            made.push(TileLayer { name: spec.name, extent: EXTENT, fields: spec.names(), features });
        }
        Ok(mvt::encode(&made))
    }
}

/// Metres per pixel of a grid.
fn metres(grid: &TileGrid) -> f64 {
    let (_, per_metre) = grid.corner(0, 0);
    1.0 / per_metre[0]
}

/// A tile that is made.
struct Tile<'a> {
    tiles: &'a VectorTiles,
    grid: &'a TileGrid,
    at: [u64; 2],
    frame: TileFrame,
    progress: &'a Progress,
}

impl Tile<'_> {
    /// The heights at the pixels of the tile and around it, as far as the world has them. Columns and rows of the
    /// window count from the corner of the tile.
    fn heights(&self, margin: usize) -> Result<(Grid, Reservation)> {
        let ([column, row], world) = (self.at, &self.tiles.world);
        let window = self.grid.window(column, row, margin);
        let side = VectorTiles::SIDE + 2 * margin;
        let held = world.budget().reserve(SAMPLE_MEMORY * (side * side) as u64)?;
        let heights = world.grid_beside(HEIGHT, &window, 0, self.progress)?;
        let pixels = world.install(|| self.grid.read(column, row, margin, &heights, LayerKind::Height));
        let [columns, rows] = self.grid.within(column, row, margin);
        let first = |at: i64| (at + margin as i64) as usize;
        let mut data = Vec::with_capacity(columns.clone().count() * rows.clone().count());
        for pixels in pixels.chunks_exact(side).take(first(rows.end)).skip(first(rows.start)) {
            data.extend_from_slice(&pixels[first(columns.start)..first(columns.end)]);
        }
        let (width, height) = (columns.clone().count(), rows.clone().count());
        let window = Window { x: columns.start, y: rows.start, width, height, cell: 1.0 };
        let missing = || Error::new(ErrorKind::Internal, "a tile has too few pixels");
        Ok((Grid::from_data(window, data).ok_or_else(missing)?, held))
    }

    /// The rivers and lakes of the tile from the recipe's own network; `None` if it has none at this cell.
    fn water(&self, network: &OwnNetwork) -> Result<Option<[(&'static TileLayerSpec, FeatureLayer); 2]>> {
        let ([column, row], world) = (self.at, &self.tiles.world);
        let window = self.grid.window(column, row, MARGIN);
        if network.cell_for(window.cell).is_none() {
            return Ok(None);
        }
        let given = Options::default();
        let mut options = FeatureOptions::new(&given, world.recipe())?;
        let pixel = metres(self.grid) * metres(self.grid);
        options.river.0 = options.river.0.max(RIVER * pixel);
        options.lake = options.lake.max(LAKE * pixel);
        let ground = FeatureSource::of(world, &window, &options, 0, self.progress)?;
        let missing = || Error::new(ErrorKind::Internal, "rivers and lakes are not made from heights");
        let make = |layer: &crate::export::features::layer::VectorLayer| {
            world.install(|| layer.of_ground(&ground, &options, self.progress)).ok_or_else(missing)?
        };
        let mut lakes = make(&vectors::lakes::LAYER)?;
        // What is in the window is only a part of a lake.
        let part = lakes.fields.iter().position(|field| field.name == "area");
        for feature in &mut lakes.features {
            if let Some(area) = part.and_then(|column| feature.values.get_mut(column)) {
                *area = Value::Null;
            }
        }
        Ok(Some([(&RIVERS, make(&vectors::rivers::LAYER)?), (&LAKES, lakes)]))
    }

    fn features(&self, spec: &TileLayerSpec, layer: &FeatureLayer) -> Vec<TileFeature> {
        let columns = spec.columns(layer);
        let feature = |feature: &Feature| self.frame.feature(&feature.geometry, values(feature, &columns));
        layer.features.iter().filter_map(feature).collect()
    }

    /// The features of the whole world that are in the tile and important enough for its zoom.
    fn known(&self, spec: &TileLayerSpec, known: &BoundedLayer) -> Vec<TileFeature> {
        let columns = spec.columns(&known.layer);
        let pixel = metres(self.grid) * metres(self.grid);
        let index = |name: &str| known.layer.fields.iter().position(|field| field.name == name);
        // The attribute that decides, and the range of its values.
        let pixels = self.grid.pixels().map(|[first, last]| (last - first + 1) as f64 / VectorTiles::SIDE as f64);
        let ranks = (SUMMITS_PER_TILE * (pixels[0] * pixels[1]).max(1.0)).ceil();
        let (decides, least, most) = match spec.name {
            name if name == RIVERS.name => (index("drainage_area"), RIVER * pixel, f64::INFINITY),
            name if name == LAKES.name => (index("area"), LAKE * pixel, f64::INFINITY),
            _ => (index("id"), 0.0, ranks),
        };
        let is_shown = |feature: &&Feature| match decides.and_then(|column| feature.values.get(column)) {
            Some(Value::Real(value)) => (least..=most).contains(value),
            Some(Value::Integer(value)) => (least..=most).contains(&(*value as f64)),
            _ => true,
        };
        (self.frame.features(known.features()).filter(is_shown))
            .filter_map(|feature| self.frame.feature(&feature.geometry, values(feature, &columns)))
            .collect()
    }

    /// The pixels that are higher than all ground within a distance.
    fn peaks(&self, heights: &Grid, unit: f64) -> Vec<TileFeature> {
        let sea_level = self.tiles.world.recipe().world.sea_level as f32;
        let tile = Window::new(VectorTiles::SIDE, VectorTiles::SIDE, 1.0);
        let found = self.tiles.world.install(|| peaks(heights, &tile, RADIUS, sea_level));
        let (pixels, shift) = (heights.window(), self.grid.shift());
        // Pixels of the tile, not metres of the world.
        let frame = TileFrame { origin: [0.0; 2], scale: [unit; 2] };
        let feature = |[i, j]: [usize; 2]| {
            let height = f64::from(heights[(i, j)]);
            let at = [(pixels.x + i as i64) as f64 + shift, (pixels.y + j as i64) as f64 + shift];
            frame.feature(&Geometry::Point([at[0], at[1], height]), vec![Value::Real(height), Value::Null, Value::Null])
        };
        found.into_iter().filter_map(feature).collect()
    }

    /// The objects in the tile; none if they are too many at this zoom.
    fn objects(&self) -> Result<Vec<TileFeature>> {
        let ([column, row], world) = (self.at, &self.tiles.world);
        let side = metres(self.grid) * VectorTiles::SIDE as f64;
        let most: f64 =
            world.recipe().scatter().iter().map(|entry| (side / entry.spacing) * (side / entry.spacing)).sum();
        if most > MAX_OBJECTS {
            return Ok(Vec::new());
        }
        let Maker::World(make) = vectors::scatter::LAYER.make else { return Ok(Vec::new()) };
        Ok(self.features(&OBJECTS, &make(world, &self.grid.window(column, row, 0), self.progress)?))
    }
}
