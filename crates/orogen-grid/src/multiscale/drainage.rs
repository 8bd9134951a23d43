//! One step of drainage areas: each cell adds up the previous areas of its donors.

use super::stencil::Extent;
use crate::hydrology::direction::NONE;
use orogen_simd::{Body, Simd, dispatch};

/// In planes of fixed receivers: a node that may choose its receiver.
pub const FREE: f32 = -1.0;

/// In planes of fixed receivers: water.
pub const WATER: f32 = NONE as f32;

/// Replaces `area` over `extent` by 1, or the rain of the cell, plus the previous areas of the donors. `spare` is
/// scratch memory. The terms are added in the order of directions, so sums have the same bits in every window.
/// Receivers are codes of directions.
pub fn step(extent: Extent, rain: Option<&[f32]>, receiver: &[f32], area: &mut Vec<f32>, spare: &mut Vec<f32>) {
    dispatch(Step { extent, rain, receiver, area, out: spare });
    std::mem::swap(area, spare);
}

struct Step<'a> {
    extent: Extent,
    rain: Option<&'a [f32]>,
    receiver: &'a [f32],
    area: &'a [f32],
    out: &'a mut [f32],
}

impl Body for Step<'_> {
    type Output = ();

    #[inline(always)]
    fn run<S: Simd>(self, _: S) {
        for j in self.extent.rows() {
            let (receivers, areas) = (self.extent.around(self.receiver, j), self.extent.around(self.area, j));
            let out = self.extent.row_mut(self.out, j);
            match self.rain {
                None => out.fill(1.0),
                Some(rain) => out.copy_from_slice(self.extent.row(rain, j)),
            }
            sum(receivers, areas, out);
        }
    }
}

#[inline(always)]
fn sum(receivers: [&[f32]; 8], areas: [&[f32]; 8], out: &mut [f32]) {
    let n = out.len();
    let (receivers, areas) = (receivers.map(|row| &row[..n]), areas.map(|row| &row[..n]));
    for i in 0..n {
        let mut total = out[i];
        for code in 0..8 {
            // The neighbor drains here if its receiver is in the opposite direction.
            let back = ((code + 4) & 7) as f32;
            total += if receivers[code][i] == back { areas[code][i] } else { 0.0 };
        }
        out[i] = total;
    }
}

/// Limits areas to the previous area of the receiver.
pub fn limit(extent: Extent, receiver: &[f32], area: &mut Vec<f32>, spare: &mut Vec<f32>) {
    dispatch(Limit { extent, receiver, area, out: spare });
    std::mem::swap(area, spare);
}

struct Limit<'a> {
    extent: Extent,
    receiver: &'a [f32],
    area: &'a [f32],
    out: &'a mut [f32],
}

impl Body for Limit<'_> {
    type Output = ();

    #[inline(always)]
    fn run<S: Simd>(self, _: S) {
        for j in self.extent.rows() {
            let own = [self.extent.row(self.receiver, j), self.extent.row(self.area, j)];
            lower(own, self.extent.around(self.area, j), self.extent.row_mut(self.out, j));
        }
    }
}

#[inline(always)]
fn lower([receiver, area]: [&[f32]; 2], areas: [&[f32]; 8], out: &mut [f32]) {
    let n = out.len();
    let (receiver, area, areas) = (&receiver[..n], &area[..n], areas.map(|row| &row[..n]));
    for i in 0..n {
        let mut least = area[i];
        for (code, there) in areas.iter().enumerate() {
            let lower = (receiver[i] == code as f32) & (there[i] < least);
            least = if lower { there[i] } else { least };
        }
        out[i] = least;
    }
}

/// Raises areas to the previous areas of their donors.
pub fn raise(extent: Extent, receiver: &[f32], area: &mut Vec<f32>, spare: &mut Vec<f32>) {
    dispatch(Raise { extent, receiver, area, out: spare });
    std::mem::swap(area, spare);
}

struct Raise<'a> {
    extent: Extent,
    receiver: &'a [f32],
    area: &'a [f32],
    out: &'a mut [f32],
}

impl Body for Raise<'_> {
    type Output = ();

    #[inline(always)]
    fn run<S: Simd>(self, _: S) {
        for j in self.extent.rows() {
            let (receivers, areas) = (self.extent.around(self.receiver, j), self.extent.around(self.area, j));
            higher(self.extent.row(self.area, j), receivers, areas, self.extent.row_mut(self.out, j));
        }
    }
}

#[inline(always)]
fn higher(area: &[f32], receivers: [&[f32]; 8], areas: [&[f32]; 8], out: &mut [f32]) {
    let n = out.len();
    let area = &area[..n];
    let (receivers, areas) = (receivers.map(|row| &row[..n]), areas.map(|row| &row[..n]));
    for i in 0..n {
        let mut most = area[i];
        for code in 0..8 {
            let back = ((code + 4) & 7) as f32;
            let higher = (receivers[code][i] == back) & (areas[code][i] > most);
            most = if higher { areas[code][i] } else { most };
        }
        out[i] = most;
    }
}
