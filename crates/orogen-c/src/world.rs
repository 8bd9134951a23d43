//! Worlds and their windows.

use std::ffi::c_char;
use std::sync::Arc;

use engine::{Grid, Options, Recipe, Window, World};

use crate::handle::{borrowed, buffer, free, text};
use crate::status::{OrogenStatus, guarded, made, wrong};

/// A world. It may be used by any number of threads at the same time.
pub struct OrogenWorld {
    pub(crate) world: Arc<World>,
}

/// A lattice of samples: sample (i, j) is at ((x + i) * cell, (y + j) * cell) metres east and south of the origin.
#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct OrogenWindow {
    /// Index of the first column.
    pub x: i64,
    /// Index of the first row.
    pub y: i64,
    /// Number of columns.
    pub width: usize,
    /// Number of rows.
    pub height: usize,
    /// Distance between samples, in metres.
    pub cell: f64,
}

impl From<OrogenWindow> for Window {
    fn from(window: OrogenWindow) -> Window {
        Window::new(window.width, window.height, window.cell).at(window.x, window.y)
    }
}

impl From<Window> for OrogenWindow {
    fn from(Window { x, y, width, height, cell }: Window) -> OrogenWindow {
        OrogenWindow { x, y, width, height, cell }
    }
}

/// What a world is.
#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct OrogenWorldInfo {
    /// Whether the world ends; otherwise `width` and `height` are 0.
    pub is_bounded: bool,
    /// Length from west to east, in metres.
    pub width: f64,
    /// Length from north to south, in metres.
    pub height: f64,
    /// The world's own distance between samples, in metres.
    pub cell: f64,
    /// Height of the sea, in metres.
    pub sea_level: f64,
    /// The seed.
    pub seed: u64,
}

/// Opens a preset by its name, or a recipe file (.toml, .json) or a file of heights by its path. Null after an error.
/// Free it by `orogen_world_free`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn orogen_world_open(source: *const c_char) -> *mut OrogenWorld {
    made(|| {
        // SAFETY: the contract of the header.
        let source = unsafe { text(source, "source") }?;
        Ok(OrogenWorld { world: Arc::new(engine::open(source)?) })
    })
}

/// Opens a recipe from its text, TOML or JSON. Errors name its place by `name`. `threads` and `memory` (in bytes) limit
/// all work on this world; 0 stands for all processors and no limit. Null after an error. Free it by
/// `orogen_world_free`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn orogen_world_parse(
    recipe: *const c_char,
    name: *const c_char,
    threads: usize,
    memory: u64,
) -> *mut OrogenWorld {
    made(|| {
        // SAFETY: the contract of the header.
        let (recipe, name) = unsafe { (text(recipe, "recipe")?, text(name, "name")?) };
        let options = Options {
            threads: (threads > 0).then_some(threads),
            memory: engine::Budget::of((memory > 0).then_some(memory)),
            ..Options::default()
        };
        Ok(OrogenWorld { world: Arc::new(World::with_options(Recipe::parse(recipe, name)?, options)?) })
    })
}

/// Frees a world. Samplers and chunks that were made from it stay valid. Null does nothing.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn orogen_world_free(world: *mut OrogenWorld) {
    // SAFETY: the contract of the header.
    unsafe { free(world) }
}

/// What a world is.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn orogen_world_info(world: *const OrogenWorld, info: *mut OrogenWorldInfo) -> OrogenStatus {
    guarded(|| {
        // SAFETY: the contract of the header.
        let (world, info) = unsafe { (borrowed(world, "world")?, buffer(info, 1, "info")?) };
        let spec = &world.world.recipe().world;
        let [width, height] = spec.size.unwrap_or_default();
        info[0] = OrogenWorldInfo {
            is_bounded: spec.size.is_some(),
            width,
            height,
            cell: spec.cell,
            sea_level: spec.sea_level,
            seed: spec.seed,
        };
        Ok(())
    })
}

/// The window of a whole bounded world at a distance between samples, in metres.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn orogen_world_whole(
    world: *const OrogenWorld,
    cell: f64,
    window: *mut OrogenWindow,
) -> OrogenStatus {
    guarded(|| {
        // SAFETY: the contract of the header.
        let (world, window) = unsafe { (borrowed(world, "world")?, buffer(window, 1, "window")?) };
        window[0] = world.world.full_window(cell)?.into();
        Ok(())
    })
}

/// Writes a layer of a window, such as "height", to `out`, row by row from the north-west. `count` is the number of
/// samples that fit, and must be at least width * height.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn orogen_world_window(
    world: *const OrogenWorld,
    layer: *const c_char,
    window: OrogenWindow,
    out: *mut f32,
    count: usize,
) -> OrogenStatus {
    guarded(|| {
        // SAFETY: the contract of the header.
        let (world, layer) = unsafe { (borrowed(world, "world")?, text(layer, "layer")?) };
        let window = Window::from(window);
        world.world.check(&window)?;
        if window.len() > count {
            let message = format!("`out` has room for {count} samples, but the window has {}", window.len());
            return Err(wrong(message));
        }
        let grid: Grid = world.world.window(layer, &window)?;
        // SAFETY: the contract of the header.
        let out = unsafe { buffer(out, grid.data().len(), "out") }?;
        out.copy_from_slice(grid.data());
        Ok(())
    })
}
