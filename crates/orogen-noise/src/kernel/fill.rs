//! The way in: picks the level and the path.

use crate::choices::{Fade, Smoothness};
use crate::kernel::open_simplex::Open;
use crate::kernel::outputs::Outputs;
use crate::kernel::pointwise::with_family;
use crate::kernel::scattered::Call;
use crate::kernel::simplex::Plain;
use crate::kernel::{cellular, lattice, slanted, white};
use crate::points::{Depth, Points};
use crate::program::{Combine, Program, Source};
use orogen_simd::{Body, F32Lanes, F64Lanes, Simd};

/// How many points are worked on at a time where their positions have to be put together: they stay in the first-level cache.
pub(crate) const BLOCK: usize = 256;

/// One call of a public `fill`. Depths are z and w, as far as there are these axes.
pub(crate) struct Fill<'a> {
    pub program: &'a Program,
    pub points: Points<'a>,
    pub depths: &'a [Depth<'a>],
    pub outputs: Outputs<'a>,
}

impl Body for Fill<'_> {
    type Output = ();

    #[inline(always)]
    fn run<S: Simd>(self, simd: S) {
        match self.depths {
            [] => fill::<S, 2>(simd, self),
            [_] => fill::<S, 3>(simd, self),
            _ => fill::<S, 4>(simd, self),
        }
    }
}

#[inline(always)]
fn fill<S: Simd, const DIMS: usize>(simd: S, call: Fill) {
    let Fill { program, points, depths, mut outputs } = call;
    let mut slice = [0.0; 2];
    let mut flat = true;
    for axis in 0..(DIMS - 2).min(depths.len()) {
        match depths[axis] {
            Depth::Slice(depth) => slice[axis] = depth,
            Depth::Each(_) => flat = false,
        }
    }
    if !program.source.sloped() {
        outputs.flatten();
    }
    match points {
        Points::Lattice { xs, ys } if flat && !program.combine.moves() => {
            let (xs_ys, depths) = ((xs, ys), (DIMS, slice));
            match (program.source, program.combine, program.octaves()) {
                (Source::Value(Fade::Step), Combine::Sum, [octave]) => {
                    white::fill(simd, program, octave, xs_ys, depths, &mut outputs);
                }
                (Source::Worley(kind), Combine::Sum, [octave]) if DIMS < 4 => {
                    cellular::fill::<S, DIMS>(simd, (program, octave, kind), xs_ys, slice[0], &mut outputs);
                }
                (Source::Simplex, Combine::Sum, _) if outputs.slopes.is_none() => {
                    slanted::fill::<S, Plain, DIMS>(simd, program, xs_ys, slice, &mut outputs);
                }
                (Source::OpenSimplex2(Smoothness::Fast), Combine::Sum, _) if outputs.slopes.is_none() && DIMS != 3 => {
                    slanted::fill::<S, Open, DIMS>(simd, program, xs_ys, slice, &mut outputs);
                }
                (source, ..) if source.low_rank() && lattice::covers(program, DIMS, outputs.slopes.is_some()) => {
                    lattice::fill(simd, program, xs_ys, depths, &mut outputs);
                }
                _ => blocks::<S, DIMS>(simd, program, &points, call.depths, &mut outputs),
            }
        }
        _ => blocks::<S, DIMS>(simd, program, &points, call.depths, &mut outputs),
    }
}

/// Points anywhere, some at a time.
#[inline(always)]
fn blocks<S: Simd, const DIMS: usize>(
    simd: S,
    program: &Program,
    points: &Points,
    depths: &[Depth],
    outputs: &mut Outputs,
) {
    let (mut x, mut y, mut z, mut w) = ([0.0; BLOCK], [0.0; BLOCK], [0.0; BLOCK], [0.0; BLOCK]);
    for (axis, depth) in [&mut z, &mut w].into_iter().zip(depths) {
        if let Depth::Slice(depth) = depth {
            axis.fill(*depth);
        }
    }
    for start in (0..points.len()).step_by(BLOCK) {
        let count = BLOCK.min(points.len() - start);
        let target = outputs.part(start, count);
        let [x, y] = positions(simd, points, start, [&mut x[..count], &mut y[..count]]);
        let mut at = [x, y, &z[..count], &w[..count]];
        for (axis, depth) in at[2..].iter_mut().zip(depths) {
            if let Depth::Each(depth) = depth {
                *axis = &depth[start..start + count];
            }
        }
        with_family::<_, DIMS>(program.source, Call::<S, DIMS> { simd, program, at, target });
    }
}

/// x and y of as many points from `start` on as there is room for: where they are, or put together in that room.
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

/// Collects the positions of lattice samples from `start` on, row by row.
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
        x.copy_from_slice(&xs[column..column + run]);
        y.fill(ys[row]);
        if let Some([dx, dy]) = displaced {
            simd.run(Displace { to: x, by: &dx[at..at + run] });
            simd.run(Displace { to: y, by: &dy[at..at + run] });
        }
        done += run;
    }
}

/// Adds displacements to positions.
struct Displace<'a> {
    to: &'a mut [f64],
    by: &'a [f32],
}

impl Body for Displace<'_> {
    type Output = ();

    #[inline(always)]
    fn run<S: Simd>(self, simd: S) {
        let whole = self.by.len() / S::LANES * S::LANES;
        for at in (0..whole).step_by(S::LANES) {
            let sum = simd.load_f64(&self.to[at..]) + simd.load(&self.by[at..]).widen();
            sum.store(&mut self.to[at..]);
        }
        for at in whole..self.by.len() {
            self.to[at] += f64::from(self.by[at]);
        }
    }
}
