//! Tilemaps: terrain classes of cells, the tiles that fit their neighbors, and changes of classes where no tile fits.
//!
//! Classes are ordered: a tilemap draws one layer for each, over the layers of the classes before it. The layer of a
//! class covers the cells of this class and of all later ones, so each layer needs only tiles for "covered or not"
//! ([`mask`]), and classes of any number meet anywhere without tiles for every pair.
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

pub mod choose;
pub mod classes;
pub mod clean;
pub mod drawable;
pub mod flip;
pub mod mask;
pub mod rule;
mod variants;

#[cfg(test)]
mod tests;
