//! Noises whose tables are computed once.

use crate::methods::{self, noise_methods};
use crate::points::{Depth, LengthMismatch, Points};
use crate::program::Program;
use crate::shader::function::Shader;

/// A noise whose tables of octaves are computed once for many calls.
///
/// Every call of [`Fractal::sample`](crate::Fractal::sample) or [`fill`](crate::Fractal::fill) first derives the
/// octaves' seeds, offsets and amplitudes from the fields of the noise. In a prepared noise this is already done. It
/// has the same methods and returns the same bits. Single points and small blocks are faster, large grids are not.
///
/// Any noise is prepared with its method [`prepare`](crate::Fractal::prepare). A prepared noise is immutable, so any
/// number of threads can use it at the same time. It takes about 12 KiB on the heap. If the noise has no gradient, the
/// methods `*_with_gradient` write zeros.
///
/// ```
/// use orogen_noise::{Fractal, Points};
///
/// let hills = Fractal::new(7, 500.0);
/// let prepared = hills.prepare();
/// assert_eq!(prepared.sample(50.0, 30.0), hills.sample(50.0, 30.0));
///
/// // From two threads, with tables computed once.
/// let row = |y: f64| {
///     let (xs, mut heights) = ([0.0, 10.0, 20.0], [0.0; 3]);
///     prepared.fill(&Points::Lattice { xs: &xs, ys: &[y] }, &mut heights).map(|()| heights)
/// };
/// let rows = std::thread::scope(|scope| [0.0, 10.0].map(|y| scope.spawn(move || row(y))).map(|thread| thread.join()));
/// assert_eq!(rows.len(), 2);
/// ```
#[derive(Clone, Debug)]
pub struct Prepared {
    /// The noise in two, three and four dimensions.
    programs: Box<[Program; 3]>,
}

impl Prepared {
    pub(crate) fn new(programs: [Program; 3]) -> Prepared {
        Prepared { programs: Box::new(programs) }
    }
    pub(crate) fn program(&self, dims: usize) -> &Program {
        &self.programs[dims.clamp(2, 4) - 2]
    }
}

noise_methods!(Prepared);

/// A noise in a fixed number of dimensions, with its tables computed once.
#[doc(hidden)]
#[derive(Clone, Debug)]
pub struct PreparedIn(pub(crate) Program);

impl PreparedIn {
    /// The values at the points. `depths` has a depth for each dimension beyond the second.
    ///
    /// # Errors
    /// A slice does not have the same length as the points. Nothing is written then.
    pub fn fill(&self, points: &Points, depths: &[Depth], value: &mut [f32]) -> Result<(), LengthMismatch> {
        methods::fill(&self.0, points, depths, value, None)
    }

    /// A noise in the plane as a WGSL function, for GPUs.
    #[must_use]
    pub fn shader(&self) -> Shader {
        self.0.shader()
    }
}

/// Defines `prepare` and `prepare_in` of a noise that does not repeat.
macro_rules! preparable {
    ($noise:ident) => {
        impl $noise {
            /// The noise in a fixed number of dimensions, with its tables computed once.
            #[doc(hidden)]
            #[must_use]
            pub fn prepare_in(&self, dimensions: usize) -> $crate::PreparedIn {
                $crate::PreparedIn(self.program(dimensions))
            }

            /// The noise with its tables computed once. It has the same methods and bits, and does less work per call.
            #[must_use]
            pub fn prepare(&self) -> $crate::Prepared {
                $crate::Prepared::new([self.program(2), self.program(3), self.program(4)])
            }
        }
    };
}
pub(crate) use preparable;
