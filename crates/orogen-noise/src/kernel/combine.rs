//! Combines octaves into one number, lane by lane. Lattices and scattered points use the same code.

#![allow(clippy::needless_range_loop)] // see kernel/mod.rs

use crate::choices::Falloff;
use crate::program::{Combine, Octave, Shape};
use orogen_simd::{F32Lanes, Simd, U32Lanes};

/// A value and its slopes along x, y, z and w.
pub(crate) type Sample<S> = [<S as Simd>::F32; 5];

/// The state after a number of octaves.
#[derive(Clone, Copy)]
pub(crate) struct State<S: Simd> {
    pub sum: Sample<S>,
    /// At indices 1 to 4: the slope of the plain sum (weighted), the slope of the weight (hybrid), or the displacement
    /// of the next octave (swiss, jordan).
    slope: Sample<S>,
    weight: S::F32,
}

impl<S: Simd> State<S> {
    #[inline(always)]
    pub(crate) fn new(simd: S) -> State<S> {
        State { sum: [simd.f32(0.0); 5], slope: [simd.f32(0.0); 5], weight: simd.f32(1.0) }
    }

    /// The displacement of the next octave along an axis, in cells of that octave.
    #[inline(always)]
    pub(crate) fn shift(&self, simd: S, combine: &Combine, octave: &Octave, axis: usize) -> S::F32 {
        let factor = match *combine {
            Combine::Shaped { shape: Shape::Swiss { warp }, .. } => warp * octave.ratio as f32,
            Combine::Shaped { shape: Shape::Jordan { warp, .. }, .. } => warp,
            _ => 0.0,
        };
        let shift = self.slope[1 + axis] * simd.f32(factor);
        // Huge displacements and NaN count as 0.
        shift.select(shift.abs().lt(simd.f32(1_048_576.0)), simd.f32(0.0))
    }

    /// Adds an octave: its value and slopes, scaled by its amplitude and slope factor. Slopes exist with `SLOPES` and
    /// if the combination needs them; `axes` is their number.
    #[inline(always)]
    pub(crate) fn add<const SLOPES: bool>(
        &mut self,
        simd: S,
        combine: &Combine,
        octave: &Octave,
        one: &Sample<S>,
        axes: usize,
    ) {
        let kept = if SLOPES { axes } else { 0 };
        match *combine {
            Combine::Sum => {
                for place in 0..=kept {
                    self.sum[place] = self.sum[place] + one[place];
                }
            }
            Combine::Sizes { .. } => add_size(simd, &mut self.sum, one, kept),
            Combine::Weighted { k, falloff, .. } => {
                add_weighted::<S, SLOPES>(simd, &mut self.sum, &mut self.slope, one, (k, falloff), axes);
            }
            Combine::Shaped { shape, .. } => self.add_shaped::<SLOPES>(simd, shape, octave, one, axes),
        }
    }

    /// [`State::add`] for shapes.
    #[inline(always)]
    fn add_shaped<const SLOPES: bool>(&mut self, simd: S, shape: Shape, octave: &Octave, one: &Sample<S>, axes: usize) {
        let kept = if SLOPES { axes } else { 0 };
        let (zero, unit, gain) = (simd.f32(0.0), simd.f32(1.0), simd.f32(octave.gain));
        let noise = one[0];
        match shape {
            Shape::PingPong { strength } => {
                let strength = simd.f32(strength);
                let t = (noise + unit) * strength;
                let t = (t * simd.f32(0.5)).floor().mul_add(simd.f32(-2.0), t);
                let rising = t.lt(unit);
                let folded = t.select(rising, simd.f32(2.0) - t);
                self.sum[0] = (folded * simd.f32(2.0) - unit).mul_add(gain, self.sum[0]);
                let steep = gain * strength * simd.f32(2.0);
                let steep = steep.select(rising, -steep);
                for axis in 1..=kept {
                    self.sum[axis] = one[axis].mul_add(steep, self.sum[axis]);
                }
            }
            Shape::Hybrid { offset } => {
                let signal = (noise + simd.f32(offset)) * gain;
                let weighted = self.weight * signal;
                self.sum[0] = self.sum[0] + weighted;
                let held = weighted.max(zero).min(unit);
                for axis in 1..=kept {
                    let slope = self.slope[axis].mul_add(signal, self.weight * gain * one[axis]);
                    self.sum[axis] = self.sum[axis] + slope;
                    self.slope[axis] = slope.select(held.eq(weighted), zero);
                }
                self.weight = held;
            }
            Shape::Hetero { offset } => {
                // The weight is the height so far, or 1 for the first octave.
                let signal = (noise + simd.f32(offset)) * gain;
                let added = self.weight * signal;
                for axis in 1..=kept {
                    let slope = self.sum[axis].mul_add(signal, self.weight * gain * one[axis]);
                    self.sum[axis] = self.sum[axis] + slope;
                }
                self.sum[0] = self.sum[0] + added;
                self.weight = self.sum[0];
            }
            Shape::Swiss { .. } => {
                let amplitude = self.weight * gain;
                let cells = simd.f32((1.0 / octave.ratio) as f32);
                self.sum[0] = amplitude.mul_add(unit - noise.abs(), self.sum[0]);
                let sign = noise.bits() & simd.u32(0x8000_0000);
                for axis in 1..=axes {
                    self.slope[axis] = (amplitude * noise).neg_mul_add(one[axis] * cells, self.slope[axis]);
                    if SLOPES {
                        let down = (one[axis].bits() ^ sign).as_f32();
                        self.sum[axis] = amplitude.neg_mul_add(down, self.sum[axis]);
                    }
                }
                self.weight = self.weight * self.sum[0].max(zero).min(unit);
            }
            Shape::Jordan { damp, .. } => {
                let cells = simd.f32((1.0 / octave.ratio) as f32);
                let amplitude = gain * self.weight;
                self.sum[0] = (amplitude * noise).mul_add(noise, self.sum[0]);
                let mut squared = zero;
                for axis in 1..=axes {
                    self.slope[axis] = noise.mul_add(one[axis] * cells, self.slope[axis]);
                    let damped = self.slope[axis] * simd.f32(damp);
                    squared = damped.mul_add(damped, squared);
                    if SLOPES {
                        self.sum[axis] = (amplitude * noise * simd.f32(2.0)).mul_add(one[axis], self.sum[axis]);
                    }
                }
                self.weight = unit - unit / (squared + unit);
            }
        }
    }

    /// The computations after the last octave.
    #[inline(always)]
    pub(crate) fn finish<const SLOPES: bool>(&mut self, simd: S, combine: &Combine, axes: usize) {
        let kept = if SLOPES { axes } else { 0 };
        match *combine {
            Combine::Sum => {}
            Combine::Sizes { sign } => finish_sizes(simd, &mut self.sum, sign, kept),
            Combine::Weighted { gradient, .. } => {
                for axis in 1..=kept {
                    self.sum[axis] = self.sum[axis] * simd.f32(gradient);
                }
            }
            Combine::Shaped { shape, scale, gradient } => {
                let (one, most) = (simd.f32(1.0), simd.f32(f32::MAX));
                let mut gradient = gradient;
                self.sum[0] = self.sum[0] * simd.f32(scale);
                if matches!(shape, Shape::Swiss { .. } | Shape::Jordan { .. }) {
                    // The sums of these shapes start at 0.
                    self.sum[0] = self.sum[0] * simd.f32(2.0) - one;
                    gradient *= 2.0;
                }
                self.sum[0] = self.sum[0].max(-one).min(one);
                for axis in 1..=kept {
                    let slope = self.sum[axis] * simd.f32(gradient);
                    self.sum[axis] = slope.select(slope.abs().lt(most), simd.f32(0.0));
                }
            }
        }
    }
}

/// Adds the absolute value of an octave to a sum. Slopes change their sign with the value.
#[inline(always)]
pub(crate) fn add_size<S: Simd>(simd: S, sum: &mut Sample<S>, octave: &Sample<S>, axes: usize) {
    let sign = octave[0].bits() & simd.u32(0x8000_0000);
    sum[0] = sum[0] + octave[0].abs();
    for axis in 1..=axes {
        sum[axis] = sum[axis] + (octave[axis].bits() ^ sign).as_f32();
    }
}

/// Maps a sum of absolute values, 0 to 2, to ridged (sign -1) or billow (sign 1) noise.
#[inline(always)]
pub(crate) fn finish_sizes<S: Simd>(simd: S, sum: &mut Sample<S>, sign: f32, axes: usize) {
    let sign = simd.f32(sign);
    sum[0] = (sum[0] - simd.f32(1.0)) * sign;
    for axis in 1..=axes {
        sum[axis] = sum[axis] * sign;
    }
}

/// Adds one octave to a weighted sum. `slope` is the slope of the plain sum so far (indices 1 to 3). The slopes of the
/// weighted sum are computed only with `SLOPES`.
#[inline(always)]
pub(crate) fn add_weighted<S: Simd, const SLOPES: bool>(
    simd: S,
    sum: &mut Sample<S>,
    slope: &mut Sample<S>,
    octave: &Sample<S>,
    (k, falloff): (f32, Falloff),
    axes: usize,
) {
    let mut squared = simd.f32(0.0);
    for axis in 1..=axes {
        slope[axis] = slope[axis] + octave[axis];
        squared = slope[axis].mul_add(slope[axis], squared);
    }
    let weight = damping(simd, squared, k, falloff);
    sum[0] = octave[0].mul_add(weight, sum[0]);
    if SLOPES {
        for axis in 1..=axes {
            sum[axis] = octave[axis].mul_add(weight, sum[axis]);
        }
    }
}

/// The factor of an octave for a squared slope.
#[inline(always)]
fn damping<S: Simd>(simd: S, squared: S::F32, k: f32, falloff: Falloff) -> S::F32 {
    let (one, k) = (simd.f32(1.0), simd.f32(k));
    match falloff {
        Falloff::Reciprocal => one / squared.mul_add(k, one),
        Falloff::SquareRoot => one / squared.sqrt().mul_add(k, one),
        Falloff::Smoothstep => {
            let t = (squared * k).min(one);
            (t * t).neg_mul_add(t.mul_add(simd.f32(-2.0), simd.f32(3.0)), one)
        }
        Falloff::Exponential => exp_minus(simd, squared * k),
    }
}

/// e^-x for x >= 0, within 3 units in the last place. Results below e^-87 become e^-87.
#[inline(always)]
pub(crate) fn exp_minus<S: Simd>(simd: S, x: S::F32) -> S::F32 {
    let x = x.min(simd.f32(87.0));
    // x = n ln 2 + r. ln 2 is split into two parts, so that r keeps its precision.
    let n = x.mul_add(simd.f32(std::f32::consts::LOG2_E), simd.f32(0.5)).floor();
    let r = n.neg_mul_add(simd.f32(1.428_606_8e-6), n.neg_mul_add(simd.f32(0.693_145_75), x));
    // The Taylor polynomial of e^-r for |r| up to ln 2 / 2.
    let mut e = simd.f32(1.0 / 720.0);
    for c in [-1.0 / 120.0, 1.0 / 24.0, -1.0 / 6.0, 0.5, -1.0, 1.0] {
        e = e.mul_add(r, simd.f32(c));
    }
    // Times 2^-n, by the exponent; n is at most 126.
    let power = (simd.u32(127) - n.to_i32()).shl(23).as_f32();
    e * power
}
