//! Colors of vertices, for engines that have no textures yet.

use orogen::Window;
use orogen::noise::{Fractal, Points};

type Rgb = [f32; 3];

const SAND: Rgb = [0.30, 0.25, 0.13];
const LUSH: Rgb = [0.045, 0.12, 0.02];
const DRY: Rgb = [0.22, 0.22, 0.065];
const SNOW: Rgb = [0.70, 0.72, 0.76];
const ROCK: Rgb = [0.15, 0.135, 0.12];

/// Size of the patches of light and dark, in metres. Their smallest parts are some metres wide.
const PATCH: f64 = 90.0;

/// How much patches change the brightness.
const CONTRAST: f32 = 0.3;

/// The colors of samples: sand at the shore, grass, rock where it is steep, snow high up.
pub fn colors_of(window: &Window, heights: &[f32], normals: &[[f32; 3]], sea_level: f32) -> Vec<[f32; 4]> {
    let noise = Fractal::new(11, PATCH);
    let xs: Vec<f64> = (0..window.width).map(|column| window.east(column)).collect();
    let ys: Vec<f64> = (0..window.height).map(|row| window.south(row)).collect();
    let mut patches = vec![0.0; heights.len()];
    // There is one for each sample of the window; without them the ground is plain.
    if noise.fill(&Points::Lattice { xs: &xs, ys: &ys }, &mut patches).is_err() {
        patches.fill(0.0);
    }
    let samples = heights.iter().zip(normals).zip(patches);
    samples.map(|((height, normal), patch)| color(height - sea_level, normal[1], patch)).collect()
}

/// The color of a sample with this height above the sea, upward part of the normal, and patch from -1 to 1.
fn color(above_sea: f32, up: f32, patch: f32) -> [f32; 4] {
    let share = |from: f32, to: f32, at: f32| ((at - from) / (to - from)).clamp(0.0, 1.0);
    let mix = |a: Rgb, b: Rgb, share: f32| -> Rgb { std::array::from_fn(|k| a[k] + (b[k] - a[k]) * share) };
    // Grass is lush in hollows of the noise, and dry on slopes.
    let grass = mix(LUSH, DRY, (share(-0.5, 0.7, patch) + share(0.99, 0.9, up) * 0.4).min(1.0));
    let low = mix(SAND, grass, share(1.0, 6.0, above_sea));
    let high = mix(low, SNOW, share(700.0, 900.0, above_sea));
    // Patches make the borders of rock uneven.
    let edge = 0.04 * patch;
    let [red, green, blue] =
        mix(ROCK, high, share(0.72 + edge, 0.86 + edge, up)).map(|part| part * (1.0 + CONTRAST * patch));
    [red, green, blue, 1.0]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn steep_high_and_low_ground_differ_and_grass_is_not_even() {
        let of = |height: f32, up: f32| {
            let window = Window::new(40, 30, 4.0).at(100, -7);
            colors_of(&window, &vec![height; 1200], &vec![[0.0, up, 0.0]; 1200], 10.0)
        };
        let mean = |colors: &[[f32; 4]], part: usize| colors.iter().map(|color| color[part]).sum::<f32>() / 1200.0;
        let [grass, sand, snow, rock] = [of(60.0, 1.0), of(10.5, 1.0), of(1500.0, 1.0), of(1500.0, 0.5)];
        assert!(mean(&grass, 1) > 1.1 * mean(&grass, 0) && mean(&sand, 0) > 1.1 * mean(&sand, 1));
        assert!(mean(&snow, 2) > 3.0 * mean(&rock, 2));
        let greens = grass.iter().map(|color| color[1]);
        assert!(greens.clone().fold(0.0, f32::max) > 1.5 * greens.fold(1.0, f32::min));
        let all = [grass, sand, snow, rock].concat();
        assert!(all.iter().flatten().all(|part| (0.0..=1.0).contains(part)));
    }

    #[test]
    fn chunks_beside_each_other_have_the_same_colors_at_their_border() {
        let of =
            |column: i64| colors_of(&Window::new(9, 9, 2.0).at(column, 3), &[50.0; 81], &[[0.0, 1.0, 0.0]; 81], 0.0);
        let [west, east] = [of(-8), of(0)];
        assert!((0..9).all(|row| west[9 * row + 8] == east[9 * row]));
    }
}
