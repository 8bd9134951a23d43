//! Distances between the nodes of neighboring cells. Of the two diagonals of four cells, one is open.

use super::stencil::Extent;
use crate::hydrology::direction::STEPS;

/// The distance across a closed diagonal, larger than any other.
pub const CLOSED: f32 = 1e30;

/// The minimum distance between two nodes, in cells, because nodes of adjacent cells may nearly coincide.
const NEAREST: f32 = 0.35;

/// Distances in cells from each node to its neighbors in the east, south-east, south and south-west. Of the two
/// diagonals of four cells only the shorter one is open, so that links never cross.
pub struct Distances {
    pub planes: [Vec<f32>; 4],
}

impl Distances {
    /// The distances between nodes at the positions `east` and `south` in their cells.
    pub fn new(extent: Extent, east: &[f32], south: &[f32]) -> Distances {
        let width = extent.width;
        let mut planes: [Vec<f32>; 4] = std::array::from_fn(|_| vec![CLOSED; extent.len()]);
        for j in 0..extent.height.saturating_sub(1) {
            for i in 0..width.saturating_sub(1) {
                let (q, below) = (j * width + i, (j + 1) * width + i);
                let distance = |from: usize, to: usize, code: usize| between(from, to, STEPS[code], east, south);
                planes[0][q] = distance(q, q + 1, 0);
                planes[2][q] = distance(q, below, 2);
                let (falling, rising) = (distance(q, below + 1, 1), distance(q + 1, below, 3));
                if falling < rising {
                    planes[1][q] = falling;
                } else {
                    planes[3][q + 1] = rising;
                }
            }
        }
        Distances { planes }
    }

    /// Opens the diagonal link from cell `q` in direction `code`, and closes the diagonal that crosses it. Links along
    /// the axes do not change.
    pub fn open(&mut self, q: usize, code: u8, width: usize, east: &[f32], south: &[f32]) {
        // The north-western of the four cells around the corner.
        let corner = match code {
            1 => q,
            3 => q - 1,
            5 => q - width - 1,
            7 => q - width,
            _ => return,
        };
        let [_, falling, _, rising] = &mut self.planes;
        if code & 3 == 1 {
            falling[corner] = between(corner, corner + width + 1, STEPS[1], east, south);
            rising[corner + 1] = CLOSED;
        } else {
            rising[corner + 1] = between(corner + 1, corner + width, STEPS[3], east, south);
            falling[corner] = CLOSED;
        }
    }

    /// The distances from the cells of row `j` to their neighbors, in the order of [`STEPS`].
    #[inline(always)]
    pub fn around(&self, extent: Extent, j: usize) -> [&[f32]; 8] {
        let opposite = |code: usize| extent.around(&self.planes[code], j)[code + 4];
        let direct = |code: usize| extent.row(&self.planes[code], j);
        [direct(0), direct(1), direct(2), direct(3), opposite(0), opposite(1), opposite(2), opposite(3)]
    }
}

#[inline(always)]
fn between(from: usize, to: usize, step: (isize, isize), east: &[f32], south: &[f32]) -> f32 {
    let x = east[to] - east[from] + step.0 as f32;
    let y = south[to] - south[from] + step.1 as f32;
    let distance = (x * x + y * y).sqrt();
    if distance > NEAREST { distance } else { NEAREST }
}
