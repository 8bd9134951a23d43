//! The cover of samples: the blended weights of the recipe's surfaces, and the resulting appearance.

use super::layer::Around;
use orogen_engine::recipe::document::Recipe;
use orogen_engine::recipe::surface::document::Expanded;
use orogen_grid::grid::{Grid, Window};
use orogen_io::palette::color::{Light, decode};
use orogen_io::palette::palette::NO_DATA;

/// The names of the surfaces without duplicates, in the order of first use.
pub fn names(recipe: &Recipe) -> Vec<String> {
    let mut names: Vec<String> = Vec::new();
    for expanded in recipe.expanded() {
        if !names.contains(&expanded.surface.name) {
            names.push(expanded.surface.name.clone());
        }
    }
    names
}

/// The layers with the shares of surfaces.
pub fn shares(recipe: &Recipe) -> Vec<String> {
    recipe.expanded().iter().filter_map(|expanded| expanded.share.clone()).collect()
}

/// The layers with the shares, followed by those with the positions in gradients.
pub fn shares_and_positions(recipe: &Recipe) -> Vec<String> {
    let positions = recipe.expanded().iter().filter_map(|expanded| expanded.position.clone());
    shares(recipe).into_iter().chain(positions).collect()
}

/// A surface with the layers that it reads.
struct Laid<'a> {
    expanded: &'a Expanded,
    share: Option<&'a Grid>,
    position: Option<&'a Grid>,
}

/// The surfaces over a window.
pub struct Cover<'a> {
    laid: Vec<Laid<'a>>,
    /// For each surface, its index in [`names`].
    channels: Vec<usize>,
    around: &'a Around<'a>,
}

impl<'a> Cover<'a> {
    /// From layers in the order of [`shares`] or of [`shares_and_positions`].
    pub fn new(around: &'a Around<'a>) -> Cover<'a> {
        let (recipe, names) = (around.recipe, names(around.recipe));
        let count = shares(recipe).len().min(around.layers.len());
        let (mut shares, mut positions) = (around.layers[..count].iter(), around.layers[count..].iter());
        let laid = recipe.expanded().iter().map(|expanded| Laid {
            expanded,
            share: expanded.share.as_ref().and_then(|_| shares.next()),
            position: expanded.position.as_ref().and_then(|_| positions.next()),
        });
        let channel = |expanded: &Expanded| names.iter().position(|name| *name == expanded.surface.name).unwrap_or(0);
        Cover { laid: laid.collect(), channels: recipe.expanded().iter().map(channel).collect(), around }
    }

    /// Calls `visit` for each sample of a window with the weights of all surfaces, which add up to 1; all are 0 where
    /// there is no height.
    fn each(&self, window: &Window, mut visit: impl FnMut([usize; 2], [usize; 2], &[f32])) {
        let there = self.around.heights.window();
        let mut weights = vec![0.0; self.laid.len()];
        for j in 0..window.height {
            for i in 0..window.width {
                let at = [(window.x - there.x) as usize + i, (window.y - there.y) as usize + j];
                let has_height = self.around.heights[(at[0], at[1])].is_finite();
                // From the top down: each surface takes its share of the rest.
                let mut left = if has_height { 1.0 } else { 0.0 };
                for (weight, laid) in weights.iter_mut().zip(&self.laid).rev() {
                    // A share that is NaN counts as 0.
                    let share = laid.share.map_or(1.0, |share| share[(at[0], at[1])].clamp(0.0, 1.0));
                    *weight = left * if share.is_nan() { 0.0 } else { share };
                    left -= *weight;
                }
                visit([i, j], at, &weights);
            }
        }
    }

    /// The weights: one grid per name.
    pub fn weights(&self, window: &Window) -> Vec<Grid> {
        let mut out = vec![Grid::filled(*window, 0.0); names(self.around.recipe).len()];
        self.each(window, |[i, j], _, weights| {
            for (weight, channel) in weights.iter().zip(&self.channels) {
                out[*channel].row_mut(j)[i] += weight;
            }
        });
        out
    }

    /// The color in linear light: red, green and blue; the grey of missing samples where there is no height.
    pub fn albedo(&self, window: &Window) -> Vec<Grid> {
        let mut out = vec![Grid::filled(*window, 0.0); 3];
        self.each(window, |[i, j], at, weights| {
            let mut light: Light = [0.0; 3];
            for (laid, weight) in self.laid.iter().zip(weights).filter(|(_, weight)| **weight > 0.0) {
                let position = laid.position.map_or(0.0, |position| position[(at[0], at[1])]);
                let color = ramp(&laid.expanded.colors, position);
                light.iter_mut().zip(color).for_each(|(light, part)| *light += weight * part);
            }
            if !self.around.heights[(at[0], at[1])].is_finite() {
                light = NO_DATA.map(decode);
            }
            out.iter_mut().zip(light).for_each(|(out, part)| out.row_mut(j)[i] = part);
        });
        out
    }

    /// The mean roughness, 0 to 1.
    pub fn roughness(&self, window: &Window) -> Vec<Grid> {
        let mut out = Grid::filled(*window, 0.0);
        let roughness: Vec<f32> = self.laid.iter().map(|laid| laid.expanded.surface.roughness as f32).collect();
        self.each(window, |[i, j], _, weights| {
            out.row_mut(j)[i] = weights.iter().zip(&roughness).map(|(weight, roughness)| weight * roughness).sum();
        });
        vec![out]
    }
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
