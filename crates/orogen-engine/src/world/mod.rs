//! Worlds, which are opened recipes, and requests to them: windows, points, tiles, bands, objects and volumes.

#[doc(hidden)]
pub mod bands;
#[doc(hidden)]
pub mod objects;
mod open;
mod requests;
#[doc(hidden)]
pub mod roads;
#[doc(hidden)]
pub mod sampler;
#[doc(hidden)]
pub mod session;
#[doc(hidden)]
pub mod tiles;
#[doc(hidden)]
pub mod view;
#[doc(hidden)]
pub mod volume;
mod windows;
#[allow(clippy::module_inception, reason = "the room is about worlds, the file about the one")]
mod world;

pub use crate::recipe::outputs::{HEIGHT, LAKES};
pub use bands::Bands;
pub use objects::Object;
pub use open::open;
pub use sampler::Sampler;
pub use session::{Options, Session};
pub use tiles::{Tile, Tiles, Tiling};
pub use volume::Volume;
pub use windows::{CELLS, check_cell};
pub use world::World;
