//! Coherent noise with analytic derivatives and the same bits on every machine.
//!
//! ```
//! use orogen_noise::{Fractal, Points};
//!
//! // Hills about 500 m apart, six octaves, on a lattice of 256 x 256 samples 10 m apart.
//! let hills = Fractal::new(7, 500.0);
//! let xs: Vec<f64> = (0..256).map(|i| f64::from(i) * 10.0).collect();
//! let ys = xs.clone();
//! let mut heights = vec![0.0; xs.len() * ys.len()];
//! hills.fill(&Points::Lattice { xs: &xs, ys: &ys }, &mut heights)?;
//!
//! // A single point has the same bits.
//! assert_eq!(heights[3 * 256 + 5], hills.sample(50.0, 30.0));
//! # Ok::<(), orogen_noise::LengthMismatch>(())
//! ```
//!
#![doc = include_str!("../docs/gallery.md")]
//!
//! A noise is a plain struct: [`White`], [`Value`], [`Perlin`], [`Classic`], [`Simplex`], [`OpenSimplex2`], [`Worley`],
//! or a [`Fractal`] over any [`Basis`]. `new` takes its seed and wavelength, and `with_*` methods set the other fields.
//! Each noise has `sample` and `fill`, `fill_with_gradient` if it has a gradient, and the same methods in three and
//! four dimensions: `sample3`, `fill3`, `fill3_with_gradient`, `sample4` and so on. Positions and wavelengths are in
//! metres, or in any other unit of length. Values have no unit and are in -1 ..= 1. [`Phacelle`] noise gives stripes
//! along given directions. A [`Warp`] displaces positions before another noise is evaluated there.
//!
//! **Many small calls.** `prepare` computes the tables of a noise once for many calls, which can come from any thread
//! (see [`Prepared`]).
//!
//! **Determinism.** A value depends only on the parameters of the noise and on the position. It does not depend on the
//! processor, the SIMD level ([`Level`]), the build, the form of the points ([`Points`]) or their division into calls.
//!
//! **Seamless tiles.** Most noises have a method `tiled`, which makes them repeat after an integer number of cells (see
//! [`Tiled`]).
//!
//! **Large coordinates.** Positions are f64. Each octave splits them into an integer cell and a fraction before it
//! rounds to f32, so noise at 1e9 m is as smooth as at 0. Positions beyond 2^50 cells of the finest octave (2^47 for
//! Simplex and OpenSimplex2) are clamped, including infinite ones. NaN counts as the lower end. The result is always
//! finite.
//!
//! **Octave coordinates.** Octave i is evaluated at `x * lacunarity^i / wavelength + offset`, in f64 and in this order.

#![forbid(unsafe_code)]

mod basis;
mod builder;
mod choices;
mod classic;
mod fractal;
#[doc(hidden)]
pub mod internals;
mod kernel;
mod methods;
mod open_simplex2;
mod perlin;
mod phacelle;
mod points;
mod prepared;
mod program;
mod seed;
#[doc(hidden)]
pub mod shader;
mod simplex;
mod tables;
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
pub use phacelle::{Phacelle, PreparedPhacelle};
pub use points::{Depth, LengthMismatch, Points};
pub use prepared::Prepared;
#[doc(hidden)]
pub use prepared::PreparedIn;
pub use program::{MAX_OCTAVES, TileError};
pub use simplex::Simplex;
pub use tiled::{Period, Tiled};
pub use value::Value;
pub use warp::{PreparedWarp, Warp, WarpKind};
pub use white::White;
pub use worley::Worley;
