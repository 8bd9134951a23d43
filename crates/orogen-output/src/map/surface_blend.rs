//! The cover of ground by surfaces: the blended weights of the samples, and the resulting appearance.

use orogen_grid::grid::{Grid, Window};
use orogen_io::palette::color::{Light, decode};
use orogen_io::palette::palette::NO_DATA;

/// A surface on top of the previous ones.
#[derive(Debug)]
pub struct SurfaceLayer<'a> {
    /// Evenly spaced colors of a gradient, in linear light.
    pub colors: &'a [Light],
    /// Roughness, 0 to 1.
    pub roughness: f32,
    /// The channel that its weight is added to.
    pub channel: usize,
    /// The share of the ground that it covers, 0 to 1; without one it covers everything.
    pub share: Option<&'a Grid>,
    /// Position in the gradient, 0 to 1; without one the first color.
    pub position: Option<&'a Grid>,
}

/// Surfaces over a window, the lowest first.
#[derive(Debug)]
pub struct SurfaceBlend<'a> {
    /// The surfaces. Their layers have the window of the heights.
    pub surfaces: Vec<SurfaceLayer<'a>>,
    /// The heights; samples without a height are not covered.
    pub heights: &'a Grid,
}

impl SurfaceBlend<'_> {
    /// Calls `visit` for each sample of a window with the weights of all surfaces, which add up to 1; all are 0 where
    /// there is no height.
    fn each(&self, window: &Window, mut visit: impl FnMut([usize; 2], [usize; 2], &[f32])) {
        let there = self.heights.window();
        let mut weights = vec![0.0; self.surfaces.len()];
        for j in 0..window.height {
            for i in 0..window.width {
                let at = [(window.x - there.x) as usize + i, (window.y - there.y) as usize + j];
                let has_height = self.heights[(at[0], at[1])].is_finite();
                // From the top down: each surface takes its share of the rest.
                let mut left = if has_height { 1.0 } else { 0.0 };
                for (weight, surface) in weights.iter_mut().zip(&self.surfaces).rev() {
                    // A share that is NaN counts as 0.
                    let share = surface.share.map_or(1.0, |share| share[(at[0], at[1])].clamp(0.0, 1.0));
                    *weight = left * if share.is_nan() { 0.0 } else { share };
                    left -= *weight;
                }
                visit([i, j], at, &weights);
            }
        }
    }

    /// The weights: one grid per channel.
    #[must_use]
    pub fn weights(&self, window: &Window, channels: usize) -> Vec<Grid> {
        let mut out = vec![Grid::filled(*window, 0.0); channels];
        self.each(window, |[i, j], _, weights| {
            for (weight, surface) in weights.iter().zip(&self.surfaces) {
                out[surface.channel].row_mut(j)[i] += weight;
            }
        });
        out
    }

    /// The color in linear light: red, green and blue; the gray of missing samples where there is no height.
    #[must_use]
    pub fn albedo(&self, window: &Window) -> Vec<Grid> {
        let mut out = vec![Grid::filled(*window, 0.0); 3];
        self.each(window, |[i, j], at, weights| {
            let mut light: Light = [0.0; 3];
            for (surface, weight) in self.surfaces.iter().zip(weights).filter(|(_, weight)| **weight > 0.0) {
                let position = surface.position.map_or(0.0, |position| position[(at[0], at[1])]);
                let color = ramp(surface.colors, position);
                light.iter_mut().zip(color).for_each(|(light, part)| *light += weight * part);
            }
            if !self.heights[(at[0], at[1])].is_finite() {
                light = NO_DATA.map(decode);
            }
            out.iter_mut().zip(light).for_each(|(out, part)| out.row_mut(j)[i] = part);
        });
        out
    }

    /// The weighted mean roughness, 0 to 1.
    #[must_use]
    pub fn roughness(&self, window: &Window) -> Grid {
        let mut out = Grid::filled(*window, 0.0);
        self.each(window, |[i, j], _, weights| {
            let parts = weights.iter().zip(&self.surfaces).map(|(weight, surface)| weight * surface.roughness);
            out.row_mut(j)[i] = parts.sum();
        });
        out
    }
}

/// The sum of weights where the height is above the sea.
#[must_use]
pub fn land_share(weights: &[f32], heights: &[f32], sea_level: f32) -> f64 {
    let land = weights.iter().zip(heights).filter(|(_, height)| **height > sea_level);
    land.map(|(weight, _)| f64::from(*weight)).sum()
}

/// The color at a position, 0 to 1, of evenly spaced colors.
fn ramp(colors: &[Light], position: f32) -> Light {
    let Some(last) = colors.len().checked_sub(1) else { return [0.5; 3] };
    // A position that is NaN gives the first color.
    let at = if position.is_nan() { 0.0 } else { position.clamp(0.0, 1.0) * last as f32 };
    let from = (at as usize).min(last);
    let (a, b) = (colors[from], colors[(from + 1).min(last)]);
    std::array::from_fn(|part| a[part] + (b[part] - a[part]) * (at - from as f32))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_ramp_is_linear_between_its_colors() {
        let colors = [[0.0; 3], [1.0, 0.5, 0.0], [0.0, 1.0, 1.0]];
        assert_eq!(ramp(&colors, 0.25), [0.5, 0.25, 0.0]);
        assert_eq!([ramp(&colors, 1.0), ramp(&colors, 7.0)], [colors[2]; 2]);
        assert_eq!(ramp(&colors, f32::NAN), colors[0]);
        assert_eq!(ramp(&[], 0.3), [0.5; 3]);
    }
}
