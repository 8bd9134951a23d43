//! Entry point of the kernels: selects the code path.

use crate::choices::{Fade, Smoothness};
use crate::kernel::families::with_family;
use crate::kernel::open_simplex::Open;
use crate::kernel::outputs::Outputs;
use crate::kernel::places::{BLOCK, positions};
use crate::kernel::scattered::Call;
use crate::kernel::simplex::Plain;
use crate::kernel::{cellular_rows, lattice, slanted, white};
use crate::points::{Depth, Points};
use crate::program::{Combine, Program, Source};
use orogen_simd::{Body, Simd};

/// One call of a public `fill`. Depths are z and w, as far as these axes exist.
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
                    cellular_rows::fill::<S, DIMS>(simd, (program, octave, kind), xs_ys, slice[0], &mut outputs);
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

/// Points at any position, in blocks.
#[inline(always)]
fn blocks<S: Simd, const DIMS: usize>(
    simd: S,
    program: &Program,
    points: &Points,
    depths: &[Depth],
    outputs: &mut Outputs,
) {
    if let (Points::Scattered { x, y }, 2) = (*points, DIMS) {
        // The positions need no buffers.
        let target = outputs.part(0, points.len());
        with_family::<_, DIMS>(program.source, Call::<S, DIMS> { simd, program, at: [x, y, &[], &[]], target });
        return;
    }
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
