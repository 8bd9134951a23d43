//! From positions to cells and fractions.

use orogen_simd::{F64Lanes, Simd, U32Lanes};

/// Lanes of one coordinate, split.
#[derive(Clone, Copy)]
pub(crate) struct Cell<S: Simd> {
    /// The cell's number.
    pub whole: S::F64,
    /// Low word of the cell's number in two's complement.
    pub low: S::U32,
    /// High word, plus a constant.
    pub high: S::U32,
    /// How far into the cell, from 0 to 1. It is 1 where the fraction is so close that f32 rounds it up; every noise here is
    /// continuous there, so the value is the next cell's at 0.
    pub t: S::F32,
}

impl<S: Simd> Cell<S> {
    /// The cell and fraction of `position * frequency + offset`. The position is within the program's limit.
    #[inline(always)]
    pub(crate) fn split(simd: S, position: S::F64, frequency: S::F64, offset: S::F64) -> Cell<S> {
        let u = position * frequency + offset;
        let (whole, low, high) = simd.whole(u);
        Cell { whole, low, high, t: (u - whole).narrow() }
    }

    /// The lower edge of the cell of that number.
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

/// Positions held within the limit; NaN becomes its lower end.
#[inline(always)]
pub(crate) fn clamp<S: Simd>(simd: S, position: S::F64, limit: f64) -> S::F64 {
    position.max(simd.f64(-limit)).min(simd.f64(limit))
}
