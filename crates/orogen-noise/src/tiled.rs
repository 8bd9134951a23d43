//! Noise that repeats.

use crate::methods::noise_methods;
use crate::program::{Program, Untileable};

/// A noise whose lattice closes on itself, so that copies of a square of it lie side by side without a seam. Made by `tiled` of
/// the noise it repeats, which it resembles; it has the same methods, speed, range and gradients.
///
/// A period is a whole number of cells of the first octave: along an axis with period p and wavelength w the noise repeats every
/// p * w metres. Every other octave needs a whole number of its own cells in there, so the lacunarity is a whole number (or the
/// period makes up for its fraction).
///
/// Both sides of a seam are equal to the bit. To make them so in spite of rounding, positions are rounded to 2^-24 of a cell; that
/// holds where a period of n samples lies within 2^26 / n cells of the origin, counted in the finest octave. Positions beyond 2^27
/// of those cells are held there.
///
/// ```
/// use orogen_noise::{Fractal, Points};
///
/// // Repeats every 4 wavelengths of 100 m.
/// let hills = Fractal { wavelength: 100.0, ..Default::default() }.tiled([4, 4, 0])?;
/// assert_eq!(hills.sample(12.5, 70.0), hills.sample(412.5, -330.0));
///
/// // The second octave would need 6.4 cells in the same place.
/// let odd = Fractal { lacunarity: 1.6, ..Default::default() };
/// assert_eq!(odd.tiled([4, 4, 0]).unwrap_err().octave, 1);
/// # Ok::<(), orogen_noise::Untileable>(())
/// ```
#[derive(Clone, Debug)]
pub struct Tiled {
    plane: Program,
    space: Program,
}

impl Tiled {
    pub(crate) fn new(plane: Program, space: Program, period: [u32; 3]) -> Result<Tiled, Untileable> {
        Ok(Tiled { plane: plane.tiled(period)?, space: space.tiled(period)? })
    }
    pub(crate) fn program(&self) -> Program {
        self.plane
    }
    pub(crate) fn program3(&self) -> Program {
        self.space
    }
}

noise_methods!(Tiled);

/// The way from a noise to one that repeats.
macro_rules! tileable {
    ($noise:ident) => {
        impl $noise {
            /// The noise on a lattice that repeats after `period` cells of the first octave along x, y and z; 0 where it need not.
            ///
            /// # Errors
            /// An octave does not fit: see [`Tiled`](crate::Tiled).
            pub fn tiled(&self, period: [u32; 3]) -> Result<$crate::Tiled, $crate::Untileable> {
                $crate::tiled::Tiled::new(self.program(), self.program3(), period)
            }
        }
    };
}
pub(crate) use tileable;
