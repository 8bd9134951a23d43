//! The methods every noise has, written once.

use crate::kernel::fill::Fill;
use crate::kernel::outputs::Outputs;
use crate::points::{Depth, Mismatch, Points};
use crate::program::Program;
use orogen_simd::{Level, LevelError, dispatch, dispatch_at};

/// Runs a program at the level in force. Slopes: two slices in 2D, three in 3D.
pub(crate) fn fill(
    program: &Program,
    points: &Points,
    depth: Option<&Depth>,
    value: &mut [f32],
    slopes: Option<[&mut [f32]; 3]>,
) -> Result<(), Mismatch> {
    check(points, depth, value, slopes.as_ref())?;
    dispatch(Fill { program, points: *points, depth: depth.copied(), outputs: Outputs { value, slopes } });
    Ok(())
}

/// Runs a program at a chosen level.
pub(crate) fn fill_at(
    level: Level,
    program: &Program,
    points: &Points,
    depth: Option<&Depth>,
    value: &mut [f32],
    slopes: Option<[&mut [f32]; 3]>,
) -> Result<Result<(), Mismatch>, LevelError> {
    if let Err(mismatch) = check(points, depth, value, slopes.as_ref()) {
        return Ok(Err(mismatch));
    }
    dispatch_at(level, Fill { program, points: *points, depth: depth.copied(), outputs: Outputs { value, slopes } })?;
    Ok(Ok(()))
}

fn check(
    points: &Points,
    depth: Option<&Depth>,
    value: &[f32],
    slopes: Option<&[&mut [f32]; 3]>,
) -> Result<(), Mismatch> {
    points.check()?;
    let check = |slice, length| Mismatch::check(slice, length, points.len());
    check("value", value.len())?;
    if let Some([dx, dy, dz]) = slopes {
        check("dx", dx.len())?;
        check("dy", dy.len())?;
        if depth.is_some() {
            check("dz", dz.len())?;
        }
    }
    if let Some(Depth::Each(z)) = depth {
        check("depth", z.len())?;
    }
    Ok(())
}

/// One sample.
pub(crate) fn sample(program: &Program, x: f64, y: f64, z: Option<f64>) -> f32 {
    let mut value = [0.0];
    let depth = z.map(Depth::Slice);
    // The lengths agree, so there is no error to hand on.
    let _ = fill(program, &Points::Scattered { x: &[x], y: &[y] }, depth.as_ref(), &mut value, None);
    value[0]
}

/// The methods of a noise that has `program()` and `program3()`, without slopes.
macro_rules! value_methods {
    ($noise:ident) => {
        impl $noise {
            /// The value at (x, y), metres. Each call pays for picking the level and seeding the octaves: for more than a few
            /// points, [`fill`](Self::fill) is many times faster and gives the same bits.
            #[must_use]
            pub fn sample(&self, x: f64, y: f64) -> f32 {
                $crate::methods::sample(&self.program(), x, y, None)
            }

            /// The value at (x, y, z), metres.
            #[must_use]
            pub fn sample3(&self, x: f64, y: f64, z: f64) -> f32 {
                $crate::methods::sample(&self.program3(), x, y, Some(z))
            }

            /// The values at the points, in their order.
            ///
            /// # Errors
            /// A slice does not have the points' length; nothing is written.
            pub fn fill(&self, points: &$crate::Points, value: &mut [f32]) -> Result<(), $crate::Mismatch> {
                $crate::methods::fill(&self.program(), points, None, value, None)
            }

            /// The values at the points in space.
            ///
            /// # Errors
            /// A slice does not have the points' length; nothing is written.
            pub fn fill3(
                &self,
                points: &$crate::Points,
                depth: &$crate::Depth,
                value: &mut [f32],
            ) -> Result<(), $crate::Mismatch> {
                $crate::methods::fill(&self.program3(), points, Some(depth), value, None)
            }

            /// [`fill`](Self::fill) at a chosen SIMD level, for tests and bug reports: the bits are the same.
            ///
            /// # Errors
            /// This machine lacks the level; inside, a slice of the wrong length.
            pub fn fill_at(
                &self,
                level: $crate::Level,
                points: &$crate::Points,
                value: &mut [f32],
            ) -> Result<Result<(), $crate::Mismatch>, $crate::LevelError> {
                $crate::methods::fill_at(level, &self.program(), points, None, value, None)
            }
        }
    };
}
pub(crate) use value_methods;

/// The methods of a noise that has slopes, too.
macro_rules! noise_methods {
    ($noise:ident) => {
        $crate::methods::value_methods!($noise);

        impl $noise {
            /// The values and their slopes along x and y, per metre.
            ///
            /// # Errors
            /// A slice does not have the points' length; nothing is written.
            pub fn fill_with_gradient(
                &self,
                points: &$crate::Points,
                value: &mut [f32],
                dx: &mut [f32],
                dy: &mut [f32],
            ) -> Result<(), $crate::Mismatch> {
                $crate::methods::fill(&self.program(), points, None, value, Some([dx, dy, &mut []]))
            }

            /// The values at the points in space and their slopes along x, y and z, per metre, in `gradient`.
            ///
            /// # Errors
            /// A slice does not have the points' length; nothing is written.
            pub fn fill3_with_gradient(
                &self,
                points: &$crate::Points,
                depth: &$crate::Depth,
                value: &mut [f32],
                gradient: [&mut [f32]; 3],
            ) -> Result<(), $crate::Mismatch> {
                $crate::methods::fill(&self.program3(), points, Some(depth), value, Some(gradient))
            }
        }
    };
}
pub(crate) use noise_methods;
