//! Terrain analysis, hydrology and erosion on grids of heights, with the same bits on every machine, SIMD level and
//! thread count.
//!
//! A [`Grid`] is a rectangle of `f32` samples over a [`Window`]: sample (i, j) is at ((x + i) cell, (y + j) cell) in
//! metres, with x to the east and y to the south. NaN marks a sample without a value. All functions depend only on
//! their arguments: no files, no network, no clock.
//!
//! Option structs such as [`erosion::droplets::Droplets`] are built from `new` or `Default` and `with_*` methods.
//!
//! | module | what it computes |
//! |---|---|
//! | [`analysis`] | slope, aspect, curvature, roughness, geomorphons, hillshade, shadows, insolation, viewsheds, distances, hypsometry, spectra |
//! | [`hydrology`] | depressions (filled, breached, carved), D8 and D-infinity receivers, drainage areas, lakes, watersheds, stream power |
//! | [`hydrography`] | rivers, lakes, coasts and summits as points, lines and areas |
//! | [`erosion`] | thermal erosion, virtual pipes, droplets, local stream power |
//! | [`multiscale`] | eroded terrain without bounds, level by level: continents with rivers |
//! | [`climate`] | temperature, orographic rain, evapotranspiration, classes of climates and biomes |
//! | [`contour`] | contour lines, smoothed |
//! | [`autotile`] | tilemaps: terrain classes, tiles that fit their neighbors, clean-up |
//! | [`aggregate`] | diffusion-limited aggregation, and mountains from it |
//! | [`resample`] | interpolation between samples |
//! | [`triangles`] | heights on the triangles of a full mesh |
//!  [`poisson_discs`] | points with a minimum distance; each window is computed independently of the others |
//! | [`polylines`] | lines and areas of straight segments and curves: smoothing, the nearest point, inside or outside |
//!
//! ```
//! use orogen_grid::hydrology::accumulation::accumulate;
//! use orogen_grid::hydrology::drainage::route_carving;
//! use orogen_grid::hydrology::{fill::fill, outlets::Outlets, steepest::Descent};
//! use orogen_grid::{Grid, Window};
//!
//! // A bowl of 7 x 7 samples, 10 m apart, its rim at 4 m with a notch at 3 m.
//! let mut bowl = Grid::filled(Window::new(7, 7, 10.0), 4.0);
//! for j in 2..5 {
//!     bowl.row_mut(j)[2..5].fill(1.0);
//! }
//! bowl.row_mut(1)[3] = 3.0;
//! bowl.row_mut(0)[3] = 2.0;
//! let outlets = Outlets::new(&bowl, None);
//! assert_eq!(fill(&bowl, &outlets).row(3), [4.0, 4.0, 3.0, 3.0, 3.0, 4.0, 4.0]);
//!
//! // The 25 cells inside the border drain through the notch.
//! let drained = accumulate(&route_carving(&bowl, &outlets, Descent::Steepest).receivers);
//! assert_eq!(drained.area[(3, 0)], 26);
//! ```
//!
//! # Features
//!
//! | feature | what it adds |
//! |---|---|
//! | `ndarray` | grids to and from arrays of `ndarray`: `ArrayView2::from(&grid)`, `Array2::from(grid)`, `Grid::from_array` |
//! | `image` | grids to and from buffers of `image`: `Grid::into_image`, `from_image`, and in 16 bits `to_image16`, `from_image16` |
//! | `mint` | positions of samples and sizes as types of `mint`: `Window::point`, `Window::corners`, `Window::size` |
//!
//! All features are off by default. Grids and windows implement `Serialize` and `Deserialize` of `serde` without a
//! feature.
//!
//! The crate `orogen` is the terrain engine that uses this crate: recipes, tiles of any size, files, maps and meshes.
#![forbid(unsafe_code)]

pub mod aggregate;
pub mod analysis;
pub mod autotile;
mod checks;
pub mod climate;
#[doc(hidden)]
pub mod coast;
pub mod contour;
#[doc(hidden)]
pub mod craters;
#[doc(hidden)]
pub mod dolines;
#[doc(hidden)]
pub mod dunes;
pub mod erosion;
pub mod error;
#[doc(hidden)]
pub mod exemplar;
#[doc(hidden)]
pub mod glaciation;
pub mod grid;
#[doc(hidden)]
pub mod hex;
pub mod hydrography;
pub mod hydrology;
mod interop;
#[doc(hidden)]
pub mod lava;
#[doc(hidden)]
pub mod learned;
#[doc(hidden)]
pub mod meanders;
#[doc(hidden)]
pub mod multiscale;
#[doc(hidden)]
pub mod parallel;
#[doc(hidden)]
pub mod placement;
pub mod poisson_discs;
pub mod polylines;
pub mod progress;
#[doc(hidden)]
pub mod random;
pub mod resample;
#[doc(hidden)]
pub mod roads;
#[doc(hidden)]
pub mod scattered;
#[doc(hidden)]
pub mod strata;
#[doc(hidden)]
pub mod surface_nets;
pub mod triangles;
pub mod words;

pub use error::{Error, ErrorKind, Result};
pub use grid::{Grid, Window};
pub use progress::Progress;
