//! Expansion of surfaces to nodes: the share of each, and the position in its gradient, are computed by ordinary ops.
//! They are therefore the same for any tile, and their halos and memory are planned like those of any other layer.

use std::collections::HashSet;

use super::document::{Along, Coloring, Condition, Expanded, Noise, Quantity, Surface};
use super::standard;
use crate::declare::Input;
use crate::field::constant::Constant;
use crate::field::curve::Curve;
use crate::field::fbm::Fbm;
use crate::field::max::Max;
use crate::field::multiply::Multiply;
use crate::field::remap::Remap;
use crate::field::select_flow::SelectFlow;
use crate::field::select_height::SelectHeight;
use crate::filter::select_curvature::SelectCurvature;
use crate::filter::select_slope::SelectSlope;
use crate::filter::slope::Slope;
use crate::node::Node;
use crate::recipe::document::Recipe;
use crate::solver::drainage::Drainage;

/// The output with the heights.
const HEIGHT: &str = "height";

/// The output with drainage areas, if a recipe has one.
const FLOW: &str = "flow";

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

/// Bounds of the ops' parameters.
const HEIGHTS: [f64; 2] = [-1e9, 1e9];
const SLOPES: [f64; 2] = [0.0, 90.0];
const CURVATURES: [f64; 2] = [-1e3, 1e3];
const FLOWS: [f64; 2] = [0.0, 1e18];

/// Adds the nodes to a recipe that compute its surfaces, or those of [`standard`] if it has none, unless they exist. A
/// recipe without a layer `height` has no surfaces.
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
    let flow = recipe.output_inputs().iter().find(|(name, _)| name == FLOW).map(|(_, flow)| flow.clone());
    let names = recipe.nodes().iter().map(|named| named.name.clone()).collect();
    let mut nodes = Nodes { recipe, names, height, flow };
    let expanded = surfaces.into_iter().enumerate().map(|(k, surface)| nodes.surface(k, surface)).collect();
    recipe.set_expanded(expanded);
}

/// Adds nodes with unused names.
struct Nodes<'r> {
    recipe: &'r mut Recipe,
    names: HashSet<String>,
    height: Input,
    flow: Option<Input>,
}

impl Nodes<'_> {
    fn add(&mut self, name: &str, node: impl Into<Node>) -> Input {
        let mut free = name.to_string();
        while !self.names.insert(free.clone()) {
            free.push('_');
        }
        self.recipe.add(&free, node);
        Input::Node(free)
    }

    fn surface(&mut self, k: usize, surface: Surface) -> Expanded {
        let first = self.recipe.nodes().len();
        let name = |part: &str| format!("surface-{}-{part}", k + 1);
        let share = (k > 0).then(|| {
            let mut factors: Vec<Input> =
                surface.all.iter().map(|condition| self.condition(&name("condition"), condition)).collect();
            let alternatives: Vec<Input> = (surface.any.iter())
                .map(|conditions| {
                    let factors = conditions.iter().map(|one| self.condition(&name("condition"), one)).collect();
                    self.product(&name("alternative"), factors)
                })
                .collect();
            let best = alternatives.into_iter().reduce(|a, b| self.add(&name("any"), Max { a, b, ..Max::default() }));
            factors.extend(best);
            factors.extend((surface.mask != Input::None).then(|| surface.mask.clone()));
            factors.push(Input::Value(surface.opacity));
            self.product(&name("share"), factors)
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

    /// The product of shares, always a node.
    fn product(&mut self, name: &str, factors: Vec<Input>) -> Input {
        let product = factors.into_iter().reduce(|a, b| match (a, b) {
            (a, Input::Value(1.0)) => a,
            (a, b) => self.add(name, Multiply { a, b }),
        });
        match product {
            Some(Input::Node(node)) => Input::Node(node),
            Some(Input::Value(value)) => self.add(name, Constant { value }),
            _ => self.add(name, Constant { value: 1.0 }),
        }
    }

    /// A node that is 1 where the condition holds and 0 where it does not.
    fn condition(&mut self, name: &str, condition: &Condition) -> Input {
        let Condition { of, min, max, fade } = condition;
        let within = |[low, high]: [f64; 2]| [min.unwrap_or(low).max(low), max.unwrap_or(high).min(high)];
        let falloff = *fade;
        match of {
            Quantity::Height => {
                let sea = self.recipe.world.sea_level;
                let range =
                    within(HEIGHTS.map(|bound| bound - sea)).map(|bound| (bound + sea).clamp(HEIGHTS[0], HEIGHTS[1]));
                let source = self.height.clone();
                self.add(name, SelectHeight { source, range, falloff })
            }
            Quantity::Slope => {
                let source = self.height.clone();
                self.add(
                    name,
                    SelectSlope { source, range: within(SLOPES), falloff: falloff.map(|fade| fade.min(90.0)) },
                )
            }
            Quantity::Curvature { scale } => {
                let source = self.height.clone();
                let node =
                    SelectCurvature { source, scale: *scale, range: within(CURVATURES), falloff, ..Default::default() };
                self.add(name, node)
            }
            Quantity::Flow => match self.flow() {
                Some(source) => self.add(name, SelectFlow { source, range: within(FLOWS), falloff }),
                // The drainage area is unknown in unbounded worlds.
                None => self.add(name, Constant { value: if min.unwrap_or(0.0) > 0.0 { 0.0 } else { 1.0 } }),
            },
            Quantity::Noise(Noise { wavelength, octaves, seed }) => {
                let source =
                    self.add(name, Fbm { wavelength: *wavelength, octaves: *octaves, seed: *seed, ..Fbm::default() });
                self.add(name, SelectHeight { source, range: within(HEIGHTS), falloff })
            }
            Quantity::Layer(layer) => {
                let source = Input::Node(layer.clone());
                self.add(name, SelectHeight { source, range: within(HEIGHTS), falloff })
            }
        }
    }

    /// Drainage areas: the recipe's own, or those of its heights.
    fn flow(&mut self) -> Option<Input> {
        if self.flow.is_none() && self.recipe.world.size.is_some() {
            let source = self.height.clone();
            self.flow = Some(self.add("surface-drainage", Drainage { source, ..Drainage::default() }));
        }
        self.flow.clone()
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
