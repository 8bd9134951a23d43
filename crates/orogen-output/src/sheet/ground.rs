//! Resampling of a sheet's heights to the resolution of the page.

use orogen_grid::parallel;
use orogen_noise::Points;

use orogen_engine::layer::LayerKind;
use orogen_grid::grid::{Grid, Window};
use orogen_grid::resample;

/// A grid of `size` samples over the extent of `heights`, with the same corners. If there are fewer samples, each is a
/// local mean; if there are more, they are interpolated with the interpolating cubic.
pub fn laid(heights: &Grid, size: [usize; 2]) -> Grid {
    let window = heights.window();
    let at = |count: usize, samples: usize| {
        let step = (samples.saturating_sub(1)) as f64 / (count.saturating_sub(1)).max(1) as f64;
        (0..count).map(|k| k as f64 * step).collect::<Vec<f64>>()
    };
    read(heights, &at(size[0], window.width), &at(size[1], window.height))
}

/// Resamples to the centers of `size` pixels that cover the same extent.
pub fn at_pixels(heights: &Grid, size: [usize; 2]) -> Grid {
    let window = heights.window();
    let at = |count: usize, samples: usize| {
        let step = (samples.saturating_sub(1)) as f64 / count as f64;
        (0..count).map(|k| (k as f64 + 0.5) * step).collect::<Vec<f64>>()
    };
    read(heights, &at(size[0], window.width), &at(size[1], window.height))
}

/// The heights at evenly spaced columns `xs` and rows `ys`, in samples.
fn read(heights: &Grid, xs: &[f64], ys: &[f64]) -> Grid {
    let source = heights.window();
    let step = |at: &[f64]| if at.len() > 1 { at[1] - at[0] } else { 1.0 };
    let (across, down) = (step(xs), step(ys));
    let cell = source.cell * if xs.len() > 1 { across } else { down };
    let mut out = Grid::filled(Window::new(xs.len(), ys.len(), cell), 0.0f32);
    if across.max(down) <= 1.0 {
        let own = Grid::from_data(Window::new(source.width, source.height, 1.0), heights.data().to_vec());
        if let Some(own) = own {
            parallel::for_each(out.data_mut().chunks_mut(xs.len()).zip(ys), |(row, y)| {
                resample::read(&own, LayerKind::Height, &Points::Lattice { xs, ys: &[*y] }, row);
                let j = (y.round() as usize).min(source.height - 1);
                for (height, x) in row.iter_mut().zip(xs) {
                    // A hole covers the area of its sample.
                    let nearest = own[((x.round() as usize).min(source.width - 1), j)];
                    if !nearest.is_finite() || !height.is_finite() {
                        *height = nearest;
                    }
                }
            });
        }
        return out;
    }
    let around = |at: f64, step: f64, count: usize| {
        let reach = (step / 2.0).max(0.5);
        let (from, to) = ((at - reach).ceil().max(0.0) as usize, (at + reach).floor() as usize);
        from.min(count - 1)..(to + 1).clamp(1, count)
    };
    let columns: Vec<std::ops::Range<usize>> = xs.iter().map(|x| around(*x, across, source.width)).collect();
    parallel::for_each(out.data_mut().chunks_mut(xs.len()).zip(ys), |(row, y)| {
        // Columns first, then rows.
        let rows = around(*y, down, source.height);
        let (mut sums, mut counts) = (vec![0.0f32; source.width], vec![0.0f32; source.width]);
        for j in rows {
            for ((sum, count), height) in sums.iter_mut().zip(&mut counts).zip(heights.row(j)) {
                let there = height.is_finite();
                *sum += if there { *height } else { 0.0 };
                *count += f32::from(u8::from(there));
            }
        }
        for (height, columns) in row.iter_mut().zip(&columns) {
            let sum: f32 = sums[columns.clone()].iter().sum();
            let count: f32 = counts[columns.clone()].iter().sum();
            *height = if count > 0.0 { sum / count } else { f32::NAN };
        }
    });
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    fn slope(width: usize, height: usize) -> Grid {
        let mut grid = Grid::filled(Window::new(width, height, 10.0), 0.0);
        for j in 0..height {
            for i in 0..width {
                grid.row_mut(j)[i] = 3.0 * i as f32 + 7.0 * j as f32;
            }
        }
        grid
    }

    #[test]
    fn a_slope_stays_where_it_is() {
        let grid = slope(101, 61);
        for size in [[51, 31], [101, 61], [201, 121], [21, 13]] {
            let laid = laid(&grid, size);
            assert!((laid.window().cell * (size[0] - 1) as f64 - 1000.0).abs() < 1e-9);
            // Inside only: at the border a mean is one-sided.
            for (u, v) in [(0.2, 0.5), (0.5, 0.5), (0.8, 0.4)] {
                let (i, j) = ((u * (size[0] - 1) as f64).round() as usize, (v * (size[1] - 1) as f64).round() as usize);
                let (x, y) = (i as f32 / (size[0] - 1) as f32, j as f32 / (size[1] - 1) as f32);
                assert!((laid[(i, j)] - (300.0 * x + 420.0 * y)).abs() < 0.01, "{size:?}");
            }
            let pixels = at_pixels(&grid, size);
            let (i, j) = (size[0] / 2, size[1] / 2);
            let (x, y) = ((i as f32 + 0.5) / size[0] as f32, (j as f32 + 0.5) / size[1] as f32);
            assert!((pixels[(i, j)] - (300.0 * x + 420.0 * y)).abs() < 0.01, "{size:?}");
        }
    }

    #[test]
    fn holes_stay_holes() {
        let mut grid = slope(40, 40);
        for j in 10..20 {
            grid.row_mut(j)[10..20].fill(f32::NAN);
        }
        for side in [20, 40, 90] {
            let laid = laid(&grid, [side, side]);
            let holes = laid.data().iter().filter(|height| height.is_nan()).count() as f64 / (side * side) as f64;
            assert!((holes - 1.0 / 16.0).abs() < 0.03, "{side}: {holes}");
            assert!(laid.data().iter().all(|height| height.is_nan() || (-1.0..=400.0).contains(height)));
        }
        assert_eq!(laid(&slope(1, 1), [3, 3]).data().len(), 9);
    }
}
