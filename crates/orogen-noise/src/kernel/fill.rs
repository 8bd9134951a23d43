//! Entry point of the kernels: selects the code path.

use crate::choices::{Fade, Smoothness};
use crate::kernel::blocks::Blocks;
use crate::kernel::open_simplex::Open;
use crate::kernel::outputs::Outputs;
use crate::kernel::simplex::Plain;
use crate::kernel::{cellular_rows, lattice, slanted, white};
use crate::points::{Depth, Points};
use crate::program::{Combine, Program, Source};
use orogen_simd::{Body, Simd};

/// One call of a public `fill`. Depths are z and w, if these axes exist.
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
            let xs_ys = (xs, ys);
            match (program.source, program.combine, program.octaves()) {
                (Source::Value(Fade::Step), Combine::Sum, [octave]) => {
                    white::fill(simd, program, octave, xs_ys, (DIMS, slice), &mut outputs);
                }
                (Source::Worley(kind), Combine::Sum, [octave]) if const { DIMS < 4 } => {
                    cellular_rows::fill::<S, DIMS>(simd, (program, octave, kind), xs_ys, slice[0], &mut outputs);
                }
                (Source::Simplex, Combine::Sum, _) if outputs.slopes.is_none() => {
                    slanted::fill::<S, Plain, DIMS>(simd, program, xs_ys, slice, &mut outputs);
                }
                (Source::OpenSimplex2(Smoothness::Fast), Combine::Sum, _)
                    if const { DIMS != 3 } && outputs.slopes.is_none() =>
                {
                    slanted::fill::<S, Open, DIMS>(simd, program, xs_ys, slice, &mut outputs);
                }
                (source, ..) if source.low_rank() && lattice::covers(program, DIMS, outputs.slopes.is_some()) => {
                    lattice::fill(simd, program, xs_ys, (DIMS, slice), &mut outputs);
                }
                _ => simd.run(Blocks::<DIMS> { program, points, depths, outputs }),
            }
        }
        _ => simd.run(Blocks::<DIMS> { program, points, depths, outputs }),
    }
}
