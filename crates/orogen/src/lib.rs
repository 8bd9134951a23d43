//! Orogen, a procedural terrain engine: a recipe describes a world, and the engine makes any window of it, at any
//! resolution, always with the same bits.
//!
//! A [`Recipe`] is a document (TOML or JSON): a world with a seed and lengths in metres, named nodes, named outputs. A
//! [`World`] is an opened recipe. It returns a [`Grid`] of heights for a [`Window`] of a layer, and exactly the same
//! numbers for single points.
//!
//! A program in a folder next to a clone of Orogen depends on it with `cargo add orogen --path
//! ../orogen/crates/orogen`. Build it with `--release`: code without optimization is slow.
//!
//! # Five programs
//!
//! **A preset to a file.** [`open`] takes a preset, a recipe file or a file of heights. The extension of the file
//! determines its format.
//!
//! ```no_run
//! use orogen::{Export, Window};
//!
//! let world = orogen::open("alpine")?;
//! world.export("height", &Window::new(800, 600, 25.0).at(820, 930), "alpine.tif")?;
//! # Ok::<(), orogen::Error>(())
//! ```
//!
//! **The height at a point**, and the tile around it with the same bits.
//!
//! ```
//! use orogen::Window;
//!
//! let world = orogen::open("hills")?;
//! let tile = world.window("height", &Window::new(64, 64, 30.0).at(100, 50))?;
//! let (east, south) = (tile.window().east(10), tile.window().south(20));
//! assert_eq!(world.height(east, south)?, tile[(10, 20)]);
//! # Ok::<(), orogen::Error>(())
//! ```
//!
//! **Terrain around a moving viewer.** [`Chunks`] says which chunk to make or to drop next.
//!
//! ```
//! use orogen::{ChunkStep, LodConfig, Sampler};
//! use std::collections::HashMap;
//!
//! let world = orogen::open("hills")?;
//! let ground = Sampler::new(&world, "height")?;
//! let mut chunks = world.chunks(LodConfig::default().with_cells(32).with_levels(3).with_range(500.0))?;
//! let mut scene = HashMap::new();
//! chunks.set_viewer(10_000.0, 8_000.0)?;
//! while let Some(step) = chunks.next_step() {
//!     match step {
//!         ChunkStep::Make(id) => drop(scene.insert(id, ground.window(&chunks.window(id))?)),
//!         ChunkStep::Drop(id) => drop(scene.remove(&id)),
//!     }
//! }
//! # Ok::<(), orogen::Error>(())
//! ```
//!
//! **A recipe in code.** Ops are plain structs; write `..Default::default()` after the parameters that you set.
//!
//! ```
//! use orogen::field::{Fbm, Remap};
//! use orogen::{Recipe, Window, World, WorldSpec};
//!
//! let mut recipe = Recipe::new(WorldSpec::default().with_seed(7));
//! recipe
//!     .add("hills", Fbm { wavelength: 800.0, ..Fbm::default() })
//!     .add("land", Remap { source: "hills".into(), to: [0.0, 250.0], ..Remap::default() })
//!     .output("height", "land");
//! let heights = World::open(recipe)?.window("height", &Window::new(32, 32, 20.0))?;
//! # assert_eq!(heights.data().len(), 32 * 32);
//! # Ok::<(), orogen::Error>(())
//! ```
//!
//! **Erosion of your own heights.** Hydrology and erosion work on any grid.
//!
//! ```
//! use orogen::grid::erosion::Thermal;
//! use orogen::{Grid, Progress, Window};
//!
//! let heights = Grid::from_data(Window::new(3, 2, 10.0), vec![0.0, 9.0, 40.0, 1.0, 8.0, 44.0]).expect("6 samples");
//! let settled = Thermal::new(0.6).run(&heights.padded(25), 25, &Progress::none())?;
//! assert_eq!(settled.window(), heights.window());
//! # Ok::<(), orogen::Error>(())
//! ```
//!
//! # Reading a grid
//!
//! A grid holds the samples of a window row by row from the north-west corner: `tile[(i, j)]` is column `i` from the
//! west and row `j` from the north, and `tile.data()[j * tile.width() + i]` is the same sample. [`Window::east`] and
//! [`Window::south`] return its position in metres from the origin of the world. Heights are `f32` metres; samples
//! without a value, such as gaps of a file, are NaN.
//!
//! # Locality
//!
//! A **field** depends on one position and the seed (noise, curves, warps). A **filter** depends on a finite halo
//! (blur, slope). A **levelled** op depends on a finite halo of the next coarser level (`continents`, `amplify`). A
//! **solver** depends on the whole bounded world and runs once (stream power, drainage). Therefore any tile equals the
//! same part of the whole, bit for bit, for any tile size, number of threads, SIMD level and machine.
//!
//! # Where to look
//!
//! | task | entry point |
//! |---|---|
//! | build a recipe in code | [`Recipe`], [`WorldSpec`], and the ops in [`field`], [`filter`], [`levelled`] and [`solver`] ([`Node::all`] lists them) |
//! | start from a recipe of the library | [`presets`] |
//! | many points or small windows | [`Sampler`] |
//! | a layer in space, such as caves | [`World::volume`], [`Sampler::fill_volume`] |
//! | terrain around a moving viewer | [`Chunks`], [`LodConfig`] |
//! | trees, rocks and other objects | [`World::objects`] |
//! | chunks of blocks, with caves and overhangs | [`output::blocks::Land`] |
//! | a large area in tiles or rows | [`World::tiles`], [`Bands`] |
//! | several worlds with shared threads, memory and solutions | [`Session`] |
//! | files with options, progress or streams | [`export`], [`builder`] for large ones |
//! | maps, renders, blocks and tilemaps as files | [`jobs`], [`tilemap`] |
//! | maps, renders and meshes of your own | [`output`] |
//! | reading and writing formats, palettes | [`io`] |
//! | terrain analysis, hydrology, erosion, contours on any grid | [`grid`] |
//! | noise without recipes | [`noise`] |
//! | previews on a graphics card | `gpu::WithGpu`, with the feature `gpu` |
//! | files in S3 and other object stores | `remote::mount`, with the feature `remote` |
//! | ops of your own | [`op!`], [`Registry`], and [`laws`], which tests them |
//!
//! Structs with options are built with `new` or `Default` and `with_*` methods, so that later versions can add options.
#![forbid(unsafe_code)]

#[doc(hidden)]
pub use orogen_engine::{
    bands, device, device_choice, ids, lower, objects, pool, registry, sampler, session, tiles, view, volume, world,
};
#[doc(inline)]
pub use orogen_engine::{
    budget, choice, chunks, declare, expression, field, filter, growth, laws, layer, levelled, node, op, plan, recipe,
    registered, solver, store, value,
};
#[cfg(feature = "gpu")]
#[doc(inline)]
pub use orogen_gpu as gpu;
#[doc(inline)]
pub use orogen_grid as grid;
#[doc(inline)]
pub use orogen_io as io;
#[doc(hidden)]
pub use orogen_jobs::{author_map, graph_layout};
#[doc(inline)]
pub use orogen_jobs::{builder, export, fit, jobs, locate, options, tilemap};
#[doc(inline)]
pub use orogen_noise as noise;
#[doc(inline)]
pub use orogen_output as output;
#[cfg(feature = "remote")]
#[doc(inline)]
pub use orogen_remote as remote;

pub use budget::Budget;
pub use chunks::{ChunkId, ChunkStep, Chunks, LodConfig};
pub use export::Export;
pub use grid::{Error, ErrorKind, Grid, Progress, Result, Window};
pub use node::Node;
pub use noise::{Level, Points};
pub use orogen_engine::open;
pub use recipe::{Recipe, WorldSpec, presets};
pub use store::{FolderStore, MemoryStore, SolutionStore};

pub use bands::Bands;
pub use objects::Object;
pub use registry::Registry;
pub use sampler::Sampler;
pub use session::{Options, Session};
pub use tiles::{Tile, Tiles, Tiling};
pub use volume::Volume;
pub use world::World;
