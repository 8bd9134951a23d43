//! Expansion of surfaces to nodes: the share of each, and the position in its gradient, are computed by ordinary ops.
//! They are therefore the same for any tile, and their halos and memory are planned like those of any other layer.

use super::document::{Along, Coloring, Expanded, Surface};
use super::standard;
use crate::recipe::condition::expand::ShareNodes;
use crate::recipe::document::Recipe;
use crate::recipe::outputs::HEIGHT;
use orogen_ops::declare::Input;
use orogen_ops::field::{Curve, Fbm, Remap};
use orogen_ops::filter::Slope;

/// Quantiles of fBm of Perlin noise with four octaves and a gain of 0.5 (from 2^24 samples), with which every color of
/// a gradient covers the same area.
const QUANTILES: [[f64; 2]; 17] = [
    [-0.5707, 0.0005],
    [-0.4690, 0.005],
    [-0.3843, 0.02],
    [-0.3132, 0.05],
    [-0.2480, 0.1],
    [-0.1667, 0.2],
    [-0.1054, 0.3],
    [-0.0514, 0.4],
    [0.0, 0.5],
    [0.0514, 0.6],
    [0.1054, 0.7],
    [0.1667, 0.8],
    [0.2480, 0.9],
    [0.3132, 0.95],
    [0.3843, 0.98],
    [0.4690, 0.995],
    [0.5707, 0.9995],
];

/// Octaves of the noise of gradients.
const OCTAVES: u32 = 4;

/// Adds the nodes that compute a recipe's surfaces, or the surfaces of [`standard`] if it has none, unless they exist.
/// A recipe without a layer `height` has no surfaces.
pub fn expand(recipe: &mut Recipe) {
    let Some((_, height)) = recipe.output_inputs().iter().find(|(name, _)| name == HEIGHT) else { return };
    if !recipe.expanded().is_empty() {
        return;
    }
    let height = height.clone();
    let surfaces = match recipe.surfaces() {
        [] => standard::surfaces(),
        own => own.to_vec(),
    };
    let mut nodes = ShareNodes::new(recipe, height);
    let expanded = surfaces.into_iter().enumerate().map(|(k, surface)| nodes.surface(k, surface)).collect();
    recipe.set_expanded(expanded);
}

impl ShareNodes<'_> {
    fn surface(&mut self, k: usize, surface: Surface) -> Expanded {
        let first = self.recipe.nodes().len();
        let name = |part: &str| format!("surface-{}-{part}", k + 1);
        let share = (k > 0).then(|| {
            let more = [surface.mask.clone(), Input::Value(surface.opacity)];
            self.share(&format!("surface-{}", k + 1), &surface.all, &surface.any, more)
        });
        let position = match &surface.color {
            Coloring::Plain(_) => None,
            Coloring::Gradient(_, along) | Coloring::Picture(_, along) => {
                Some(self.position(k, &name("position"), along))
            }
        };
        let layer = |input: Input| match input {
            Input::Node(name) => name,
            _ => String::new(),
        };
        let nodes = first..self.recipe.nodes().len();
        let colors = surface.color.ramp();
        Expanded { surface, share: share.map(layer), position: position.map(layer), nodes, colors }
    }

    /// The position in a gradient, 0 to 1.
    fn position(&mut self, k: usize, name: &str, along: &Along) -> Input {
        let stretched = |source: Input, span: [f64; 2]| Remap { source, from: span, to: [0.0, 1.0], clamp: true };
        match along {
            Along::Noise(wavelength) => {
                let seed = 0x5u64 << 32 | k as u64;
                let noise = Fbm { wavelength: *wavelength, octaves: OCTAVES, seed, ..Fbm::default() };
                let source = self.add(name, noise);
                self.add(name, Curve { source, points: QUANTILES.to_vec() })
            }
            Along::Height(span) => {
                let sea = self.recipe.world.sea_level;
                let source = self.height.clone();
                self.add(name, stretched(source, span.map(|height| height + sea)))
            }
            Along::Slope(span) => {
                let source = self.height.clone();
                let source = self.add(name, Slope { source, ..Slope::default() });
                self.add(name, stretched(source, *span))
            }
            Along::Layer(layer, span) => self.add(name, stretched(Input::Node(layer.clone()), *span)),
        }
    }
}
