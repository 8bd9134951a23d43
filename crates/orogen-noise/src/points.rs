//! Where a noise is asked, and the one error asking can end in.

use std::fmt;

/// The positions a noise is evaluated at, in metres, in f64.
///
/// The three ways give the same bits for the same positions; they differ in speed. A lattice is several times faster than
/// scattered points, because everything that depends on x alone or y alone is worked out once per column or row.
#[derive(Clone, Copy, Debug)]
pub enum Points<'a> {
    /// Sample k = j * xs.len() + i stands at `(xs[i], ys[j])`. Evenly spaced, ascending columns are fastest; any values are legal.
    Lattice {
        /// x of each column, metres.
        xs: &'a [f64],
        /// y of each row, metres.
        ys: &'a [f64],
    },
    /// Sample k = j * xs.len() + i stands at `(xs[i] + dx[k], ys[j] + dy[k])`, the sums in f64: a warped lattice.
    Displaced {
        /// x of each column, metres.
        xs: &'a [f64],
        /// y of each row, metres.
        ys: &'a [f64],
        /// Displacement of each sample along x, metres; row-major.
        dx: &'a [f32],
        /// Displacement of each sample along y, metres; row-major.
        dy: &'a [f32],
    },
    /// Sample k stands at `(x[k], y[k])`.
    Scattered {
        /// x of each sample, metres.
        x: &'a [f64],
        /// y of each sample, metres.
        y: &'a [f64],
    },
}

impl Points<'_> {
    /// How many samples there are.
    #[must_use]
    pub fn len(&self) -> usize {
        match *self {
            Points::Lattice { xs, ys } | Points::Displaced { xs, ys, .. } => xs.len().saturating_mul(ys.len()),
            Points::Scattered { x, .. } => x.len(),
        }
    }

    /// Whether there is none.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Where sample k stands, metres; `None` from [`Points::len`] on.
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

    /// Checks that the slices belong together.
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

/// The third coordinate of the samples, metres.
#[derive(Clone, Copy, Debug)]
pub enum Depth<'a> {
    /// One depth for all samples: a slice. Keeps the speed of a lattice.
    Slice(f64),
    /// A depth for each sample.
    Each(&'a [f64]),
}

/// A slice whose length does not fit the points. Nothing has been written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LengthMismatch {
    /// Which slice.
    pub slice: &'static str,
    /// How long it is.
    pub length: usize,
    /// How long it should be.
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
