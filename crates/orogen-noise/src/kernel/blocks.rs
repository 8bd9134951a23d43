//! Points at any position, in blocks.

use crate::kernel::families::with_family;
use crate::kernel::outputs::Outputs;
use crate::kernel::places::{BLOCK, positions};
use crate::kernel::scattered::Call;
use crate::points::{Depth, Points};
use crate::program::Program;
use orogen_simd::{Body, Simd};

/// Fills points of any form in `DIMS` dimensions. Compiled as a separate function, because it calls the kernel of every
/// noise.
pub(crate) struct Blocks<'a, const DIMS: usize> {
    pub program: &'a Program,
    pub points: Points<'a>,
    /// z and w, if these axes exist.
    pub depths: &'a [Depth<'a>],
    pub outputs: Outputs<'a>,
}

impl<const DIMS: usize> Body for Blocks<'_, DIMS> {
    type Output = ();

    #[inline(always)]
    fn run<S: Simd>(self, simd: S) {
        let Blocks { program, points, depths, mut outputs } = self;
        if let (Points::Scattered { x, y }, 2) = (points, DIMS) {
            // The positions need no buffers.
            call::<S, DIMS>(simd, program, [x, y, &[], &[]], outputs);
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
            let [x, y] = positions(simd, &points, start, [&mut x[..count], &mut y[..count]]);
            let mut at = [x, y, &z[..count], &w[..count]];
            for (axis, depth) in at[2..].iter_mut().zip(depths) {
                if let Depth::Each(depth) = depth {
                    *axis = &depth[start..start + count];
                }
            }
            call::<S, DIMS>(simd, program, at, outputs.part(start, count));
        }
    }
}

/// Calls the kernel of the noise.
#[inline(always)]
fn call<S: Simd, const DIMS: usize>(simd: S, program: &Program, at: [&[f64]; 4], target: Outputs) {
    with_family::<_, DIMS>(program.source, Call::<S, DIMS> { simd, program, at, target });
}
