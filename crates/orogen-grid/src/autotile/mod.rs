//! Tilemaps: terrain classes of cells, the tiles that fit their neighbors, and changes of classes where no tile fits.
//!
//! Classes are ordered. A tilemap draws one layer for each class, over the layers of the previous classes. The layer of
//! a class covers the cells of this class and of all later ones, so each layer needs only tiles for "covered or not"
//! ([`mask`]), and any number of classes can meet without tiles for every pair.
//!
//! ```
//! use orogen_grid::Progress;
//! use orogen_grid::autotile::{classes::Classes, clean::clean, drawable::Drawable, mask::Layout};
//!
//! // A set without the tile for a single cell.
//! let masks: Vec<u8> = Layout::Blob.masks().into_iter().filter(|mask| *mask != 0).collect();
//! let drawable = Drawable::new(Layout::Blob, [masks.as_slice()]);
//! let mut classes = Classes::new([0, 0], 3, 3, vec![0, 0, 0, 0, 1, 0, 0, 0, 0]);
//! assert_eq!(drawable.gaps(&classes).len(), 1);
//! clean(&mut classes, &drawable, &Progress::none())?;
//! assert!(drawable.gaps(&classes).is_empty());
//! # Ok::<(), orogen_grid::Error>(())
//! ```

#[doc(hidden)]
pub mod choose;
#[doc(hidden)]
pub mod classes;
#[doc(hidden)]
pub mod clean;
#[doc(hidden)]
pub mod drawable;
#[doc(hidden)]
pub mod flip;
#[doc(hidden)]
pub mod mask;
#[doc(hidden)]
pub mod rule;
mod variants;

pub use choose::{ClassTiles, Tiles, WangTiles};
pub use classes::Classes;
pub use clean::clean;
pub use drawable::Drawable;
#[doc(hidden)]
pub use drawable::{Gap, MissingTile};
pub use flip::{Flip, Flips};
pub use mask::Layout;
#[doc(hidden)]
pub use rule::Pattern;
#[doc(hidden)]
pub use variants::Variant;

#[cfg(test)]
mod tests;
