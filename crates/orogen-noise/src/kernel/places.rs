//! Positions of points, in blocks.

use crate::points::Points;
use orogen_simd::{Body, F32Lanes, F64Lanes, Simd};

/// Number of points per block if their positions are copied into buffers. The buffers fit into the first-level cache.
pub(crate) const BLOCK: usize = 256;

/// x and y of the points from `start` on, as many as the buffers hold. The result is either the caller's slices or the
/// buffers.
#[inline(always)]
pub(crate) fn positions<'a, S: Simd>(
    simd: S,
    points: &Points<'a>,
    start: usize,
    [x, y]: [&'a mut [f64]; 2],
) -> [&'a [f64]; 2] {
    let count = x.len();
    match *points {
        Points::Scattered { x, y } => [&x[start..start + count], &y[start..start + count]],
        Points::Lattice { xs, ys } => {
            gather(simd, (xs, ys), None, start, [x, y]);
            [x, y]
        }
        Points::Displaced { xs, ys, dx, dy } => {
            gather(simd, (xs, ys), Some([dx, dy]), start, [x, y]);
            [x, y]
        }
    }
}

/// Copies the positions of lattice samples from `start` on, row by row.
#[inline(always)]
fn gather<S: Simd>(
    simd: S,
    (xs, ys): (&[f64], &[f64]),
    displaced: Option<[&[f32]; 2]>,
    start: usize,
    [x, y]: [&mut [f64]; 2],
) {
    let mut done = 0;
    while done < x.len() {
        let at = start + done;
        let (row, column) = (at / xs.len(), at % xs.len());
        let run = (xs.len() - column).min(x.len() - done);
        let (x, y) = (&mut x[done..done + run], &mut y[done..done + run]);
        let (from, line) = (&xs[column..column + run], ys[row]);
        if let Some([dx, dy]) = displaced {
            simd.run(Displace { to: x, from: Some(from), line, by: &dx[at..at + run] });
            simd.run(Displace { to: y, from: None, line, by: &dy[at..at + run] });
        } else {
            x.copy_from_slice(from);
            y.fill(line);
        }
        done += run;
    }
}

/// Adds displacements to positions: one to each position, or all to the same position.
struct Displace<'a> {
    to: &'a mut [f64],
    from: Option<&'a [f64]>,
    line: f64,
    by: &'a [f32],
}

impl Body for Displace<'_> {
    type Output = ();

    #[inline(always)]
    fn run<S: Simd>(self, simd: S) {
        let Displace { to, from, line, by } = self;
        let whole = by.len() / S::LANES * S::LANES;
        let lines = simd.f64(line);
        for at in (0..whole).step_by(S::LANES) {
            let from = if let Some(from) = from { simd.load_f64(&from[at..]) } else { lines };
            (from + simd.load(&by[at..]).widen()).store(&mut to[at..]);
        }
        for at in whole..by.len() {
            to[at] = from.map_or(line, |from| from[at]) + f64::from(by[at]);
        }
    }
}
