//! The relief picture of a sheet: tint and shading.

use orogen_grid::parallel;

use super::ground::{at_pixels, laid};
use super::options::Shading;
use super::ramp::Ramp;
use crate::map::shade::{Lights, ON_LAYER, PRINTED, Shade, UNDER_WATER};
use orogen_grid::analysis::slope::{Gradient, extended, gradients_between};
use orogen_grid::grid::Grid;
use orogen_io::palette::color::{Encoder, Light};
use orogen_io::palette::tint::Tint;

/// Swiss shading: contrast in the lowlands and on the summits, amount and color of the haze over the lowlands, and
/// smoothing of the lowlands in pixels.
const CONTRAST: [f32; 2] = [0.62, 1.22];
const HAZE: f32 = 0.16;
const AIR: Light = [0.62, 0.72, 0.84];
const SOFT: usize = 7;

/// The source of the relief's colors.
#[derive(Clone, Copy)]
pub enum Paint<'a> {
    /// The tint of the heights.
    Tint,
    /// The values of a layer over the same window, with its ramp.
    Layer(&'a Grid, &'a Ramp),
    /// Red, green and blue in linear light over the same window; the sea has the tint of its depths.
    Albedo(&'a [Grid; 3]),
}

/// The resampled colors at pixel centers.
enum Painted<'a> {
    Tint,
    Layer(Grid, &'a Ramp),
    Albedo([Grid; 3]),
}

/// The relief of heights at pixels, in sRGB bytes.
pub fn paint(
    heights: &Grid,
    colors: Paint,
    pixels: [usize; 2],
    tint: &Tint,
    shading: Shading,
    sea_level: f32,
) -> Vec<u8> {
    let grid = at_pixels(heights, pixels);
    let colors = match colors {
        Paint::Tint => Painted::Tint,
        Paint::Layer(values, ramp) => Painted::Layer(ramp.at_pixels(values, pixels), ramp),
        Paint::Albedo(parts) => Painted::Albedo(parts.each_ref().map(|part| at_pixels(part, pixels))),
    };
    let [width, height] = pixels;
    let encoder = Encoder::new();
    let lights = if shading == Shading::Single { Lights::One } else { Lights::Three };
    let shade = Shade::fit_lit(lights, &grid, sea_level);
    let soft = (shading == Shading::Swiss).then(|| {
        let few = pixels.map(|side| (side / SOFT).max(2).min(side));
        extended(&laid(&laid(&grid, few), pixels))
    });
    let (low, high) = ends(&grid, sea_level);
    let wide = extended(&grid);
    let cell = grid.window().cell;
    let mut bytes = vec![0u8; 3 * width * height];
    parallel::for_each(bytes.chunks_exact_mut(3 * width).enumerate(), |(j, out)| {
        let rows = |grid: &'_ Grid| -> [Vec<f32>; 3] { [0, 1, 2].map(|k| grid.row(j + k).to_vec()) };
        let mut softly: Vec<Gradient> = Vec::new();
        if let Some(soft) = &soft {
            let rows = rows(soft);
            gradients_between([&rows[0], &rows[1], &rows[2]], cell, |_, gradient| softly.push(gradient));
        }
        let here = wide.row(j + 1);
        gradients_between([wide.row(j), here, wide.row(j + 2)], cell, |i, gradient| {
            let height = here[i + 1];
            let sea = tint.is_sea(height);
            let mut color = match &colors {
                Painted::Layer(values, ramp) => ramp.at(values[(i, j)]),
                Painted::Albedo(parts) if height.is_finite() && !sea => {
                    parts.each_ref().map(|part| (part[(i, j)] * PRINTED).clamp(0.0, 1.0))
                }
                _ => tint.at(height),
            };
            let strength = match colors {
                Painted::Layer(..) => ON_LAYER,
                _ if sea => UNDER_WATER,
                _ => 1.0,
            };
            let up = ((height - low) / (high - low)).clamp(0.0, 1.0);
            let factor = match (shading, softly.get(i)) {
                _ if !height.is_finite() => [1.0; 3],
                (Shading::None, _) => [1.0; 3],
                (Shading::Swiss, Some(soft)) => {
                    let air = HAZE * (1.0 - up) * (1.0 - up) * strength;
                    color = std::array::from_fn(|c| color[c] + (AIR[c] - color[c]) * air);
                    let crisp = (0.35 + 0.9 * up).min(1.0);
                    let mixed = Gradient {
                        east: soft.east + (gradient.east - soft.east) * crisp,
                        north: soft.north + (gradient.north - soft.north) * crisp,
                    };
                    let contrast = CONTRAST[0] + (CONTRAST[1] - CONTRAST[0]) * up;
                    let lit = shade.on(mixed);
                    // Slopes in the sun are warmer.
                    let warm = if lit[1] > 1.0 { [0.02, 0.0, -0.05] } else { [0.0; 3] };
                    std::array::from_fn(|c| 1.0 + (lit[c] - 1.0) * contrast + warm[c])
                }
                _ => shade.on(gradient),
            };
            out[3 * i..3 * i + 3].copy_from_slice(&encoder.bytes(lit(color, factor, strength)));
        });
    });
    bytes
}

/// A color in the light of these factors, which count with `strength`.
pub fn lit(color: Light, factor: Light, strength: f32) -> Light {
    std::array::from_fn(|c| color[c] * (1.0 + (factor[c] - 1.0) * strength))
}

/// The lowest and the highest land, always two different numbers.
fn ends(grid: &Grid, sea_level: f32) -> (f32, f32) {
    let land = grid.data().iter().copied().filter(|height| height.is_finite() && *height > sea_level);
    let (low, high) = land.fold((f32::MAX, f32::MIN), |(low, high), height| (low.min(height), high.max(height)));
    if low < high { (low, high) } else { (0.0, 1.0) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use orogen_grid::grid::Window;

    /// A ridge that runs from north-west to south-east, and another across it.
    fn ridges() -> Grid {
        let mut grid = Grid::filled(Window::new(120, 120, 30.0), 0.0);
        for j in 0..120 {
            for i in 0..120 {
                let (x, y) = (i as f64 - 60.0, j as f64 - 60.0);
                let ridge = |d: f64| 700.0 * libm::exp(-d * d / 200.0);
                grid.row_mut(j)[i] = (ridge(x - y) + ridge(x + y)) as f32;
            }
        }
        grid
    }

    #[test]
    fn each_shading_shows_the_relief_in_its_way() {
        let grid = ridges();
        let tint = Tint::hypsometric(0.0, 1400.0, -1.0);
        let paint = |shading| paint(&grid, Paint::Tint, [120, 120], &tint, shading, -1.0);
        let green = |bytes: &[u8], i: usize, j: usize| i32::from(bytes[3 * (j * 120 + i) + 1]);
        let [none, single, multi, swiss] = [Shading::None, Shading::Single, Shading::Multi, Shading::Swiss].map(paint);
        // Both flanks of the ridge parallel to the light are lit equally, those of the other are not.
        let along = |bytes: &[u8]| (green(bytes, 28, 20) - green(bytes, 20, 28)).abs();
        let across = |bytes: &[u8]| green(bytes, 28, 84) - green(bytes, 36, 92);
        assert!(along(&none) <= 2 && across(&none).abs() <= 2, "{} {}", along(&none), across(&none));
        assert!(along(&single) <= 4, "{}", along(&single));
        assert!([&single, &multi, &swiss].iter().all(|bytes| across(bytes) > 40));
        assert!(single != multi);
        // At the foot, haze and softness reduce the contrast.
        let foot = |bytes: &[u8]| green(bytes, 24, 78) - green(bytes, 42, 96);
        assert!(foot(&swiss) < foot(&multi), "{} {}", foot(&swiss), foot(&multi));
    }

    #[test]
    fn an_albedo_colors_the_land_and_not_the_sea_nor_holes() {
        let mut grid = Grid::filled(Window::new(40, 20, 30.0), 5.0);
        grid.data_mut().chunks_exact_mut(40).for_each(|row| row[..20].fill(-50.0));
        grid.row_mut(10)[30] = f32::NAN;
        let albedo = [0.05, 0.2, 0.01].map(|part| Grid::filled(*grid.window(), part));
        let tint = Tint::hypsometric(-100.0, 100.0, 0.0);
        let paint = |colors| paint(&grid, colors, [40, 20], &tint, Shading::None, 0.0);
        let (plain, covered) = (paint(Paint::Tint), paint(Paint::Albedo(&albedo)));
        let pixel = |bytes: &[u8], i: usize| [0, 1, 2].map(|part| bytes[3 * (10 * 40 + i) + part]);
        assert_eq!(pixel(&plain, 5), pixel(&covered, 5));
        assert_eq!(pixel(&covered, 30), [222; 3]);
        let expect = Encoder::new().bytes([0.05, 0.2, 0.01].map(|part| part * PRINTED));
        assert_eq!(pixel(&covered, 36), expect);
    }

    #[test]
    fn holes_and_flats_are_painted() {
        let mut grid = Grid::filled(Window::new(30, 20, 30.0), 5.0);
        grid.row_mut(10)[10..20].fill(f32::NAN);
        for shading in [Shading::None, Shading::Single, Shading::Multi, Shading::Swiss] {
            assert_eq!(paint(&grid, Paint::Tint, [60, 40], &Tint::fit(&grid, 0.0), shading, 0.0).len(), 3 * 60 * 40);
        }
    }
}
