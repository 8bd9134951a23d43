//! Splits positions into cells and fractions.

use crate::program::Octave;
use orogen_simd::{F32Lanes, F64Lanes, Simd, U32Lanes};

/// 1.5 * 2^28. Adding it to a number with an absolute value below 2^27 rounds the number to a multiple of 2^-24.
const SNAP: f64 = 402_653_184.0;

/// Lanes of one coordinate, split into cell and fraction.
#[derive(Clone, Copy)]
pub(crate) struct Cell<S: Simd> {
    /// The cell's number.
    pub whole: S::F64,
    /// Low word of the cell number in two's complement.
    pub low: S::U32,
    /// High word of the cell number, plus a constant.
    pub high: S::U32,
    /// Fraction in the cell, from 0 to 1. It is 1 if f32 rounds it up. All noises are continuous there, so the value is
    /// that of the next cell at 0.
    pub t: S::F32,
}

/// The coordinate of a position along an axis, in cells of the octave. The position must be within the program's limit.
#[inline(always)]
pub(crate) fn coordinate<S: Simd>(simd: S, octave: &Octave, axis: usize, position: S::F64) -> S::F64 {
    snapped(simd, octave, position * simd.f64(octave.frequency) + simd.f64(octave.offset[axis]))
}

/// The coordinate displaced by a number of cells.
#[inline(always)]
pub(crate) fn moved<S: Simd>(simd: S, octave: &Octave, coordinate: S::F64, by: S::F32) -> S::F64 {
    coordinate + snapped(simd, octave, by.widen())
}

/// Rounds coordinates of repeating lattices, so that both sides of a seam agree.
#[inline(always)]
fn snapped<S: Simd>(simd: S, octave: &Octave, u: S::F64) -> S::F64 {
    if octave.tiled { (u + simd.f64(SNAP)) - simd.f64(SNAP) } else { u }
}

impl<S: Simd> Cell<S> {
    /// The cell and fraction of a position along an axis of the octave. The position must be within the program's
    /// limit.
    #[inline(always)]
    pub(crate) fn split(simd: S, octave: &Octave, axis: usize, position: S::F64) -> Cell<S> {
        Cell::of(simd, coordinate(simd, octave, axis, position))
    }

    /// The cell and fraction of a coordinate in cells.
    #[inline(always)]
    pub(crate) fn of(simd: S, u: S::F64) -> Cell<S> {
        let (whole, low, high) = simd.whole(u);
        Cell { whole, low, high, t: (u - whole).narrow() }
    }

    /// The lower edge of the cell with this number.
    #[inline(always)]
    pub(crate) fn at(simd: S, whole: S::F64) -> Cell<S> {
        let (_, low, high) = simd.whole(whole);
        Cell { whole, low, high, t: simd.f32(0.0) }
    }

    /// The high word of the next cell.
    #[inline(always)]
    pub(crate) fn next_high(&self, simd: S) -> S::U32 {
        let carried = self.high + simd.u32(1);
        carried.select(self.low.eq(simd.u32(u32::MAX)), self.high)
    }
}

impl<S: Simd> Cell<S> {
    /// Low and high words of the cell and of the next one, modulo the period.
    #[inline(always)]
    pub(crate) fn around(&self, simd: S, period: f64) -> [[S::U32; 2]; 2] {
        let next = self.whole + simd.f64(1.0);
        [Self::wrapped(simd, self.whole, period), Self::wrapped(simd, next, period)]
    }

    #[inline(always)]
    fn wrapped(simd: S, whole: S::F64, period: f64) -> [S::U32; 2] {
        // The center of a cell is far enough from the ends of a period that rounding cannot move it across them.
        let turns = ((whole + simd.f64(0.5)) * simd.f64(1.0 / period)).floor();
        let (_, low, high) = simd.whole(whole - turns * simd.f64(period));
        [low, high]
    }
}

/// Positions clamped to the limit; NaN becomes its lower end.
#[inline(always)]
pub(crate) fn clamp<S: Simd>(simd: S, position: S::F64, limit: f64) -> S::F64 {
    position.max(simd.f64(-limit)).min(simd.f64(limit))
}
