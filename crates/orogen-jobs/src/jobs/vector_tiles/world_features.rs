//! Features that depend on the whole of a bounded world: its rivers and lakes, unless tiles have them from the recipe's
//! own network, and its summits. They are found once, at the world's cell or a multiple of it.

use super::tile_layers::{LAKES, RIVERS, SUMMITS, TileLayerSpec};
use crate::export::features::options::FeatureOptions;
use crate::export::features::source::FeatureSource;
use crate::export::vectors;
use crate::options::Options;
use orogen_engine::budget::Reservation;
use orogen_engine::world::{HEIGHT, World};
use orogen_grid::error::{Error, ErrorKind, Result};
use orogen_grid::grid::Window;
use orogen_grid::hydrography::summits::{self, summits};
use orogen_grid::hydrography::water::Frame;
use orogen_grid::progress::Progress;
use orogen_io::format::features::{Feature, FeatureLayer, Field, FieldType, Geometry, GeometryType, Value};
use orogen_io::format::levels::{NO_SAMPLES, extremes};

/// Maximum number of samples in which features are searched.
const MAX_SAMPLES: f64 = 4096.0 * 4096.0;

/// Minimum prominence of a summit, as a share of the relief, and maximum number of summits.
const SHARE: f32 = 1.0 / 250.0;
const MAX_SUMMITS: usize = 20_000;

/// Memory of a feature, and of each of its vertices, in bytes.
const FEATURE: u64 = 512;
const VERTEX: u64 = 24;

/// The features of a world, in metres east and south of its origin.
pub struct WorldFeatures {
    layers: Vec<(&'static TileLayerSpec, BoundedLayer)>,
    _held: Reservation,
}

/// A layer with the bounds of its features.
pub struct BoundedLayer {
    pub layer: FeatureLayer,
    /// West, south, east and north of each feature's coordinates.
    bounds: Vec<[f64; 4]>,
}

impl BoundedLayer {
    fn new(mut layer: FeatureLayer) -> BoundedLayer {
        layer.features.retain(|feature| feature.geometry.bounds().is_some());
        let bounds = layer.features.iter().filter_map(|feature| feature.geometry.bounds()).collect();
        BoundedLayer { layer, bounds }
    }

    /// The features with their bounds.
    pub fn features(&self) -> impl Iterator<Item = (&Feature, [f64; 4])> {
        self.layer.features.iter().zip(self.bounds.iter().copied())
    }
}

/// The window in which features of the whole world are searched.
fn window(world: &World) -> Result<Window> {
    let mut cell = world.recipe().world.cell;
    loop {
        let window = world.full_window(cell)?;
        if window.width as f64 * window.height as f64 <= MAX_SAMPLES {
            return Ok(window);
        }
        cell *= 2.0;
    }
}

impl WorldFeatures {
    /// Finds the features of a bounded world: its summits, and its water if `with_water`.
    ///
    /// # Errors
    /// If memory does not suffice, or the work was cancelled.
    pub fn of(world: &World, with_water: bool, progress: &Progress) -> Result<WorldFeatures> {
        let (window, given) = (window(world)?, Options::default());
        let mut layers = Vec::new();
        let search = summits::MEMORY * window.len() as u64;
        if with_water {
            let options = FeatureOptions::new(&given, world.recipe())?;
            let ground = FeatureSource::of(world, &window, &options, search, progress)?;
            for (spec, vector) in [(&RIVERS, &vectors::rivers::LAYER), (&LAKES, &vectors::lakes::LAYER)] {
                let made = world.install(|| vector.of_ground(&ground, &options, progress));
                let missing = || Error::new(ErrorKind::Internal, "rivers and lakes are not made from heights");
                layers.push((spec, BoundedLayer::new(made.ok_or_else(missing)??)));
            }
        }
        progress.check()?;
        layers.push((&SUMMITS, BoundedLayer::new(highest(world, &window, search, progress)?)));
        let features = || layers.iter().flat_map(|(_, layer)| &layer.layer.features);
        let memory = |feature: &Feature| FEATURE + VERTEX * feature.geometry.vertices() as u64;
        let held = world.budget().reserve(features().map(memory).sum())?;
        Ok(WorldFeatures { layers, _held: held })
    }

    /// A layer, if it was searched.
    pub fn layer(&self, spec: &TileLayerSpec) -> Option<&BoundedLayer> {
        self.layers.iter().find(|(own, _)| own.name == spec.name).map(|(_, layer)| layer)
    }
}

/// The summits of a window with the attributes of exports, the most prominent first.
fn highest(world: &World, window: &Window, search: u64, progress: &Progress) -> Result<FeatureLayer> {
    const FIELDS: &[Field] = &[
        Field { name: "id", kind: FieldType::Integer, about: "number of the summit, from 1" },
        Field { name: "height", kind: FieldType::Real, about: "height, m" },
        Field { name: "prominence", kind: FieldType::Real, about: "prominence, m" },
    ];
    let heights = world.grid_beside(HEIGHT, window, search, progress)?;
    let range = extremes(NO_SAMPLES, heights.data());
    let frame = Frame { columns: 0..window.width, rows: 0..window.height };
    let sea_level = Some(world.recipe().world.sea_level as f32);
    let mut found = world.install(|| summits(&heights, &frame, sea_level, (range[1] - range[0]) * SHARE));
    found.truncate(MAX_SUMMITS);
    let feature = |(id, summit): (i64, &summits::Summit)| {
        let height = f64::from(summit.height);
        let [i, j] = summit.place;
        let values = vec![Value::Integer(id), Value::Real(height), Value::Real(f64::from(summit.prominence))];
        Feature { geometry: Geometry::Point([window.east(i), window.south(j), height]), values }
    };
    let features = (1..).zip(&found).map(feature).collect();
    Ok(FeatureLayer {
        name: SUMMITS.name,
        about: SUMMITS.about,
        geometry: GeometryType::Point,
        fields: FIELDS,
        features,
    })
}
