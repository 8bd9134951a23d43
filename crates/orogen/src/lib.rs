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
//! assert_eq!(tile.get(10, 20), world.height(tile.window().east(10), tile.window().south(20))?);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! Ops have one of three localities. A **field** depends on one position and the seed (noise, curves, warps). A
//! **filter** depends on a finite halo (blur, slope). A **solver** depends on the whole bounded world and runs once
//! (normalise, bake). Therefore any tile equals the crop of the whole, bit for bit, for any tile size, number of
//! threads, SIMD level and machine.
//!
//! Further entry points: [`Recipe`] also builds a world in code; a [`Sampler`] is fast for many requests; [`Chunks`]
//! follow a viewer; [`node::Node::all`] lists the ops; [`presets`] are the built-in recipes; [`mod@format`], [`map`]
//! and [`palette`] make files and pictures of grids.
#![forbid(unsafe_code)]

#[macro_use]
pub mod declare;

pub mod aggregate;
pub mod analysis;
pub mod bands;
pub mod budget;
pub mod builder;
pub mod chunks;
pub mod contour;
pub mod dem;
mod engine;
pub mod erosion;
pub mod error;
pub mod export;
pub mod expression;
pub mod field;
pub mod file;
pub mod filter;
pub mod fit;
pub mod format;
#[cfg(test)]
mod full_disk;
pub mod grid;
pub mod growth;
pub mod hydrography;
pub mod hydrology;
mod large;
pub mod layer;
pub mod map;
pub mod mesh;
pub mod node;
pub mod op;
pub mod open;
mod pages;
pub mod palette;
pub mod plan;
mod pool;
pub mod progress;
pub mod raster;
pub mod recipe;
pub mod render;
pub mod resample;
pub mod sampler;
pub mod session;
pub mod sheet;
pub mod solver;
pub mod spool;
pub mod store;
pub mod survey;
pub mod tiles;
pub mod value;
pub mod words;
pub mod world;

pub use budget::Budget;
pub use chunks::id::ChunkId;
pub use chunks::lod::LodConfig;
pub use chunks::stream::{ChunkStep, Chunks};
pub use error::{Error, ErrorKind, Result};
pub use grid::{Grid, Window};
/// The SIMD level that computes noise, and how to select one. The results are bit-identical at all levels.
pub use orogen_noise::Level;
/// The positions where a field is evaluated.
pub use orogen_noise::Points;
pub use progress::Progress;
pub use recipe::document::{Recipe, WorldSpec};
pub use recipe::presets;
pub use sampler::Sampler;
pub use session::{Options, Session};
pub use store::cache::Cache;
pub use words::nearest;
pub use world::World;
