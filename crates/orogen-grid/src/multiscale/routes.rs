//! Cheapest paths from all nodes to bases, by passes over links with costs.

use super::distances::{CLOSED, Distances};
use super::stencil::Extent;
use crate::hydrology::direction::{NONE, STEPS};
use orogen_simd::{Body, Simd, dispatch};

/// Height of nodes that no link connects to a base.
pub const UNREACHED: f32 = 1e29;

/// The parameters of the costs of links.
pub struct Nodes<'a> {
    pub east: &'a [f32],
    pub south: &'a [f32],
    /// Rise per cell of distance.
    pub cost: &'a [f32],
    /// Factor of the cost of links from nodes in the north and west.
    pub detour: &'a [f32],
}

/// The rise along each link; closed diagonals have a rise beyond any other.
pub fn links(extent: Extent, nodes: &Nodes<'_>) -> Distances {
    let mut links = Distances::new(extent, nodes.east, nodes.south);
    for (plane, (east, south)) in links.planes.iter_mut().zip(STEPS) {
        let stride = (south * extent.width as isize + east) as usize;
        for (q, link) in plane.iter_mut().enumerate() {
            if *link < CLOSED {
                *link *= 0.5 * (nodes.cost[q] + nodes.cost[q + stride]) * nodes.detour[q + stride];
            }
        }
    }
    links
}

/// One pass: limits every height to the height of each neighbor plus the rise of the link to it.
pub fn relax(extent: Extent, links: &Distances, heights: &mut Vec<f32>, spare: &mut Vec<f32>) {
    dispatch(Relax { extent, links, heights, out: spare });
    std::mem::swap(heights, spare);
}

struct Relax<'a> {
    extent: Extent,
    links: &'a Distances,
    heights: &'a [f32],
    out: &'a mut [f32],
}

impl Body for Relax<'_> {
    type Output = ();

    #[inline(always)]
    fn run<S: Simd>(self, _: S) {
        let extent = self.extent;
        for j in extent.rows() {
            let (around, links) = (extent.around(self.heights, j), self.links.around(extent, j));
            lowest(extent.row(self.heights, j), around, links, extent.row_mut(self.out, j));
        }
    }
}

#[inline(always)]
fn lowest(heights: &[f32], around: [&[f32]; 8], links: [&[f32]; 8], out: &mut [f32]) {
    let n = out.len();
    let (heights, around, links) = (&heights[..n], around.map(|row| &row[..n]), links.map(|row| &row[..n]));
    for i in 0..n {
        let mut lowest = heights[i];
        for code in 0..8 {
            let height = around[code][i] + links[code][i];
            lowest = if height < lowest { height } else { lowest };
        }
        out[i] = lowest;
    }
}

/// The receivers of all nodes: the lower neighbor with the cheapest path. Nodes that are still at their `start` are
/// bases.
pub fn route(extent: Extent, links: &Distances, heights: &[f32], start: &[f32], receiver: &mut [f32]) {
    for j in extent.rows() {
        let (around, links) = (extent.around(heights, j), links.around(extent, j));
        let (heights, start) = (extent.row(heights, j), extent.row(start, j));
        for (i, receiver) in extent.row_mut(receiver, j).iter_mut().enumerate() {
            let (mut best, mut lowest) = (NONE, UNREACHED);
            for code in 0..NONE {
                let (there, link) = (around[usize::from(code)][i], links[usize::from(code)][i]);
                if there < heights[i] && there + link < lowest {
                    (best, lowest) = (code, there + link);
                }
            }
            // A base has a start below every height that links lead to.
            let is_base = start[i] < UNREACHED && heights[i] >= start[i];
            *receiver = f32::from(if is_base { NONE } else { best });
        }
    }
}
