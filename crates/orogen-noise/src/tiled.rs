//! Noise that repeats.

use crate::methods::noise_methods;
use crate::program::{Program, TileError};

/// A noise that repeats, so that copies of one period join without a seam. It is created with the method `tiled` of a
/// noise. It has the same methods, speed, range and gradients, and its tables are computed once, as in
/// [`Prepared`](crate::Prepared).
///
/// A period is an integer number of cells of the first octave: along an axis with period p and wavelength w the noise
/// repeats every p * w metres. Every other octave must also have an integer number of cells in the period. An integer
/// lacunarity always fits; other values fit some periods.
///
/// Both sides of a seam have the same bits. For this, positions are rounded to 2^-24 of a cell. With n samples per
/// period, the samples must be within 2^26 / n cells of the origin, counted in the finest octave. Positions beyond 2^27
/// of these cells are clamped.
///
/// ```
/// use orogen_noise::{Fractal, Points};
///
/// // Repeats every 4 wavelengths of 100 m.
/// let hills = Fractal::default().with_wavelength(100.0).tiled([4, 4])?;
/// assert_eq!(hills.sample(12.5, 70.0), hills.sample(412.5, -330.0));
///
/// // The second octave would need 6.4 cells in the period.
/// let odd = Fractal::default().with_lacunarity(1.6);
/// assert!(odd.tiled([4, 4]).unwrap_err().to_string().starts_with("octave 1 would have to repeat after 6.4 cells"));
/// # Ok::<(), orogen_noise::TileError>(())
/// ```
#[derive(Clone, Debug)]
pub struct Tiled {
    /// The noise in two, three and four dimensions.
    programs: [Program; 3],
}

/// The period along x, y, z and w in cells of the first octave; 0 along axes without a period. Arrays of two to four
/// numbers can be converted to it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub struct Period([u32; 4]);

impl From<[u32; 2]> for Period {
    fn from([x, y]: [u32; 2]) -> Period {
        Period([x, y, 0, 0])
    }
}

impl From<[u32; 3]> for Period {
    fn from([x, y, z]: [u32; 3]) -> Period {
        Period([x, y, z, 0])
    }
}

impl From<[u32; 4]> for Period {
    fn from(period: [u32; 4]) -> Period {
        Period(period)
    }
}

impl Tiled {
    pub(crate) fn new(programs: [Program; 3], period: Period) -> Result<Tiled, TileError> {
        let [plane, space, time] = programs;
        Ok(Tiled { programs: [plane.tiled(period.0)?, space.tiled(period.0)?, time.tiled(period.0)?] })
    }
    pub(crate) fn program(&self, dims: usize) -> &Program {
        &self.programs[dims.clamp(2, 4) - 2]
    }
}

noise_methods!(Tiled);

/// Defines `tiled`.
macro_rules! tileable {
    ($noise:ident) => {
        impl $noise {
            /// The noise with a period, in cells of the first octave along x, y, z and w: `[4, 4]`, `[4, 4, 2]` and so
            /// on; 0 along axes without a period.
            ///
            /// # Errors
            /// If an octave does not have an integer number of cells in the period, or if the noise is a simplex noise
            /// (see [`Tiled`](crate::Tiled)).
            pub fn tiled(&self, period: impl Into<$crate::Period>) -> Result<$crate::Tiled, $crate::TileError> {
                $crate::tiled::Tiled::new([self.program(2), self.program(3), self.program(4)], period.into())
            }
        }
    };
}
pub(crate) use tileable;
