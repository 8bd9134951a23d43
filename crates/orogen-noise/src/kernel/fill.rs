//! The way in: picks the level and the path.

use crate::kernel::lattice;
use crate::kernel::outputs::Outputs;
use crate::kernel::scattered::{BLOCK, Block, Sums, evaluate};
use crate::points::{Depth, Points};
use crate::program::Program;
use orogen_simd::{Body, Simd};

/// One call of a public `fill`. `depth` is there in 3D.
pub(crate) struct Fill<'a> {
    pub program: &'a Program,
    pub points: Points<'a>,
    pub depth: Option<Depth<'a>>,
    pub outputs: Outputs<'a>,
}

impl Body for Fill<'_> {
    type Output = ();

    #[inline(always)]
    fn run<S: Simd>(mut self, simd: S) {
        let Fill { program, points, depth, outputs } = &mut self;
        match (&*points, &*depth) {
            (Points::Lattice { xs, ys }, None) => lattice::fill(simd, program, (xs, ys, None), outputs),
            (Points::Lattice { xs, ys }, Some(Depth::Slice(z))) => {
                lattice::fill(simd, program, (xs, ys, Some(*z)), outputs);
            }
            (_, None) => scattered::<S, false>(simd, program, points, None, outputs),
            (_, Some(depth)) => scattered::<S, true>(simd, program, points, Some(depth), outputs),
        }
    }
}

#[inline(always)]
fn scattered<S: Simd, const DEEP: bool>(
    simd: S,
    program: &Program,
    points: &Points,
    depth: Option<&Depth>,
    outputs: &mut Outputs,
) {
    let (mut block, mut sums) = (Block::new(), Sums::new());
    for start in (0..points.len()).step_by(BLOCK) {
        let mut target = outputs.part(start, BLOCK.min(points.len() - start));
        let count = target.value.len();
        match (*points, DEEP) {
            (Points::Scattered { x, y }, false) => {
                block.settle_from(simd, [&x[start..start + count], &y[start..start + count]], program.limit);
            }
            _ => {
                gather(points, depth, start, count, &mut block);
                block.settle(simd, count, program.limit, DEEP);
            }
        }
        evaluate::<S, DEEP>(simd, program, &block, count, target.slopes.is_some(), &mut sums);
        target.value.copy_from_slice(&sums.0[0][..count]);
        for (slope, sum) in target.slopes.iter_mut().flatten().zip(&sums.0[1..]) {
            slope.copy_from_slice(&sum[..slope.len()]);
        }
    }
}

/// Collects the positions of `count` samples from `start` on, row by row.
#[inline(always)]
fn gather(points: &Points, depth: Option<&Depth>, start: usize, count: usize, block: &mut Block) {
    match *points {
        Points::Scattered { x, y } => {
            block.x[..count].copy_from_slice(&x[start..start + count]);
            block.y[..count].copy_from_slice(&y[start..start + count]);
        }
        Points::Lattice { xs, ys } | Points::Displaced { xs, ys, .. } => {
            let mut done = 0;
            while done < count {
                let at = start + done;
                let (row, column) = (at / xs.len(), at % xs.len());
                let run = (xs.len() - column).min(count - done);
                block.x[done..done + run].copy_from_slice(&xs[column..column + run]);
                block.y[done..done + run].fill(ys[row]);
                if let Points::Displaced { dx, dy, .. } = *points {
                    let add = |to: &mut [f64], by: &[f32]| to.iter_mut().zip(by).for_each(|(t, &b)| *t += f64::from(b));
                    add(&mut block.x[done..done + run], &dx[at..at + run]);
                    add(&mut block.y[done..done + run], &dy[at..at + run]);
                }
                done += run;
            }
        }
    }
    match depth {
        None => {}
        Some(Depth::Slice(z)) => block.z[..count].fill(*z),
        Some(Depth::Each(z)) => block.z[..count].copy_from_slice(&z[start..start + count]),
    }
}
