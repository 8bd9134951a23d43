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

#[doc(hidden)]
pub mod adaptive;
#[doc(hidden)]
pub mod body;
mod border;
mod bounds;
mod cavity;
mod clip;
mod engraving;
#[doc(hidden)]
pub mod glb;
mod globe;
mod monotone;
#[doc(hidden)]
pub mod normal_map;
#[doc(hidden)]
pub mod obj;
#[doc(hidden)]
pub mod objects;
mod outline;
mod packed;
#[doc(hidden)]
pub mod ply;
#[doc(hidden)]
pub mod quantized;
#[doc(hidden)]
pub mod relief;
mod sample_set;
mod scale;
mod scan;
#[doc(hidden)]
pub mod shape;
#[doc(hidden)]
pub mod solid;
#[doc(hidden)]
pub mod stl;
#[doc(hidden)]
pub mod surface;
#[doc(hidden)]
pub mod three_mf;
mod tile;
mod tin;
mod wall_text;
#[doc(hidden)]
pub mod water;

pub use adaptive::adaptive;
pub use body::BodyMesh;
pub use glb::Model;
pub use shape::Shape;
pub use solid::Solid;
pub use surface::Surface;
