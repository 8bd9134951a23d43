//! The way in: picks the level and the path.

use crate::choices::Fade;
use crate::kernel::outputs::Outputs;
use crate::kernel::scattered::Scatter;
use crate::kernel::{cellular, lattice, white};
use crate::points::{Depth, Points};
use crate::program::{Combine, Program, Source};
use orogen_simd::{Body, F32Lanes, F64Lanes, Simd};

/// How many points are worked on at a time where their positions have to be put together: they stay in the first-level cache.
const BLOCK: usize = 256;

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
            (Points::Lattice { xs, ys }, None) => window(simd, program, (xs, ys, None), outputs),
            (Points::Lattice { xs, ys }, Some(Depth::Slice(z))) => {
                window(simd, program, (xs, ys, Some(*z)), outputs);
            }
            (_, None) => scattered::<S, false>(simd, program, points, None, outputs),
            (_, Some(depth)) => scattered::<S, true>(simd, program, points, Some(depth), outputs),
        }
    }
}

#[inline(always)]
fn window<S: Simd>(simd: S, program: &Program, at: (&[f64], &[f64], Option<f64>), outputs: &mut Outputs) {
    match (program.source, program.combine, program.octaves()) {
        (Source::Value(Fade::Step), Combine::Sum, [octave]) => white::fill(simd, program, octave, at, outputs),
        (Source::Worley(kind), _, [octave]) => {
            for slope in outputs.slopes.iter_mut().flatten() {
                slope.fill(0.0);
            }
            let (xs, ys, z) = at;
            match z {
                None => cellular::fill::<S, false>(simd, (program, octave, kind), (xs, ys, 0.0), outputs),
                Some(z) => cellular::fill::<S, true>(simd, (program, octave, kind), (xs, ys, z), outputs),
            }
        }
        _ => lattice::fill(simd, program, at, outputs),
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
    if let Source::Worley(_) = program.source {
        for slope in outputs.slopes.iter_mut().flatten() {
            slope.fill(0.0);
        }
    }
    let (mut x, mut y, mut z) = ([0.0; BLOCK], [0.0; BLOCK], [0.0; BLOCK]);
    if let Some(Depth::Slice(depth)) = depth {
        z.fill(*depth);
    }
    for start in (0..points.len()).step_by(BLOCK) {
        let count = BLOCK.min(points.len() - start);
        let target = outputs.part(start, count);
        let [x, y] = match *points {
            // Read where they are.
            Points::Scattered { x, y } => [&x[start..start + count], &y[start..start + count]],
            Points::Lattice { xs, ys } => {
                gather(simd, (xs, ys), None, start, [&mut x[..count], &mut y[..count]]);
                [&x[..count], &y[..count]]
            }
            Points::Displaced { xs, ys, dx, dy } => {
                gather(simd, (xs, ys), Some([dx, dy]), start, [&mut x[..count], &mut y[..count]]);
                [&x[..count], &y[..count]]
            }
        };
        let z = match depth {
            Some(Depth::Each(z)) => &z[start..start + count],
            _ => &z[..count],
        };
        if let (Source::Worley(cellular), [octave]) = (program.source, program.octaves()) {
            simd.run(cellular::Scatter::<DEEP> { program, octave, cellular, at: [x, y, z], target });
        } else if target.slopes.is_some() || matches!(program.combine, Combine::Weighted { .. }) {
            simd.run(Scatter::<DEEP, true> { program, at: [x, y, z], target });
        } else {
            simd.run(Scatter::<DEEP, false> { program, at: [x, y, z], target });
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
