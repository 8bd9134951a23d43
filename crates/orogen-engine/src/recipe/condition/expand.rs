//! Expansion of conditions to nodes: shares are computed by ordinary ops. They are therefore the same for any tile, and
//! their halos and memory are planned like those of any other layer.

use std::collections::HashSet;

use super::document::{Condition, Noise, Quantity};
use crate::recipe::document::Recipe;
use orogen_ops::declare::Input;
use orogen_ops::field::{Constant, Fbm, Max, Multiply, SelectFlow, SelectHeight};
use orogen_ops::filter::{SelectCurvature, SelectSlope};
use orogen_ops::node::Node;
use orogen_ops::solver::Drainage;

/// The output with drainage areas, if a recipe has one.
const FLOW: &str = "flow";

/// Bounds of the ops' parameters.
const HEIGHTS: [f64; 2] = [-1e9, 1e9];
const SLOPES: [f64; 2] = [0.0, 90.0];
const CURVATURES: [f64; 2] = [-1e3, 1e3];
const FLOWS: [f64; 2] = [0.0, 1e18];

/// Adds nodes with unused names.
pub struct ShareNodes<'r> {
    /// The recipe that gets the nodes.
    pub recipe: &'r mut Recipe,
    names: HashSet<String>,
    /// The heights of conditions.
    pub height: Input,
    flow: Option<Input>,
}

impl<'r> ShareNodes<'r> {
    /// Nodes for a recipe with these heights.
    pub fn new(recipe: &'r mut Recipe, height: Input) -> ShareNodes<'r> {
        let flow = recipe.output_inputs().iter().find(|(name, _)| name == FLOW).map(|(_, flow)| flow.clone());
        let names = recipe.nodes().iter().map(|named| named.name.clone()).collect();
        ShareNodes { recipe, names, height, flow }
    }

    /// Adds a node, and returns it as an input. Its name is this one, with a number if there is a node of that name.
    pub fn add(&mut self, name: &str, node: impl Into<Node>) -> Input {
        let mut free = name.to_string();
        let mut number = 1;
        while !self.names.insert(free.clone()) {
            number += 1;
            free = format!("{name}-{number}");
        }
        self.recipe.add(&free, node);
        Input::Node(free)
    }

    /// A node with the product of all conditions, the largest share of the alternatives, and `more`. Names of nodes
    /// start with `prefix`.
    pub fn share(
        &mut self,
        prefix: &str,
        all: &[Condition],
        any: &[Vec<Condition>],
        more: impl IntoIterator<Item = Input>,
    ) -> Input {
        let name = |part: &str| format!("{prefix}-{part}");
        let mut factors: Vec<Input> =
            all.iter().map(|condition| self.condition(&name("condition"), condition)).collect();
        let alternatives: Vec<Input> = (any.iter())
            .map(|conditions| {
                let factors = conditions.iter().map(|one| self.condition(&name("condition"), one)).collect();
                self.product(&name("alternative"), factors)
            })
            .collect();
        let best = alternatives.into_iter().reduce(|a, b| self.add(&name("any"), Max { a, b, ..Max::default() }));
        factors.extend(best);
        factors.extend(more.into_iter().filter(|factor| *factor != Input::None));
        self.product(&name("share"), factors)
    }

    /// A node with the product of shares.
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

    /// Drainage areas: the recipe's output, or a node that computes them from its heights.
    fn flow(&mut self) -> Option<Input> {
        if self.flow.is_none() && self.recipe.world.size.is_some() {
            let source = self.height.clone();
            self.flow = Some(self.add("surface-drainage", Drainage { source, ..Drainage::default() }));
        }
        self.flow.clone()
    }
}
