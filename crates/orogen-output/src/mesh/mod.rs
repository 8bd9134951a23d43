//! Triangle meshes over grids.
//!
//! A [`shape::Shape`] selects the samples of a grid that are vertices: all, every n-th, or the few that an [`adaptive`]
//! mesh needs. Formats write a [`surface::Surface`]: a grid, a shape, and its appearance.
//!
//! ```
//! use orogen_output::mesh::adaptive::adaptive;
//! use orogen_engine::{Window, World};
//!
//! let world = World::open(orogen_engine::presets::find("hills").ok_or("no such preset")?.recipe()?)?;
//! let grid = world.window("height", &Window::new(257, 257, 15.0))?;
//! let shape = adaptive(&grid, 2.0)?;
//! assert!(shape.triangles() < 256 * 256 * 2 / 10);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

pub mod adaptive;
pub mod body;
mod border;
mod bounds;
mod cavity;
mod clip;
mod engraving;
pub mod glb;
mod monotone;
#[doc(hidden)]
pub mod normal_map;
pub mod obj;
#[doc(hidden)]
pub mod objects;
mod outline;
mod packed;
pub mod ply;
#[doc(hidden)]
pub mod relief;
mod sample_set;
mod scale;
mod scan;
pub mod shape;
pub mod solid;
pub mod stl;
pub mod surface;
pub mod three_mf;
mod tile;
mod tin;
mod wall_text;
#[doc(hidden)]
pub mod water;
