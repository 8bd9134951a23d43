//! Lines and areas that consist of straight segments: smoothed, flattened, and searched by position.
//!
//! - [`outline`]: lines of straight pieces and cubic curves; smoothing
//! - [`cubic`]: cubic Bézier curves and their approximation by straight segments
//! - [`segments`]: all segments of a drawing in a tree of boxes: finds the segment nearest to a position, and whether a
//!   position is inside
//! - [`buffers`]: lines with a distance around each: finds those that contain a position
//!
//! ```
//! use orogen_grid::polylines::{outline::Outline, segments::Segments};
//!
//! let square = Outline::of_points(&[[0.0, 0.0, 5.0], [10.0, 0.0, 5.0], [10.0, 10.0, 5.0], [0.0, 10.0, 5.0]]).closed();
//! let segments = Segments::new(&[square], 0.1);
//! assert!(segments.is_inside([5.0, 3.0]) && !segments.is_inside([5.0, -3.0]));
//! let nearest = segments.nearest([5.0, -3.0], f64::INFINITY).ok_or("there are no segments")?;
//! assert_eq!((nearest.distance(), nearest.height(), nearest.chainage()), (3.0, 5.0, 5.0));
//! # Ok::<(), &str>(())
//! ```

#[doc(hidden)]
pub mod buffers;
#[doc(hidden)]
pub mod cubic;
#[doc(hidden)]
pub mod outline;
#[doc(hidden)]
pub mod segments;

#[doc(hidden)]
pub use buffers::Buffers;
#[doc(hidden)]
pub use cubic::Cubic;
pub use outline::Outline;
pub use segments::{Nearest, Segments};
