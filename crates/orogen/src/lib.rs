//! Orogen, a procedural terrain engine: a recipe describes a world, and the engine makes any window of it, at any
//! resolution, always with the same bits.
//!
//! A [`Recipe`] is a document (TOML or JSON): a world with a seed and lengths in metres, named nodes, named outputs. A
//! [`World`] is an opened recipe. It returns a [`Grid`] of heights for a [`Window`] of a layer, and exactly the same
//! numbers for single points.
//!
//! ```
//! use orogen::{Window, World};
//!
//! let preset = orogen::presets::find("hills").ok_or("no such preset")?;
//! let world = World::open(preset.recipe()?)?;
//! let tile = world.window("height", &Window::new(64, 64, 30.0).at(100, 50))?;
//! let highest = tile.data().iter().copied().fold(f32::MIN, f32::max);
//! println!("the highest of {} samples stands at {highest} m", tile.data().len());
//! assert_eq!(tile[(10, 20)], world.height(tile.window().east(10), tile.window().south(20))?);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! A program beside a clone of Orogen depends on it with `cargo add orogen --path ../orogen/crates/orogen`. Build it
//! with `--release`: code without optimisation is slow.
//!
//! # Reading a grid
//!
//! A grid holds the samples of a window row by row from the north-west corner: `tile[(i, j)]` is column `i` from the
//! west and row `j` from the north, and `tile.data()[j * tile.width() + i]` is the same sample. [`Window::east`] and
//! [`Window::south`] tell its position in metres from the origin of the world. Heights are `f32` metres; samples
//! without a value, such as those of a file with gaps, are NaN.
//!
//! ```
//! use orogen::{Window, World};
//!
//! let world = World::open(orogen::presets::find("hills").ok_or("no such preset")?.recipe()?)?;
//! let grid = world.window("height", &Window::new(4, 3, 30.0).at(100, 50))?;
//! for (row, j) in grid.data().chunks(grid.width()).zip(0..) {
//!     for (height, i) in row.iter().zip(0..) {
//!         let (east, south) = (grid.window().east(i), grid.window().south(j));
//!         assert_eq!((east, south), (30.0 * (100 + i) as f64, 30.0 * (50 + j) as f64));
//!         assert_eq!(*height, grid[(i, j)]);
//!     }
//! }
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # Locality
//!
//! Ops have one of three localities. A **field** depends on one position and the seed (noise, curves, warps). A
//! **filter** depends on a finite halo (blur, slope). A **solver** depends on the whole bounded world and runs once
//! (normalise, bake). Therefore any tile equals the crop of the whole, bit for bit, for any tile size, number of
//! threads, SIMD level and machine.
//!
//! # Where to look
//!
//! | task | entry point |
//! |---|---|
//! | build a recipe in code | [`Recipe`], [`WorldSpec`], and the ops in [`field`], [`filter`] and [`solver`] ([`node::Node::all`] lists them) |
//! | start from a recipe of the library | [`presets`] |
//! | many points or small windows | [`Sampler`] |
//! | a layer in space, such as caves | [`World::volume`], [`Sampler::fill_volume`] |
//! | terrain around a moving viewer | [`Chunks`], [`LodConfig`] |
//! | trees, rocks and other objects | [`World::objects`] |
//! | chunks of blocks, with caves and overhangs | [`blocks::land::Land`] |
//! | a large area in tiles or rows | [`World::tiles`], [`bands`] |
//! | several worlds with shared threads, memory and solutions | [`Session`] |
//! | previews on a graphics card | `gpu::WithGpu`, with the feature `gpu` |
//! | ops of your own | [`op!`], [`Registry`], and [`laws`], which tests them |
//! | files and pictures of grids | [`mod@format`], [`export`], [`map`], [`palette`], [`mesh`], [`render`], [`sheet`] |
//! | lines and areas drawn on a map | [`polylines`], and the ops `path` and `polygon` |
//! | terrain analysis, hydrology and erosion on any grid | [`analysis`], [`hydrology`], [`hydrography`], [`erosion`], [`contour`] |
//!
//! Structs with options are built with `new` or `Default` and `with_*` methods, so that later versions can add options.
//! Ops are plain structs; write `..Default::default()` after the parameters that you set. Noises without recipes are in
//! the crate `orogen-noise`.
#![forbid(unsafe_code)]

#[doc(inline)]
pub use orogen_engine::{
    bands, budget, choice, chunks, declare, expression, field, filter, growth, ids, laws, layer, node, objects, op,
    plan, recipe, registered, registry, sampler, session, solver, store, tiles, value, volume, world,
};
#[doc(hidden)]
pub use orogen_engine::{device, device_choice, lower};
/// Windows on a graphics card, for previews (feature `gpu`).
#[cfg(feature = "gpu")]
#[doc(inline)]
pub use orogen_gpu as gpu;
#[doc(hidden)]
pub use orogen_grid::parallel;
#[doc(inline)]
pub use orogen_grid::{
    aggregate, analysis, autotile, climate, contour, erosion, error, grid, hydrography, hydrology, poisson_discs,
    polylines, progress, resample, surface_nets, triangles, words,
};
#[doc(hidden)]
pub use orogen_io::test_folder;
#[doc(inline)]
pub use orogen_io::{dem, file, format, open, palette, raster, read_at, spool};
#[doc(hidden)]
pub use orogen_jobs::graph_layout;
#[doc(inline)]
pub use orogen_jobs::{builder, export, fit, jobs, options, tilemap};
#[doc(hidden)]
pub use orogen_output::noise_pictures;
#[doc(inline)]
pub use orogen_output::{blocks, map, mesh, render, sheet, survey};

pub use budget::Budget;
pub use chunks::id::ChunkId;
pub use chunks::lod::LodConfig;
pub use chunks::stream::{ChunkStep, Chunks};
pub use error::{Error, ErrorKind, Result};
pub use grid::{Grid, Window};
pub use objects::Object;
/// The SIMD level that computes noise, and how to select one. The results are bit-identical at all levels.
pub use orogen_noise::Level;
/// The positions where a field is evaluated.
pub use orogen_noise::Points;
pub use progress::Progress;
pub use recipe::document::{Recipe, WorldSpec};
pub use recipe::presets;
pub use registry::Registry;
pub use sampler::Sampler;
pub use session::{Options, Session};
pub use store::folder::FolderStore;
pub use store::memory::MemoryStore;
pub use store::solution_store::SolutionStore;
pub use volume::Volume;
pub use words::nearest;
pub use world::World;
