//! Soil creep: linear diffusion, which rounds the terrain that rivers have eroded.

use super::outlets::Outlets;
use crate::error::Result;
use crate::grid::{Grid, Window};
use crate::parallel;
use crate::progress::Progress;

/// Linear diffusion of the heights, dh/dt = D (d2h/dx2 + d2h/dy2) (Culling 1960). `amount` is D times the time, in m^2.
/// Outlets keep their heights.
///
/// The nine-point Laplacian (4 for a side, 1 for a corner, over 6) has an isotropic error. Time is advanced with the
/// stages of Runge-Kutta-Legendre (Meyer, Balsara and Aslam 2014, first order): s stages are stable for s (s + 1) / 2
/// times the longest explicit step. The time is O(cells) times 1 + 5.3 sqrt(amount) / cell. Rows are computed in
/// parallel. The diffusion length is limited to the width of the map.
///
/// # Errors
/// If the work is cancelled.
pub fn creep(heights: &mut Grid, outlets: &Outlets, amount: f64, progress: &Progress) -> Result<()> {
    creep_again(heights, outlets, amount, &mut Vec::new(), progress)
}

/// The amount in squared cells, the number of strides, and the number of stages in each stride. `None` if nothing
/// changes.
fn strides(window: &Window, amount: f64) -> Option<[f64; 3]> {
    let widest = (window.width * window.width + window.height * window.height) as f64;
    let whole = (amount / (window.cell * window.cell)).min(widest);
    if window.width < 3 || window.height < 3 || !(whole > 0.0 && whole.is_finite()) {
        return None;
    }
    // A single stride of many stages oscillates. After four strides the remaining oscillation is invisible.
    let strides = if whole > LONGEST { 4.0 } else { 1.0 };
    let mut stages = 1.0;
    while LONGEST * stages * (stages + 1.0) / 2.0 < whole / strides {
        stages += 1.0;
    }
    Some([whole, strides, stages])
}

/// The number of passes over the map.
pub(super) fn creep_stages(window: &Window, amount: f64) -> f64 {
    strides(window, amount).map_or(0.0, |[_, strides, stages]| strides * stages)
}

/// The number of strides, the number of stages in each stride, and the amount of a stage in squared cells, before the
/// stage's own factor. `None` if nothing changes.
#[doc(hidden)]
#[must_use]
pub fn creep_strides(window: &Window, amount: f64) -> Option<[f64; 3]> {
    let [whole, strides, stages] = strides(window, amount)?;
    Some([strides, stages, whole / strides * 2.0 / (stages * (stages + 1.0))])
}

/// [`creep`] for repeated use on one map. `buffers` must be empty at first and avoids new allocations.
pub(super) fn creep_again(
    heights: &mut Grid,
    outlets: &Outlets,
    amount: f64,
    buffers: &mut Vec<Grid>,
    progress: &Progress,
) -> Result<()> {
    let Some([strides, stages, share]) = creep_strides(heights.window(), amount) else { return Ok(()) };
    progress.expect(strides * stages);
    buffers.resize_with(2, || heights.clone());
    let [last, next] = &mut buffers[..] else { return Ok(()) };
    [&mut *last, &mut *next].into_iter().for_each(|buffer| buffer.data_mut().copy_from_slice(heights.data()));
    for stage in (0..strides as u64).flat_map(|_| 1..=stages as u64) {
        // Y_j = mu Y_(j-1) + nu Y_(j-2) + mu share L Y_(j-1), with mu = (2j - 1) / j and nu = (1 - j) / j.
        let j = stage as f64;
        let factors = [(j - 1.0) / j, (2.0 * j - 1.0) / j * share / 6.0].map(|factor| factor as f32);
        progress.check()?;
        advance(heights, last, outlets, factors, next);
        std::mem::swap(last, heights);
        std::mem::swap(heights, next);
        progress.advance(1.0);
    }
    Ok(())
}

/// The longest explicit step, in squared cells. Beyond 0.3 a cell would lose more than it has.
const LONGEST: f64 = 0.29;

/// One stage: extrapolates the change from `last` to `here` by the first factor, and adds the inflow times the second.
fn advance(here: &Grid, last: &Grid, outlets: &Outlets, [again, share]: [f32; 2], next: &mut Grid) {
    let (width, height) = (here.width(), here.height());
    let rows = next.data_mut().chunks_mut(width).enumerate().take(height.max(1) - 1).skip(1);
    parallel::for_each(rows, |(j, row)| {
        let interleaved = here.row(j - 1).windows(3).zip(here.row(j).windows(3)).zip(here.row(j + 1).windows(3));
        let places = row[1..].iter_mut().zip(&outlets.mask().row(j)[1..]).zip(&last.row(j)[1..]);
        for (((new, outlet), last), ((n, m), s)) in places.zip(interleaved) {
            let sides = (n[1] - m[1]) + (m[0] - m[1]) + (m[2] - m[1]) + (s[1] - m[1]);
            let corners = (n[0] - m[1]) + (n[2] - m[1]) + (s[0] - m[1]) + (s[2] - m[1]);
            let moved = m[1] + again * (m[1] - last) + share * (4.0 * sides + corners);
            *new = if *outlet { m[1] } else { moved };
        }
    });
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::grid::Window;
    use crate::hydrology::samples;

    #[test]
    fn a_point_spreads_as_a_gaussian() {
        // After D t the variance of a point source is 2 D t along each axis, and mass is conserved.
        for amount in [20.0, 300.0, 900.0, 1600.0] {
            spreads(amount);
        }
    }

    fn spreads(amount: f64) {
        let mut heights = Grid::filled(Window::new(61, 61, 10.0), 0.0);
        heights.row_mut(30)[30] = 1000.0;
        let outlets = Outlets::new(&heights, None);
        creep(&mut heights, &outlets, amount, &Progress::none()).unwrap();
        let (mut sum, mut east, mut across) = (0.0, 0.0, 0.0);
        for j in 0..61 {
            for i in 0..61 {
                let (h, x, y) = (f64::from(heights[(i, j)]), (i as f64 - 30.0) * 10.0, (j as f64 - 30.0) * 10.0);
                sum += h;
                east += h * x * x;
                across += h * (x + y) * (x + y) / 2.0;
            }
        }
        assert!((sum - 1000.0).abs() < 0.1, "{sum}");
        for variance in [east / sum, across / sum] {
            assert!((variance / (2.0 * amount) - 1.0).abs() < 0.005, "{amount}: {variance}");
        }
        let lowest = heights.data().iter().copied().fold(0.0, f32::min);
        assert!(lowest > -0.01, "{amount}: {lowest}");
    }

    #[test]
    fn outlets_and_holes_stay() {
        for heights in samples::grids() {
            let outlets = Outlets::new(&heights, Some(300.0));
            let mut crept = heights.clone();
            creep(&mut crept, &outlets, 0.7, &Progress::none()).unwrap();
            for (c, (new, old)) in crept.data().iter().zip(heights.data()).enumerate() {
                if outlets.at(c) {
                    assert_eq!(new.to_bits(), old.to_bits());
                } else {
                    assert!(new.is_finite());
                }
            }
        }
    }

    #[test]
    fn endless_creep_ends_level_between_its_outlets() {
        let mut heights = samples::hills(40, 30, 2);
        for j in 0..30 {
            for i in 0..40 {
                if i == 0 || j == 0 || i == 39 || j == 29 {
                    heights.row_mut(j)[i] = 100.0;
                }
            }
        }
        let outlets = Outlets::new(&heights, None);
        creep(&mut heights, &outlets, 1e30, &Progress::none()).unwrap();
        let farthest = heights.data().iter().map(|h| (h - 100.0).abs()).fold(0.0, f32::max);
        assert!(farthest < 4.0, "of hills of 600 m there is left {farthest}");
    }
}
