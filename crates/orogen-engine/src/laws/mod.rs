//! Laws: properties that every op must have, tested for one op. They apply to built-in ops and to ops of programs.
//!
//! | law | statement |
//! |---|---|
//! | [`Law::TileEqualsCrop`] | a tile has the bits of the crop of the whole, for any size, offset and number of threads, with a new or a filled store; a point has the bits of the sample at its position |
//! | [`Law::Finite`] | finite inputs give finite results |
//! | [`Law::Levels`] | every SIMD level gives the same bits |
//! | [`Law::Stored`] | solutions on disk, and sources computed in tiles of any size, change no bit |
//! | [`Law::Warped`] | a tile equals the crop if a warp and a rotation read the op, and a warp by 0 changes no bit |
//! | [`Law::Unbounded`] | a tile equals the crop at large and at negative positions |
//! | [`Law::Resolutions`] | a field has the same bits where the samples of two cells coincide |
//! | [`Law::Altitudes`] | in space a part of a volume has the bits of the whole, at every SIMD level, and the slice at altitude 0 is the plane, if the inputs of a field depend on the altitude |
//! | [`Law::ContentKeys`] | every change of the world that changes samples changes the content key |
//! | [`Law::Margin`] | a solver's margin obeys tile == crop, also beyond the world, changes no bit on disk, and is part of the content key |
//! | [`Law::Cancel`] | work stops within [`LONGEST_CANCEL`] after a request to cancel |
//!
//! ```
//! use orogen_engine::filter::Blur;
//! use orogen_engine::laws::Laws;
//!
//! let violations = Laws::of(|cell| Blur { radius: 2.5 * cell, ..Blur::default() }).check();
//! assert!(violations.is_empty(), "{violations:#?}");
//! ```

mod altitudes;
mod case;
mod check;
mod forced;
mod law;
mod recipes;

pub use check::{CELLS, Laws};
#[doc(hidden)]
pub use forced::at_level;
pub use law::{LONGEST_CANCEL, Law, Verdict, Violation};
pub use recipes::{NODE, recipe_of, world_of};
