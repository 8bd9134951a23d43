//! Sliding of loose sediment.

use super::planes::{self, Pass, Planes};
use super::rows::{least, positive, settle};
use crate::error::Result;
use crate::progress::Progress;
use orogen_simd::{Body, Simd, dispatch};

/// Loose ground on firm ground. In a pass, a fifth of the height difference to a neighbor beyond `stands` crosses the
/// common side, but at most a quarter of the loose ground of the higher cell. Mass is conserved, and firm ground does
/// not move.
pub struct Loose {
    /// Height difference between neighbors, in metres, at which loose ground is stable.
    pub stands: f32,
}

/// Index of the plane of firm ground.
pub const FIRM: usize = 0;
/// Index of the plane of loose ground, in metres above the firm ground.
pub const LOOSE: usize = 1;

impl Loose {
    /// The planes after `passes`, smaller by one cell per pass on each side.
    ///
    /// # Errors
    /// If the work is cancelled.
    pub fn run(&self, planes: Planes<2>, passes: usize, progress: &Progress) -> Result<Planes<2>> {
        planes::run(planes, passes, self, progress)
    }
}

impl Pass<2> for Loose {
    const RADIUS: usize = 1;

    fn make(&self, from: &Planes<2>, to: &mut Planes<2>, scratch: &mut Vec<f32>) {
        scratch.resize(3 * to.width() + 1, 0.0);
        dispatch(Rows { loose: self, from, to, scratch });
    }
}

struct Rows<'a> {
    loose: &'a Loose,
    from: &'a Planes<2>,
    to: &'a mut Planes<2>,
    scratch: &'a mut [f32],
}

impl Body for Rows<'_> {
    type Output = ();

    #[inline(always)]
    fn run<S: Simd>(self, _: S) {
        let width = self.to.width();
        let (sides, rest) = self.scratch.split_at_mut(width + 1);
        let (mut above, mut below) = rest.split_at_mut(width);
        self.loose.across(
            self.from.row(0).map(|row| &row[1..=width]),
            self.from.row(1).map(|row| &row[1..=width]),
            above,
        );
        for j in 0..self.to.height() {
            let here = self.from.row(j + 1);
            let middle = here.map(|row| &row[1..=width]);
            self.loose.across(here.map(|row| &row[..=width]), here.map(|row| &row[1..]), sides);
            self.loose.across(middle, self.from.row(j + 2).map(|row| &row[1..=width]), below);
            let [firm, loose] = self.to.row_mut(j);
            firm.copy_from_slice(middle[FIRM]);
            settle(middle[LOOSE], [&*sides, &*above, &*below], loose);
            std::mem::swap(&mut above, &mut below);
        }
    }
}

impl Loose {
    /// The amounts that cross the sides between the cells of row `from` and those of row `to`.
    #[inline(always)]
    fn across(&self, from: [&[f32]; 2], to: [&[f32]; 2], out: &mut [f32]) {
        let n = out.len();
        let ([f0, l0], [f1, l1]) = (from.map(|row| &row[..n]), to.map(|row| &row[..n]));
        for i in 0..n {
            let higher = (f0[i] - f1[i]) + (l0[i] - l1[i]);
            let much = least(0.2 * (higher - self.stands), 0.25 * l0[i]);
            let back = least(-0.2 * (higher + self.stands), 0.25 * l1[i]);
            out[i] = positive(much) - positive(back);
        }
    }
}
