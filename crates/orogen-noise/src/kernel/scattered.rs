//! Points at any position: register by register, with all octaves of a register together.

#![allow(clippy::needless_range_loop)] // see kernel/mod.rs

use crate::kernel::cell::{clamp, coordinate, moved};
use crate::kernel::combine::State;
use crate::kernel::families::{Family, VisitFamily};
use crate::kernel::near;
use crate::kernel::outputs::Outputs;
use crate::kernel::pointwise::Pointwise;
use crate::program::{Combine, Octave, Program};
use orogen_simd::{Body, Double, F32Lanes, Simd};
use std::marker::PhantomData;

/// A call of [`Scatter`] for the noise of a source.
pub(crate) struct Call<'a, S: Simd, const DIMS: usize> {
    pub simd: S,
    pub program: &'a Program,
    /// x, y, z and w of the points in metres. The first `DIMS` slices are as long as the results.
    pub at: [&'a [f64]; 4],
    pub target: Outputs<'a>,
}

impl<S: Simd, const DIMS: usize> VisitFamily for Call<'_, S, DIMS> {
    #[inline(always)]
    fn visit<F: Family>(self) {
        let Call { simd, program, at, target } = self;
        let family = PhantomData::<F>;
        if matches!(program.combine, Combine::Sum) && (target.slopes.is_none() || !F::SLOPED) {
            let sums = Sums::<F, DIMS> { program, at, target: target.value, family };
            if const { F::PAIRED && S::LANES > 4 } { Double(simd).run(sums) } else { simd.run(sums) }
        } else {
            simd.run(Scatter::<F, DIMS> { program, at, target, family });
        }
    }
}

/// Evaluates a program at points, with slopes if the noise has any. It is compiled as a separate function for each
/// level and noise.
struct Scatter<'a, F, const DIMS: usize> {
    program: &'a Program,
    at: [&'a [f64]; 4],
    target: Outputs<'a>,
    family: PhantomData<F>,
}

impl<F: Family, const DIMS: usize> Body for Scatter<'_, F, DIMS> {
    type Output = ();

    #[inline(always)]
    fn run<S: Simd>(self, simd: S) {
        // If all slopes are zero, the terms that use them are zero, too.
        if F::SLOPED { self.go::<S, true>(simd) } else { self.go::<S, false>(simd) }
    }
}

impl<F: Family, const DIMS: usize> Scatter<'_, F, DIMS> {
    #[inline(always)]
    fn go<S: Simd, const SLOPES: bool>(self, simd: S) {
        let Scatter { program, at, mut target, .. } = self;
        let combine = &program.combine;
        let moves = combine.moves();
        let none = simd.f64(0.0);
        let mut start = 0;
        while start < target.value.len() {
            let position = positions::<S, DIMS>(simd, program, &at, start);
            let mut state = State::new(simd);
            for octave in program.octaves() {
                let noise = F::At::<S>::new(simd, program.source, octave);
                let mut place = [F::At::<S>::split(simd, none); 4];
                for axis in 0..DIMS {
                    let mut u = coordinate(simd, octave, axis, position[axis]);
                    if SLOPES && moves {
                        u = moved(simd, octave, u, state.shift(simd, combine, octave, axis));
                    }
                    place[axis] = F::At::<S>::split(simd, u);
                }
                // A plain sum accumulates across octaves. There is only one call for both cases, because the function
                // is long and inlined.
                let runs_on = matches!(combine, Combine::Sum);
                let mut one = if runs_on { state.sum } else { [simd.f32(0.0); 5] };
                noise.add::<SLOPES>(simd, octave, &place, &mut one);
                if runs_on {
                    state.sum = one;
                } else {
                    state.add::<SLOPES>(simd, combine, octave, &one, DIMS);
                }
            }
            state.finish::<SLOPES>(simd, combine, DIMS);
            state.sum[0].store_partial(&mut target.value[start..]);
            if let (true, Some(slopes)) = (SLOPES, &mut target.slopes) {
                for axis in 0..DIMS {
                    state.sum[1 + axis].store_partial(slopes[axis].get_mut(start..).unwrap_or_default());
                }
            }
            start += S::LANES;
        }
    }
}

/// Plain sums at points, without slopes.
struct Sums<'a, F, const DIMS: usize> {
    program: &'a Program,
    at: [&'a [f64]; 4],
    target: &'a mut [f32],
    family: PhantomData<F>,
}

impl<F: Family, const DIMS: usize> Body for Sums<'_, F, DIMS> {
    type Output = ();

    #[inline(always)]
    fn run<S: Simd>(self, simd: S) {
        let Sums { program, at, target, .. } = self;
        let octaves = program.octaves();
        let mut start = 0;
        if F::PAIRED
            && let [octave] = octaves
        {
            // The values of the only octave stay in registers for all points.
            let noise = F::At::<S>::new(simd, program.source, octave);
            if F::At::<S>::KEYED && const { DIMS == 2 } && near::covers(octave) {
                let points = near::Scattered { frequency: octave.frequency, limit: program.limit, at: [at[0], at[1]] };
                return near::fill(simd, noise, &points, target);
            }
            while start < target.len() {
                let position = positions::<S, DIMS>(simd, program, &at, start);
                let mut sum = [simd.f32(0.0); 5];
                noise.add::<false>(simd, octave, &places::<S, F, DIMS>(simd, octave, &position), &mut sum);
                sum[0].store_partial(&mut target[start..]);
                start += S::LANES;
            }
            return;
        }
        while start < target.len() {
            let position = positions::<S, DIMS>(simd, program, &at, start);
            let mut sum = [simd.f32(0.0); 5];
            for octave in octaves {
                let noise = F::At::<S>::new(simd, program.source, octave);
                noise.add::<false>(simd, octave, &places::<S, F, DIMS>(simd, octave, &position), &mut sum);
            }
            sum[0].store_partial(&mut target[start..]);
            start += S::LANES;
        }
    }
}

/// The positions of a register of points, clamped to the program's limit.
#[inline(always)]
fn positions<S: Simd, const DIMS: usize>(simd: S, program: &Program, at: &[&[f64]; 4], start: usize) -> [S::F64; 4] {
    let mut position = [simd.f64(0.0); 4];
    for axis in 0..DIMS {
        let from = at[axis].get(start..).unwrap_or_default();
        position[axis] = clamp(simd, simd.load_f64_partial(from, 0.0), program.limit);
    }
    position
}

/// Positions in the coordinates of an octave, split as required by its noise.
#[inline(always)]
fn places<S: Simd, F: Family, const DIMS: usize>(
    simd: S,
    octave: &Octave,
    position: &[S::F64; 4],
) -> [<F::At<S> as Pointwise<S>>::Coordinate; 4] {
    let mut place = [F::At::<S>::split(simd, simd.f64(0.0)); 4];
    for axis in 0..DIMS {
        place[axis] = F::At::<S>::split(simd, coordinate(simd, octave, axis, position[axis]));
    }
    place
}
