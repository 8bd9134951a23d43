//! One step of drainage areas: each cell adds up what its donors had.

use super::stencil::Extent;
use orogen_simd::{Body, Simd, dispatch};

/// Replaces `area` by 1 plus the areas of the donors before, over `extent`; `spare` is scratch memory. Sums are in the order of directions, so
/// they have the same bits in every window. Receivers are codes of directions.
pub fn step(extent: Extent, receiver: &[f32], area: &mut Vec<f32>, spare: &mut Vec<f32>) {
    dispatch(Step { extent, receiver, area, out: spare });
    std::mem::swap(area, spare);
}

struct Step<'a> {
    extent: Extent,
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
            sum(receivers, areas, self.extent.row_mut(self.out, j));
        }
    }
}

#[inline(always)]
fn sum(receivers: [&[f32]; 8], areas: [&[f32]; 8], out: &mut [f32]) {
    let n = out.len();
    let (receivers, areas) = (receivers.map(|row| &row[..n]), areas.map(|row| &row[..n]));
    for i in 0..n {
        let mut total = 1.0;
        for code in 0..8 {
            // The neighbour drains here if its receiver is in the opposite direction.
            let back = ((code + 4) & 7) as f32;
            total += if receivers[code][i] == back { areas[code][i] } else { 0.0 };
        }
        out[i] = total;
    }
}
