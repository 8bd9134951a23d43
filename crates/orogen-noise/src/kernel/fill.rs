//! The way in: picks the level and the path.

use crate::kernel::scattered::{BLOCK, Block, Sums, evaluate};
use crate::program::Program;
use crate::{Depth, Points};
use orogen_simd::{Body, Simd};

/// Where results go: values, and slopes along x, y and z where they are wanted. Lengths are checked.
pub(crate) struct Outputs<'a> {
    pub value: &'a mut [f32],
    pub slopes: Option<[&'a mut [f32]; 3]>,
}

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
        let total = self.points.len();
        let (mut block, mut sums) = (Block::new(), Sums::new());
        let mut start = 0;
        while start < total {
            let count = BLOCK.min(total - start);
            gather(&self.points, self.depth.as_ref(), start, count, &mut block);
            block.settle(simd, count, self.program.limit, self.depth.is_some());
            let slopes = self.outputs.slopes.is_some();
            if self.depth.is_some() {
                evaluate::<S, true>(simd, self.program, &block, count, slopes, &mut sums);
            } else {
                evaluate::<S, false>(simd, self.program, &block, count, slopes, &mut sums);
            }
            self.outputs.value[start..start + count].copy_from_slice(&sums.0[0][..count]);
            if let Some(slopes) = &mut self.outputs.slopes {
                for (slope, sum) in slopes.iter_mut().zip(&sums.0[1..]) {
                    // In 2D there is no slope along z: that slice is empty.
                    if let Some(slope) = slope.get_mut(start..start + count) {
                        slope.copy_from_slice(&sum[..count]);
                    }
                }
            }
            start += count;
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
