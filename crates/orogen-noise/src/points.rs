//! Positions at which noises are evaluated, and the error of their methods.

use std::fmt;

/// The positions at which a noise is evaluated, in metres, in f64.
///
/// The three forms give the same bits for the same positions, but differ in speed. A lattice is several times faster
/// than scattered points, because values that depend only on x or only on y are computed once per column or row.
#[derive(Clone, Copy, Debug)]
pub enum Points<'a> {
    /// Sample k = j * xs.len() + i is at `(xs[i], ys[j])`. Evenly spaced, ascending columns are fastest, but any values
    /// are valid.
    Lattice {
        /// x of each column, in metres.
        xs: &'a [f64],
        /// y of each row, in metres.
        ys: &'a [f64],
    },
    /// A warped lattice: sample k = j * xs.len() + i is at `(xs[i] + dx[k], ys[j] + dy[k])`, with sums in f64.
    Displaced {
        /// x of each column, in metres.
        xs: &'a [f64],
        /// y of each row, in metres.
        ys: &'a [f64],
        /// Displacement of each sample along x, in metres; row-major.
        dx: &'a [f32],
        /// Displacement of each sample along y, in metres; row-major.
        dy: &'a [f32],
    },
    /// Sample k is at `(x[k], y[k])`.
    Scattered {
        /// x of each sample, in metres.
        x: &'a [f64],
        /// y of each sample, in metres.
        y: &'a [f64],
    },
}

impl Points<'_> {
    /// Number of samples.
    #[must_use]
    pub fn len(&self) -> usize {
        match *self {
            Points::Lattice { xs, ys } | Points::Displaced { xs, ys, .. } => xs.len().saturating_mul(ys.len()),
            Points::Scattered { x, .. } => x.len(),
        }
    }

    /// Whether there are no samples.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Position of sample k, in metres; `None` if k is [`Points::len`] or more.
    #[must_use]
    pub fn position(&self, k: usize) -> Option<(f64, f64)> {
        match *self {
            Points::Lattice { xs, ys } => {
                let row = k.checked_div(xs.len())?;
                Some((*xs.get(k - row * xs.len())?, *ys.get(row)?))
            }
            Points::Displaced { xs, ys, dx, dy } => {
                let row = k.checked_div(xs.len())?;
                let (x, y) = (*xs.get(k - row * xs.len())?, *ys.get(row)?);
                Some((x + f64::from(*dx.get(k)?), y + f64::from(*dy.get(k)?)))
            }
            Points::Scattered { x, y } => Some((*x.get(k)?, *y.get(k)?)),
        }
    }

    /// Checks that the lengths of the slices match.
    pub(crate) fn check(&self) -> Result<(), LengthMismatch> {
        match *self {
            Points::Lattice { .. } => Ok(()),
            Points::Displaced { dx, dy, .. } => {
                LengthMismatch::check("dx", dx.len(), self.len())?;
                LengthMismatch::check("dy", dy.len(), self.len())
            }
            Points::Scattered { x, y } => LengthMismatch::check("y", y.len(), x.len()),
        }
    }
}

/// The third or fourth coordinate of the samples, in metres.
#[derive(Clone, Copy, Debug)]
pub enum Depth<'a> {
    /// One coordinate for all samples, which form a slice. Lattices are as fast as in the plane.
    Slice(f64),
    /// One coordinate for each sample, in the order of the samples.
    Each(&'a [f64]),
}

/// A slice has the wrong length. Nothing was written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LengthMismatch {
    /// Name of the slice.
    pub slice: &'static str,
    /// Length of the slice.
    pub length: usize,
    /// The required length.
    pub expected: usize,
}

impl LengthMismatch {
    pub(crate) fn check(slice: &'static str, length: usize, expected: usize) -> Result<(), LengthMismatch> {
        if length == expected { Ok(()) } else { Err(LengthMismatch { slice, length, expected }) }
    }
}

impl fmt::Display for LengthMismatch {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "`{}` holds {} values where the points need {}", self.slice, self.length, self.expected)
    }
}

impl std::error::Error for LengthMismatch {}
