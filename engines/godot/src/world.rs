//! `OrogenWorld`: worlds and what is read of them.

use std::path::Path;
use std::sync::Arc;

use godot::classes::ProjectSettings;
use godot::prelude::*;
use orogen::recipe::source::RecipeSource;
use orogen::{Progress, Sampler, Window, World};

/// A world: a preset, a recipe or a file of heights.
#[derive(GodotClass)]
#[class(init, base = RefCounted)]
pub struct OrogenWorld {
    world: Option<Arc<World>>,
    heights: Option<Arc<Sampler<Arc<World>>>>,
    error: String,
}

/// Memory of a file of heights, in bytes.
const MEMORY: u64 = 4 << 30;

#[godot_api]
impl OrogenWorld {
    /// Opens a preset by its name, or a file by its path, which may start with `res://` or `user://`. Returns whether
    /// it is open; otherwise `get_error` says why.
    #[func]
    fn open(&mut self, source: GString) -> bool {
        self.open_with(source, -1, VarDictionary::new())
    }

    /// Opens a world with another seed, unless it is negative, and other values of the recipe's parameters.
    #[func]
    fn open_with(&mut self, source: GString, seed: i64, parameters: VarDictionary) -> bool {
        let opened = opened(&source.to_string(), seed, &parameters);
        self.keep(opened)
    }

    /// Opens a recipe from its text, TOML or JSON. Messages call it `name`.
    #[func]
    fn parse(&mut self, text: GString, name: GString) -> bool {
        let opened = orogen::Recipe::parse(&text.to_string(), &name.to_string())
            .and_then(World::open)
            .map_err(|error| error.to_string());
        self.keep(opened)
    }

    /// Why the last call failed.
    #[func]
    fn get_error(&self) -> GString {
        GString::from(self.error.as_str())
    }

    /// The seed; -1 without a world.
    #[func]
    fn get_seed(&self) -> i64 {
        self.world.as_ref().map_or(-1, |world| world.recipe().world.seed as i64)
    }

    /// Metres from west to east and from north to south; zero for an unbounded world.
    #[func]
    fn get_size(&self) -> Vector2 {
        let size = self.world.as_ref().and_then(|world| world.recipe().world.size).unwrap_or_default();
        Vector2::new(size[0] as f32, size[1] as f32)
    }

    /// The height of the sea, in metres.
    #[func]
    fn get_sea_level(&self) -> f64 {
        self.world.as_ref().map_or(0.0, |world| world.recipe().world.sea_level)
    }

    /// The height at a point, in metres east and south of the origin; NaN after an error.
    #[func]
    fn height(&mut self, x: f64, z: f64) -> f64 {
        let read = self.sampler().and_then(|heights| heights.at(x, z).map_err(|error| error.to_string()));
        self.told(read).map_or(f64::NAN, f64::from)
    }

    /// The heights at points; empty after an error.
    #[func]
    fn heights(&mut self, points: PackedVector2Array) -> PackedFloat32Array {
        let [x, z]: [Vec<f64>; 2] = [
            points.as_slice().iter().map(|point| f64::from(point.x)).collect(),
            points.as_slice().iter().map(|point| f64::from(point.y)).collect(),
        ];
        let mut found = vec![0.0; x.len()];
        let read =
            self.sampler().and_then(|heights| heights.points(&x, &z, &mut found).map_err(|error| error.to_string()));
        self.told(read).map(|()| PackedFloat32Array::from(found.as_slice())).unwrap_or_default()
    }

    /// The samples of a layer, row by row from the north: sample (i, j) is at ((x + i) cell, (z + j) cell) metres.
    /// Empty after an error.
    #[func]
    fn window(&mut self, layer: GString, x: i64, z: i64, width: i64, height: i64, cell: f64) -> PackedFloat32Array {
        let read = window_of(x, z, width, height, cell)
            .and_then(|window| self.opened()?.window(&layer.to_string(), &window).map_err(|error| error.to_string()));
        self.told(read).map(|grid| PackedFloat32Array::from(grid.data())).unwrap_or_default()
    }

    /// The objects of a window, for each kind an array of transforms with y up, as a `MultiMesh` takes them. Empty
    /// after an error.
    #[func]
    fn objects(&mut self, x: i64, z: i64, width: i64, height: i64, cell: f64) -> VarDictionary {
        let read = window_of(x, z, width, height, cell).and_then(|window| {
            let world = self.opened()?;
            let found = world.objects(&window, &Progress::none()).map_err(|error| error.to_string())?;
            Ok((world, found))
        });
        let mut kinds = VarDictionary::new();
        let Some((world, found)) = self.told(read) else { return kinds };
        for (entry, scatter) in world.recipe().scatter().iter().enumerate() {
            let transforms: Array<Transform3D> = found
                .iter()
                .filter(|object| object.entry == entry)
                .map(|object| {
                    // Clockwise seen from above is a negative turn about y.
                    let turn = -(object.turn as f32).to_radians();
                    let size = Vector3::splat(object.size as f32);
                    let basis = Basis::from_axis_angle(Vector3::UP, turn).scaled(size);
                    let [east, south] = object.position;
                    Transform3D::new(basis, Vector3::new(east as f32, object.height as f32, south as f32))
                })
                .collect();
            kinds.set(&scatter.name.to_variant(), &transforms.to_variant());
        }
        kinds
    }
}

impl OrogenWorld {
    /// The world, if one is open.
    pub fn opened(&self) -> Result<Arc<World>, String> {
        self.world.clone().ok_or_else(|| "no world is open; call open first".to_string())
    }

    fn sampler(&self) -> Result<Arc<Sampler<Arc<World>>>, String> {
        self.opened()?;
        self.heights.clone().ok_or_else(|| "the world has no layer `height`".to_string())
    }

    fn keep(&mut self, opened: Result<World, String>) -> bool {
        self.world = self.told(opened).map(Arc::new);
        self.heights =
            self.world.as_ref().and_then(|world| Sampler::new(Arc::clone(world), "height").ok()).map(Arc::new);
        self.world.is_some()
    }

    /// The value, or none after the error is kept and printed.
    fn told<T>(&mut self, read: Result<T, String>) -> Option<T> {
        match read {
            Ok(value) => Some(value),
            Err(message) => {
                godot_error!("{message}");
                self.error = message;
                None
            }
        }
    }
}

/// Opens a world with a seed and parameters.
fn opened(source: &str, seed: i64, parameters: &VarDictionary) -> Result<World, String> {
    let path = match source.starts_with("res://") || source.starts_with("user://") {
        true => ProjectSettings::singleton().globalize_path(source).to_string(),
        false => source.to_string(),
    };
    let mut set = Vec::new();
    for (name, value) in parameters.iter_shared() {
        let value = value.try_to::<f64>().or_else(|_| value.try_to::<i64>().map(|whole| whole as f64));
        set.push((name.to_string(), value.map_err(|_| format!("the parameter {name} must be a number"))?));
    }
    let found = RecipeSource::find(Path::new(&path)).and_then(|source| source.read(&set, MEMORY, |_| {}));
    let mut recipe = found.map_err(|error| error.to_string())?;
    if let Ok(seed) = u64::try_from(seed) {
        recipe.world.seed = seed;
    }
    World::open(recipe).map_err(|error| error.to_string())
}

/// A window, if its sides are numbers of samples.
fn window_of(x: i64, z: i64, width: i64, height: i64, cell: f64) -> Result<Window, String> {
    match (usize::try_from(width), usize::try_from(height)) {
        (Ok(width), Ok(height)) => Ok(Window::new(width, height, cell).at(x, z)),
        _ => Err(format!("a window of {width} x {height} samples is empty")),
    }
}
