//! A world that is served.

use std::collections::HashMap;
use std::sync::{Arc, Mutex, MutexGuard, OnceLock, PoisonError};

use orogen::builder::tile_grid::{self, MAX_ZOOM, TileGrid, UNBOUNDED_ZOOM};
use orogen::builder::zarr_layout::ZarrLayout;
use orogen::export::derived::layer::Made;
use orogen::export::derived::list;
use orogen::grid::hex;
use orogen::io::format::Georeference;
use orogen::io::palette::named::Named;
use orogen::jobs::map_tiles::MapTiles;
use orogen::jobs::vector_tiles::VectorTiles;
use orogen::options::Options;
use orogen::world::HEIGHT;
use orogen::{Error, Progress, Recipe, Result, Sampler, Session, Window, World};
use sha2::{Digest, Sha256};

use crate::desk::Keep;
use crate::recent::Recent;
use crate::sent;

/// Side of a tile in pixels, unless its name ends with `@2x`.
pub const TILE: usize = 256;

/// Zooms beyond the one of the world's own cell that descriptions list: fields have detail at any cell.
const DEEPER: u32 = 3;

/// Variants of a world that are kept open, and those of a world whose recipe a client sent.
const MAX_VARIANTS: usize = 16;
const MAX_VARIANTS_SENT: usize = 4;

/// A grid of tiles.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Frame {
    /// That of web maps.
    Web,
    /// The square of the world, in its own coordinate system.
    World,
}

impl Frame {
    pub const ALL: [Frame; 2] = [Frame::Web, Frame::World];

    /// The name in requests.
    pub fn name(self) -> &'static str {
        match self {
            Frame::Web => "web",
            Frame::World => "world",
        }
    }
}

/// Zooms that descriptions list.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Zooms {
    /// The highest zoom at which the world is in one tile.
    pub least: u32,
    /// The zoom whose cell is closest to the world's own.
    pub own: u32,
    /// The highest zoom.
    pub most: u32,
}

/// A layer in a description.
pub struct LayerInfo {
    pub name: String,
    pub about: String,
    pub unit: &'static str,
}

/// A world that is served, under a name.
pub struct Served {
    pub name: String,
    /// Whether it is a file of heights.
    pub is_place: bool,
    session: Session,
    world: Arc<World>,
    /// Worlds of the recipe with the nodes of a derived layer, by the layer.
    derived: Mutex<HashMap<String, Arc<World>>>,
    /// Layers with their colors, by the layer and the palette.
    maps: Mutex<HashMap<[String; 2], Arc<MapTiles>>>,
    samplers: Mutex<HashMap<String, Arc<Sampler<Arc<World>>>>>,
    vector: Arc<VectorTiles>,
    /// Whether a client sent its recipe.
    pub is_sent: bool,
    /// Variants that were requested last.
    pub variants: Recent<Served>,
    /// The levels of its Zarr store, once it was requested.
    pub zarr: OnceLock<Vec<ZarrLayout>>,
    /// Changes with anything that an answer depends on.
    pub version: String,
}

/// Data under these locks is consistent at any time, also after a panic of another thread.
pub fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

/// The key of a map.
fn key_of(layer: &str, palette: Option<&Named>) -> [String; 2] {
    [layer.to_string(), palette.map_or(String::new(), |named| named.name.to_string())]
}

impl Served {
    /// Opens a recipe.
    ///
    /// # Errors
    /// If it is not valid.
    pub fn new(name: &str, session: &Session, recipe: Recipe, is_place: bool) -> Result<Served> {
        let world = Arc::new(session.open(recipe)?);
        let mut served = Served {
            name: name.to_string(),
            is_place,
            session: session.clone(),
            vector: Arc::new(VectorTiles::new(Arc::clone(&world), is_place)),
            world,
            derived: Mutex::default(),
            maps: Mutex::default(),
            samplers: Mutex::default(),
            is_sent: false,
            variants: Recent::new(MAX_VARIANTS),
            zarr: OnceLock::new(),
            version: String::new(),
        };
        let names: Vec<String> = served.recipe().outputs().map(str::to_string).collect();
        let mut hash = Sha256::new();
        for name in names {
            hash.update(served.fingerprint(&name)?);
        }
        if served.has_heights() {
            hash.update(served.vector.key()?);
        }
        served.version = hex::encode(&hash.finalize())[..16].to_string();
        Ok(served)
    }

    /// Opens a recipe that a client sent.
    ///
    /// # Errors
    /// If it is not valid, or beyond the [limits](sent::check) of such recipes.
    pub fn sent(name: &str, session: &Session, recipe: Recipe) -> Result<Served> {
        let opened = Served::new(name, session, recipe, false)?;
        sent::check(&opened.world)?;
        Ok(Served { is_sent: true, variants: Recent::new(MAX_VARIANTS_SENT), ..opened })
    }

    /// The same world with another recipe.
    ///
    /// # Errors
    /// If it is not valid.
    pub fn changed(&self, recipe: Recipe) -> Result<Served> {
        match self.is_sent {
            true => Served::sent(&self.name, &self.session, recipe),
            false => Served::new(&self.name, &self.session, recipe, self.is_place),
        }
    }

    /// What becomes of work that later requests need, too, if nobody waits for it any more: that of recipes of clients
    /// ends with the clients, so that it takes no longer than their requests may.
    pub fn keep(&self) -> Keep {
        if self.is_sent { Keep::Nothing } else { Keep::Work }
    }

    /// The recipe.
    pub fn recipe(&self) -> &Recipe {
        self.world.recipe()
    }

    /// The session.
    pub fn session(&self) -> &Session {
        &self.session
    }

    /// The world with its own layers.
    pub fn world(&self) -> &Arc<World> {
        &self.world
    }

    /// The world's position on a map.
    pub fn map(&self) -> Option<Georeference> {
        self.recipe().georeference()
    }

    /// The description of the world, or its name.
    pub fn title(&self) -> &str {
        match self.recipe().about.as_str() {
            "" => &self.name,
            about => about,
        }
    }

    /// Whether the world has heights.
    pub fn has_heights(&self) -> bool {
        self.world.unit(HEIGHT).is_ok()
    }

    /// The layers that have tiles: those of the recipe, and those derived from its heights.
    pub fn layers(&self) -> Vec<LayerInfo> {
        let unit = |layer: &str| self.world.unit(layer).unwrap_or_default();
        let own =
            |name: &str| LayerInfo { name: name.into(), about: format!("{name} of the recipe"), unit: unit(name) };
        let mut layers: Vec<LayerInfo> = self.recipe().outputs().map(own).collect();
        if !self.has_heights() {
            return layers;
        }
        let is_bounded = self.recipe().world.size.is_some();
        for derived in list::all() {
            let fits = match &derived.made {
                Made::Nodes(nodes) => is_bounded || !nodes.bounded,
                Made::Channels(_) => derived.name != "splat",
            };
            // Viewsheds need the place of the viewer.
            if fits && derived.name != "viewshed" && layers.iter().all(|layer| layer.name != derived.name) {
                layers.push(LayerInfo { name: derived.name.into(), about: derived.about.into(), unit: "" });
            }
        }
        layers
    }

    /// The world that has a layer.
    ///
    /// # Errors
    /// If there is no such layer.
    pub fn world_of(&self, layer: &str) -> Result<Arc<World>> {
        let own = self.world.unit(layer);
        if own.is_ok() {
            return Ok(Arc::clone(&self.world));
        }
        if let Some(world) = lock(&self.derived).get(layer) {
            return Ok(Arc::clone(world));
        }
        if list::named(layer).is_none() {
            // Its message names the layers that there are.
            orogen::export::LayerSource::new(&self.world, layer, Window::new(1, 1, self.cell()), &Progress::none())?;
        }
        let mut recipe = self.recipe().clone();
        list::prepare(&mut recipe, layer, &Options::default())?;
        let world = Arc::new(self.session.open(recipe)?);
        // Only layers of the list get here, so the worlds are few.
        Ok(Arc::clone(lock(&self.derived).entry(layer.to_string()).or_insert(world)))
    }

    fn cell(&self) -> f64 {
        self.recipe().world.cell
    }

    /// A hash of everything that the samples and the colors of a layer depend on.
    ///
    /// # Errors
    /// If there is no such layer.
    pub fn fingerprint(&self, layer: &str) -> Result<Vec<u8>> {
        let world = self.world_of(layer)?;
        let spec = &self.recipe().world;
        let mut hash = Sha256::new();
        hash.update(env!("CARGO_PKG_VERSION"));
        hash.update(layer);
        for layer in [layer, HEIGHT] {
            hash.update(world.key(layer).unwrap_or_default());
        }
        let place = self.map().map(|map| (map.origin, map.per_metre, map.epsg()));
        hash.update(format!("{:?} {} {} {} {place:?}", spec.size, spec.cell, spec.sea_level, self.is_place));
        Ok(hash.finalize().to_vec())
    }

    /// The tiles of a zoom.
    ///
    /// # Errors
    /// If the world has none at this zoom.
    pub fn grid(&self, frame: Frame, zoom: u32, side: usize) -> Result<TileGrid> {
        match frame {
            Frame::Web => TileGrid::web(&self.world, zoom, side),
            Frame::World => TileGrid::own(&self.world, zoom, side),
        }
    }

    /// The zooms of a grid that descriptions list.
    ///
    /// # Errors
    /// If the world is not on the map.
    pub fn zooms(&self, frame: Frame) -> Result<Zooms> {
        let is_bounded = self.recipe().world.size.is_some();
        let own = match frame {
            Frame::World if !is_bounded => UNBOUNDED_ZOOM,
            _ => {
                // The cell of a zoom is half that of the zoom before.
                let per_metre = tile_grid::web_map(self.map().as_ref()).map_or(1.0, |map| map.per_metre[0]);
                let coarsest = match (frame, self.recipe().world.size) {
                    (Frame::World, Some([width, height])) => width.max(height) / TILE as f64,
                    _ => tile_grid::pixel(0, TILE) / per_metre,
                };
                libm::log2(coarsest / self.cell()).round().clamp(0.0, f64::from(MAX_ZOOM)) as u32
            }
        };
        let is_one = |zoom: &u32| {
            let tiles = self.grid(frame, *zoom, TILE).map(|grid| grid.tiles());
            tiles.is_ok_and(|tiles| tiles.iter().all(|[first, last]| first == last))
        };
        let least = if is_bounded { (0..=own).rev().find(is_one).unwrap_or(0) } else { 0 };
        let most = if self.is_place { own } else { (own + DEEPER).min(MAX_ZOOM) };
        Ok(Zooms { least, own, most })
    }

    /// The map of a layer in a palette, if it is ready.
    pub fn ready_map(&self, layer: &str, palette: Option<&Named>) -> Option<Arc<MapTiles>> {
        lock(&self.maps).get(&key_of(layer, palette)).cloned()
    }

    /// Fits the colors of a layer, from a palette or its own.
    ///
    /// # Errors
    /// The errors of [`MapTiles::new`].
    pub fn fit_map(&self, layer: &str, palette: Option<&Named>, progress: &Progress) -> Result<()> {
        let colors = palette.map(Named::palette);
        let map = Arc::new(MapTiles::new(self.world_of(layer)?, layer, colors, self.is_place, progress)?);
        lock(&self.maps).insert(key_of(layer, palette), map);
        Ok(())
    }

    /// The vector tiles.
    pub fn vector(&self) -> &Arc<VectorTiles> {
        &self.vector
    }

    /// A layer at points.
    ///
    /// # Errors
    /// If the layer is not one number a sample.
    pub fn sampler(&self, layer: &str) -> Result<Arc<Sampler<Arc<World>>>> {
        if let Some(sampler) = lock(&self.samplers).get(layer) {
            return Ok(Arc::clone(sampler));
        }
        let sampler = Arc::new(Sampler::new(self.world_of(layer)?, layer)?);
        Ok(Arc::clone(lock(&self.samplers).entry(layer.to_string()).or_insert(sampler)))
    }

    /// Web maps show the world at its real position.
    pub fn is_on_web_map(&self) -> bool {
        tile_grid::web_map(self.map().as_ref()).is_some()
    }

    /// An error of a tile that is not in the world.
    pub fn outside(&self, grid: &TileGrid) -> Error {
        let [[left, right], [top, bottom]] = grid.tiles();
        let message = format!(
            "this tile is outside the world; at zoom {} it has the columns {left} to {right} and the rows {top} to {bottom}",
            grid.zoom()
        );
        Error::new(orogen::ErrorKind::Request, message)
    }
}
