//! The methods of every noise.

use crate::kernel::fill::Fill;
use crate::kernel::outputs::Outputs;
use crate::points::{Depth, LengthMismatch, Points};
use crate::program::Program;
use orogen_simd::{Level, LevelError, dispatch, dispatch_at};

/// Runs a program at the current SIMD level. `depths` are z and w, if these axes exist; `slopes` has one slice per
/// axis.
pub(crate) fn fill(
    program: &Program,
    points: &Points,
    depths: &[Depth],
    value: &mut [f32],
    slopes: Option<[&mut [f32]; 4]>,
) -> Result<(), LengthMismatch> {
    check(points, depths, value, slopes.as_ref())?;
    dispatch(Fill { program, points: *points, depths, outputs: Outputs { value, slopes } });
    Ok(())
}

/// Runs a program at a chosen level.
///
/// # Errors
/// This machine does not support the level. The inner error is a slice of the wrong length.
pub fn fill_at(
    level: Level,
    program: &Program,
    points: &Points,
    depths: &[Depth],
    value: &mut [f32],
    slopes: Option<[&mut [f32]; 4]>,
) -> Result<Result<(), LengthMismatch>, LevelError> {
    if let Err(mismatch) = check(points, depths, value, slopes.as_ref()) {
        return Ok(Err(mismatch));
    }
    dispatch_at(level, Fill { program, points: *points, depths, outputs: Outputs { value, slopes } })?;
    Ok(Ok(()))
}

fn check(
    points: &Points,
    depths: &[Depth],
    value: &[f32],
    slopes: Option<&[&mut [f32]; 4]>,
) -> Result<(), LengthMismatch> {
    points.check()?;
    let check = |slice, length| LengthMismatch::check(slice, length, points.len());
    check("value", value.len())?;
    if let Some(slopes) = slopes {
        let names = ["dx", "dy", "dz", "dw"];
        for (slope, name) in slopes.iter().zip(names).take(2 + depths.len()) {
            check(name, slope.len())?;
        }
    }
    for (depth, name) in depths.iter().zip(["z", "w"]) {
        if let Depth::Each(depth) = depth {
            check(name, depth.len())?;
        }
    }
    Ok(())
}

/// The value at one position.
pub(crate) fn sample(program: &Program, x: f64, y: f64, depths: &[Depth]) -> f32 {
    let mut value = [0.0];
    // The lengths match, so there is no error to return.
    let _ = fill(program, &Points::Scattered { x: &[x], y: &[y] }, depths, &mut value, None);
    value[0]
}

/// The methods of a noise that has a `program` for each number of dimensions; those without slopes.
macro_rules! value_methods {
    ($noise:ident) => {
        impl $noise {
            /// The value at (x, y), in metres. For many points at once, [`fill`](Self::fill) is many times faster and
            /// gives the same bits. For many single points, see [`Prepared`](crate::Prepared).
            #[must_use]
            pub fn sample(&self, x: f64, y: f64) -> f32 {
                $crate::methods::sample(&self.program(2), x, y, &[])
            }

            /// The value at (x, y, z), in metres.
            #[must_use]
            pub fn sample3(&self, x: f64, y: f64, z: f64) -> f32 {
                $crate::methods::sample(&self.program(3), x, y, &[$crate::Depth::Slice(z)])
            }

            /// The value at (x, y, z, w), in metres.
            #[must_use]
            pub fn sample4(&self, x: f64, y: f64, z: f64, w: f64) -> f32 {
                $crate::methods::sample(&self.program(4), x, y, &[$crate::Depth::Slice(z), $crate::Depth::Slice(w)])
            }

            /// The values at the points, in the order of the points.
            ///
            /// # Errors
            /// A slice does not have the same length as the points. Nothing is written then.
            pub fn fill(&self, points: &$crate::Points, value: &mut [f32]) -> Result<(), $crate::LengthMismatch> {
                $crate::methods::fill(&self.program(2), points, &[], value, None)
            }

            /// The values at the points in space.
            ///
            /// # Errors
            /// A slice does not have the same length as the points. Nothing is written then.
            pub fn fill3(
                &self,
                points: &$crate::Points,
                depth: &$crate::Depth,
                value: &mut [f32],
            ) -> Result<(), $crate::LengthMismatch> {
                $crate::methods::fill(&self.program(3), points, &[*depth], value, None)
            }

            /// The values at the points in four dimensions. `depths` are z and w.
            ///
            /// # Errors
            /// A slice does not have the same length as the points. Nothing is written then.
            pub fn fill4(
                &self,
                points: &$crate::Points,
                depths: &[$crate::Depth; 2],
                value: &mut [f32],
            ) -> Result<(), $crate::LengthMismatch> {
                $crate::methods::fill(&self.program(4), points, depths, value, None)
            }

            /// [`fill`](Self::fill) at a given SIMD level, for tests and bug reports. The bits are the same.
            ///
            /// # Errors
            /// This machine does not support the level. The inner error is a slice of the wrong length.
            pub fn fill_at(
                &self,
                level: $crate::Level,
                points: &$crate::Points,
                value: &mut [f32],
            ) -> Result<Result<(), $crate::LengthMismatch>, $crate::LevelError> {
                $crate::methods::fill_at(level, &self.program(2), points, &[], value, None)
            }
        }
    };
}
pub(crate) use value_methods;

/// The methods of a noise that also has slopes.
macro_rules! noise_methods {
    ($noise:ident) => {
        $crate::methods::value_methods!($noise);

        impl $noise {
            /// The values and their slopes along x and y, per metre.
            ///
            /// # Errors
            /// A slice does not have the same length as the points. Nothing is written then.
            pub fn fill_with_gradient(
                &self,
                points: &$crate::Points,
                value: &mut [f32],
                dx: &mut [f32],
                dy: &mut [f32],
            ) -> Result<(), $crate::LengthMismatch> {
                $crate::methods::fill(&self.program(2), points, &[], value, Some([dx, dy, &mut [], &mut []]))
            }

            /// The values at the points in space and their slopes along x, y and z, per metre, in `gradient`.
            ///
            /// # Errors
            /// A slice does not have the same length as the points. Nothing is written then.
            pub fn fill3_with_gradient(
                &self,
                points: &$crate::Points,
                depth: &$crate::Depth,
                value: &mut [f32],
                gradient: [&mut [f32]; 3],
            ) -> Result<(), $crate::LengthMismatch> {
                let [dx, dy, dz] = gradient;
                $crate::methods::fill(&self.program(3), points, &[*depth], value, Some([dx, dy, dz, &mut []]))
            }

            /// The values at the points in four dimensions and their slopes along x, y, z and w, per metre, in
            /// `gradient`. `depths` are z and w.
            ///
            /// # Errors
            /// A slice does not have the same length as the points. Nothing is written then.
            pub fn fill4_with_gradient(
                &self,
                points: &$crate::Points,
                depths: &[$crate::Depth; 2],
                value: &mut [f32],
                gradient: [&mut [f32]; 4],
            ) -> Result<(), $crate::LengthMismatch> {
                $crate::methods::fill(&self.program(4), points, depths, value, Some(gradient))
            }
        }
    };
}
pub(crate) use noise_methods;
