//! The engine of Orogen: a recipe describes a world, and the engine computes any window of it at any resolution, with
//! the same bits on every machine.
//!
//! Programs usually depend on the crate `orogen`, which combines this engine with files, maps and meshes. This crate
//! alone is for programs that want terrain and write no files.
//!
//! ```
//! use orogen_engine::Window;
//!
//! let world = orogen_engine::open("hills")?;
//! let tile = world.window("height", &Window::new(64, 64, 30.0).at(100, 50))?;
//! assert_eq!(tile[(10, 20)], world.height(tile.window().east(10), tile.window().south(20))?);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
#![forbid(unsafe_code)]

pub mod chunks;
#[doc(hidden)]
pub mod device;
#[doc(hidden)]
pub mod device_choice;
mod engine;
pub mod growth;
pub mod laws;
pub mod plan;
pub mod recipe;
pub mod registry;
pub mod store;
pub mod world;

#[doc(inline)]
pub use orogen_ops::{
    budget, choice, declare, expression, field, filter, layer, levelled, node, op, registered, solver, value,
};
#[doc(hidden)]
pub use orogen_ops::{ids, large, lower, pool};
#[doc(hidden)]
pub use world::{bands, objects, sampler, session, tiles, view, volume};

pub use budget::Budget;
pub use chunks::id::ChunkId;
pub use chunks::lod::LodConfig;
pub use chunks::stream::{ChunkStep, Chunks};
pub use orogen_grid::{Error, ErrorKind, Grid, Progress, Result, Window};
pub use orogen_io::raster::Raster;
pub use orogen_noise::Points;
pub use recipe::document::{Recipe, WorldSpec};
pub use recipe::presets;
pub use registry::Registry;
pub use store::folder::FolderStore;
pub use store::memory::MemoryStore;
pub use store::solution_store::SolutionStore;
pub use world::{Object, Options, Sampler, Session, Volume, World, open};
