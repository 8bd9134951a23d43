//! Coherent noise with analytic derivatives, bit for bit the same everywhere.
//!
//! ```
//! use orogen_noise::{Fractal, Points};
//!
//! // Hills 500 m apart, six octaves, over a lattice of 256 x 256 samples 10 m apart.
//! let hills = Fractal { seed: 7, wavelength: 500.0, ..Default::default() };
//! let xs: Vec<f64> = (0..256).map(|i| f64::from(i) * 10.0).collect();
//! let ys = xs.clone();
//! let mut heights = vec![0.0; xs.len() * ys.len()];
//! hills.fill(&Points::Lattice { xs: &xs, ys: &ys }, &mut heights)?;
//!
//! // The same point, asked alone, gives the same bits.
//! assert_eq!(heights[3 * 256 + 5], hills.sample(50.0, 30.0));
//! # Ok::<(), orogen_noise::LengthMismatch>(())
//! ```
//!
#![doc = include_str!("../docs/gallery.md")]
//!
//! A noise is a plain struct: [`White`], [`Value`], [`Perlin`], [`Classic`], [`Simplex`], [`OpenSimplex2`], [`Worley`], or a
//! [`Fractal`] over any [`Basis`]. Each has `sample` and `fill`, `fill_with_gradient` where it has slopes, and their counterparts in
//! three and four dimensions: `sample3`, `fill3`, `fill3_with_gradient`, `sample4` ... Positions and wavelengths are metres (or any unit
//! you like); values have no unit and lie in [-1, 1]. [`Phacelle`] draws stripes along directions of yours; a [`Warp`] moves places
//! before a noise is asked there.
//!
//! **The bits.** A value depends on the noise's parameters and the position, and on nothing else: not on the processor, the SIMD
//! level ([`Level`]), the build, how the points are given ([`Points`]) or cut into calls.
//!
//! **Without a seam.** Each noise has a `tiled` variant that repeats after whole numbers of cells: see [`Tiled`].
//!
//! **Far away.** Positions are f64; each octave splits them into a whole cell and a fraction before anything is rounded to f32, so
//! noise at 1e9 m is as smooth as at 0. Positions beyond 2^50 cells of the finest octave (2^47 on lattices of
//! simplices) are held there; so are infinite ones, and NaN counts as the lower end. The result is always finite.
//!
//! **Octave coordinates.** Octave i looks at `x * lacunarity^i / wavelength + offset`, in f64 and in this order.

#![forbid(unsafe_code)]

mod basis;
mod choices;
mod classic;
mod fractal;
mod kernel;
mod methods;
mod open_simplex2;
mod perlin;
mod phacelle;
mod points;
mod program;
mod seed;
mod simplex;
mod tables;
#[cfg(test)]
mod tests;
mod tiled;
mod value;
mod warp;
mod white;
mod worley;

pub use basis::Basis;
pub use choices::{ClassicVariant, Distance, Fade, Falloff, Feature, Kind, Smoothness};
pub use classic::Classic;
pub use fractal::Fractal;
pub use open_simplex2::OpenSimplex2;
pub use orogen_simd::{Level, LevelError};
pub use perlin::Perlin;
pub use phacelle::Phacelle;
pub use points::{Depth, LengthMismatch, Points};
pub use program::{MAX_OCTAVES, TileError};
pub use simplex::Simplex;
pub use tiled::{Period, Tiled};
pub use value::Value;
pub use warp::{Warp, WarpKind};
pub use white::White;
pub use worley::Worley;
