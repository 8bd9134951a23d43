//! Perlin's gradient noise over a hashed lattice.

use crate::builder::noise_builder;
use crate::kernel::near::FillAround;
use crate::methods::noise_methods;
use crate::points::LengthMismatch;
use crate::prepared::preparable;
use crate::program::{Program, Source};
use crate::tiled::tileable;
use orogen_simd::dispatch;

/// Perlin's improved gradient noise. Gradients are hashed from 64-bit cell numbers instead of a table of 256 entries,
/// so the noise never repeats, and every seed gives a different noise.
///
/// All gradients have the same length. In 2D there are 16 directions, 11.25 + 22.5 k degrees; none lies along an axis
/// or a diagonal. In 3D there are 32: the corners and face centers of an icosahedron. The result is scaled to a maximum
/// of 1: the raw noise reaches .695353 in 2D, at (.5, .5266) in a cell, and sqrt(3/4) in 3D, in the center of a cell.
///
/// Range: -1 ..= 1. Zero mean; zero at every lattice point. Its gradient is exact.
///
/// K. Perlin, "Improving noise", SIGGRAPH 2002.
///
/// ```
/// let noise = orogen_noise::Perlin::new(7, 100.0);
/// assert_eq!(noise.sample(200.0, -300.0), 0.0);
/// assert!(noise.sample(250.0, -250.0).abs() <= 1.0);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Perlin {
    /// Any number; neighboring seeds give unrelated noise. Default 0.
    pub seed: u64,
    /// Distance between lattice points, in metres. Default 1.
    pub wavelength: f64,
}

impl Default for Perlin {
    fn default() -> Perlin {
        Perlin { seed: 0, wavelength: 1.0 }
    }
}

noise_builder!(Perlin);

impl Perlin {
    pub(crate) fn program(&self, _: usize) -> Program {
        Program::single(Source::Perlin, self.seed, self.wavelength)
    }

    /// The values at points around an origin, in f32: sample k is at `(origin.0 + x[k], origin.1 + y[k])`, in metres.
    /// This is faster than [`fill`](Self::fill) at scattered points, in particular if they are within 16 cells along
    /// each axis.
    ///
    /// The origin can be any position. Coordinates are relative to the corner of its cell and exact to about 2^-24 of
    /// the distance to that corner. Therefore the bits differ from those of `fill` and depend on the origin. They do
    /// not depend on the SIMD level. Coordinates are clamped to 2^30 wavelengths around that corner; NaN counts as the
    /// lower end.
    ///
    /// # Errors
    /// The slices have different lengths. Nothing is written then.
    ///
    /// ```
    /// let noise = orogen_noise::Perlin::new(7, 100.0);
    /// let mut value = [0.0; 2];
    /// noise.fill_around((2e9, -3e9), &[50.0, -20.0], &[10.0, 0.0], &mut value)?;
    /// assert!((value[1] - noise.sample(2e9 - 20.0, -3e9)).abs() < 1e-6);
    /// # Ok::<(), orogen_noise::LengthMismatch>(())
    /// ```
    pub fn fill_around(
        &self,
        origin: (f64, f64),
        x: &[f32],
        y: &[f32],
        value: &mut [f32],
    ) -> Result<(), LengthMismatch> {
        LengthMismatch::check("y", y.len(), x.len())?;
        LengthMismatch::check("value", value.len(), x.len())?;
        dispatch(FillAround { program: &self.program(2), origin: [origin.0, origin.1], at: [x, y], value });
        Ok(())
    }
}

noise_methods!(Perlin);
preparable!(Perlin);
tileable!(Perlin);
