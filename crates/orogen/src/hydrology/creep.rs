//! Soil creeps downhill and rounds what rivers have cut.

use super::outlets::Outlets;
use crate::grid::Grid;
use rayon::prelude::*;

/// Linear diffusion of the heights, dh/dt = D (d2h/dx2 + d2h/dy2) (Culling 1960): `amount` is D times the time, in m^2. Outlets
/// stay as they are.
///
/// Explicit steps, each small enough to be stable, with the nine-point Laplacian (4 for a side, 1 for a corner, over 6), whose
/// error is the same in all directions. Costs O(cells) times 1 + 5 amount / cell^2; rows side by side.
pub fn creep(heights: &mut Grid, outlets: &Outlets, amount: f64) {
    let window = *heights.window();
    let whole = amount / (window.cell * window.cell);
    if window.width < 3 || window.height < 3 || !(whole > 0.0 && whole.is_finite()) {
        return;
    }
    let steps = (whole / LARGEST).ceil().max(1.0);
    let share = (whole / steps / 6.0) as f32;
    let mut next = heights.clone();
    for _ in 0..steps as u64 {
        let rows = next.data_mut().par_chunks_mut(window.width).enumerate();
        rows.filter(|(j, _)| *j > 0 && j + 1 < window.height).for_each(|(j, row)| {
            let [above, here, below] = [heights.row(j - 1), heights.row(j), heights.row(j + 1)];
            let triples = above.windows(3).zip(here.windows(3)).zip(below.windows(3));
            let places = row[1..].iter_mut().zip(&outlets.mask().row(j)[1..]);
            for ((new, outlet), ((n, m), s)) in places.zip(triples) {
                let sides = (n[1] - m[1]) + (m[0] - m[1]) + (m[2] - m[1]) + (s[1] - m[1]);
                let corners = (n[0] - m[1]) + (n[2] - m[1]) + (s[0] - m[1]) + (s[2] - m[1]);
                let moved = m[1] + share * (4.0 * sides + corners);
                *new = if *outlet { m[1] } else { moved };
            }
        });
        std::mem::swap(heights, &mut next);
    }
}

/// The most that one step may move, in squares of the cell.
const LARGEST: f64 = 0.2;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::grid::Window;
    use crate::hydrology::samples;

    #[test]
    fn a_point_spreads_as_a_gaussian() {
        // After D t the variance of what was one point is 2 D t along each axis, and nothing is lost.
        let mut heights = Grid::filled(Window::new(61, 61, 10.0), 0.0);
        heights.row_mut(30)[30] = 1000.0;
        let outlets = Outlets::new(&heights, None);
        creep(&mut heights, &outlets, 900.0);
        let (mut sum, mut east, mut across) = (0.0, 0.0, 0.0);
        for j in 0..61 {
            for i in 0..61 {
                let (h, x, y) = (f64::from(heights.get(i, j)), (i as f64 - 30.0) * 10.0, (j as f64 - 30.0) * 10.0);
                sum += h;
                east += h * x * x;
                across += h * (x + y) * (x + y) / 2.0;
            }
        }
        assert!((sum - 1000.0).abs() < 0.01, "{sum}");
        assert!((east / sum / 1800.0 - 1.0).abs() < 0.001 && (across / sum / 1800.0 - 1.0).abs() < 0.001);
    }

    #[test]
    fn outlets_and_holes_stay() {
        for heights in samples::grids() {
            let outlets = Outlets::new(&heights, Some(300.0));
            let mut crept = heights.clone();
            creep(&mut crept, &outlets, 0.7);
            for (c, (new, old)) in crept.data().iter().zip(heights.data()).enumerate() {
                if outlets.at(c) {
                    assert_eq!(new.to_bits(), old.to_bits());
                } else {
                    assert!(new.is_finite());
                }
            }
        }
    }
}
