//! A brush for painting on the map, and the node that receives its strokes.

use std::collections::HashSet;

use orogen::declare::{Input, Stroke, StrokeMode};
use orogen::field::Paint;
use orogen::node::Node;
use orogen::recipe::Recipe;

use super::edit::Edit;
use super::names;
use super::strokes::{OP, Placement};
use super::thinning::thinned;

/// The effect of a brush.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Effect {
    /// Paints a mask.
    Paint,
    /// Erases painted parts of a mask.
    Erase,
    /// Raises the land.
    Raise,
    /// Lowers the land.
    Lower,
}

impl Effect {
    /// All effects.
    pub const ALL: [Effect; 4] = [Effect::Paint, Effect::Erase, Effect::Raise, Effect::Lower];

    /// Whether the effect changes heights.
    #[must_use]
    pub fn is_of_heights(self) -> bool {
        matches!(self, Effect::Raise | Effect::Lower)
    }
}

/// Minimum and maximum radius, in metres.
pub const RADII: [f64; 2] = [0.1, 1e6];

/// Maximum distance of a stroke's line from the line of the pointer, relative to the radius.
const TOLERANCE: f64 = 0.02;

/// A brush.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Brush {
    /// The effect.
    pub effect: Effect,
    /// The radius in metres.
    pub radius: f64,
    /// The share of the radius with full effect, 0 to 1.
    pub hardness: f64,
    /// How much of a mask a stroke paints or erases, 0 to 1.
    pub strength: f64,
    /// By how much the land is raised or lowered, in metres.
    pub height: f64,
}

impl Brush {
    /// A brush that suits a view with this side in metres and this range of heights.
    #[must_use]
    pub fn fitting(effect: Effect, side: f64, heights: [f32; 2]) -> Brush {
        let range = f64::from(heights[1]) - f64::from(heights[0]);
        let height = if range.is_finite() && range > 0.0 { round_number(range * 0.05) } else { 10.0 };
        Brush { effect, radius: round_number(side * 0.04), hardness: 0.3, strength: 1.0, height }
    }

    /// Multiplies the radius by a factor, within the limits of [`RADII`].
    pub fn scale(&mut self, factor: f64) {
        let radius = (self.radius * factor).clamp(RADII[0], RADII[1]);
        self.radius = format!("{radius:.2e}").parse().unwrap_or(radius);
    }

    /// The stroke of the brush along the line of the pointer. It has few points, with as few digits as the radius
    /// needs.
    #[must_use]
    pub fn stroke(&self, line: &[[f64; 2]]) -> Stroke {
        let digits = self.digits();
        let mut points: Vec<[f64; 2]> = thinned(line, self.radius * TOLERANCE)
            .into_iter()
            .map(|point| point.map(|part| rounded(part, digits)))
            .collect();
        points.dedup();
        let (mode, value, strength) = match self.effect {
            Effect::Paint => (StrokeMode::Set, 1.0, self.strength),
            Effect::Erase => (StrokeMode::Erase, Stroke::default().value, self.strength),
            Effect::Raise => (StrokeMode::Add, self.height, 1.0),
            Effect::Lower => (StrokeMode::Add, -self.height, 1.0),
        };
        Stroke { points, radius: self.radius, hardness: self.hardness, mode, value, strength }
    }

    /// Number of decimal places of positions: a unit of the last place is at most the tolerance.
    fn digits(&self) -> i32 {
        -(libm::log10(self.radius * TOLERANCE).floor() as i32)
    }
}

/// A number rounded to decimal places such that its text has no further digits; negative places are tens, hundreds and
/// so on.
fn rounded(number: f64, digits: i32) -> f64 {
    let scale = libm::pow(10.0, f64::from(digits.abs()));
    match digits >= 0 {
        true => (number * scale).round() / scale,
        false => (number / scale).round() * scale,
    }
}

/// The largest of 1, 2, 5, 10, 20 and so on that is not larger.
pub(super) fn round_number(number: f64) -> f64 {
    let number = number.clamp(RADII[0], RADII[1]);
    let power = libm::log10(number).floor() as i32;
    let steps = [5.0, 2.0, 1.0].map(|step| rounded(step * libm::pow(10.0, f64::from(power)), -power));
    steps.into_iter().find(|step| *step <= number).unwrap_or(number)
}

/// A stroke while it is being painted.
#[derive(Debug, Clone, PartialEq)]
pub struct Painting {
    brush: Brush,
    node: String,
    placement: Placement,
    /// Number of strokes that the node had before.
    at: usize,
    /// The positions of the pointer.
    line: Vec<[f64; 2]>,
}

impl Painting {
    /// Starts a stroke at a position. It goes to the selected node if that is a paint node that suits the effect,
    /// otherwise to a suitable one connected with it, or to a new one. `surface` is the output with the heights. `None`
    /// if there is nothing to erase.
    #[must_use]
    pub fn begin(
        brush: Brush,
        recipe: &Recipe,
        selected: Option<&str>,
        surface: &str,
        at: [f64; 2],
    ) -> Option<Painting> {
        let (node, placement) = target(recipe, selected, surface, brush.effect)?;
        let count = painted(recipe, &node).map_or(0, |paint| paint.strokes.list().len());
        Some(Painting { brush, node, placement, at: count, line: vec![at] })
    }

    /// Continues the stroke to a position. Returns whether it became longer.
    pub fn continue_to(&mut self, at: [f64; 2]) -> bool {
        let is_far = |last: &[f64; 2]| libm::hypot(at[0] - last[0], at[1] - last[1]) > self.brush.radius * TOLERANCE;
        let grows = self.line.last().is_none_or(is_far);
        if grows {
            self.line.push(at);
        }
        grows
    }

    /// The edit that writes the stroke, replacing its shorter form.
    #[must_use]
    pub fn edit(&self) -> Edit {
        let (node, placement, at) = (self.node.clone(), self.placement.clone(), self.at);
        Edit::Stroke { node, placement, at, stroke: self.brush.stroke(&self.line) }
    }

    /// The positions of the pointer.
    #[must_use]
    pub fn line(&self) -> &[[f64; 2]] {
        &self.line
    }
}

/// The node with this name, if it is a paint node.
fn painted<'a>(recipe: &'a Recipe, name: &str) -> Option<&'a Paint> {
    recipe.nodes().iter().find(|named| named.name == name).and_then(|named| match &named.node {
        Node::Paint(paint) => Some(paint),
        _ => None,
    })
}

/// The node for new strokes, and where to put it if it does not exist.
fn target(recipe: &Recipe, selected: Option<&str>, surface: &str, effect: Effect) -> Option<(String, Placement)> {
    let nodes = recipe.nodes();
    let selected = selected.and_then(|name| nodes.iter().find(|named| named.name == name));
    let name_of = |input: &Input| match input {
        Input::Node(name) => Some(name.clone()),
        _ => None,
    };
    let output = recipe.output_inputs().iter().find(|(name, _)| name == surface);
    let land = output.and_then(|(_, input)| name_of(input));
    let takes = |name: &String| {
        let Some(paint) = painted(recipe, name) else { return false };
        let is_land = land.as_ref() == Some(name);
        let adds = paint.strokes.list().iter().any(|stroke| stroke.mode == StrokeMode::Add);
        match effect {
            Effect::Erase => true,
            Effect::Paint => !is_land && !adds,
            Effect::Raise | Effect::Lower => {
                is_land || adds || paint.background != Input::None || paint.strokes.list().is_empty()
            }
        }
    };
    let mask = selected.filter(|_| !effect.is_of_heights()).and_then(|named| name_of(&named.mask));
    let top = land.clone().filter(|_| effect != Effect::Paint);
    let known = [selected.map(|named| named.name.clone()), mask, top];
    if let Some(name) = known.into_iter().flatten().find(takes) {
        return Some((name, Placement::Alone));
    }
    let placement = match (effect, selected) {
        (Effect::Erase, _) => return None,
        (Effect::Raise | Effect::Lower, _) => Placement::Over(surface.to_owned()),
        (Effect::Paint, Some(named)) if named.mask == Input::None && !matches!(named.node, Node::Paint(_)) => {
            Placement::MaskOf(named.name.clone())
        }
        (Effect::Paint, _) => Placement::Alone,
    };
    let taken: HashSet<&str> = nodes.iter().map(|named| named.name.as_str()).collect();
    Some((names::free(&names::of_op(OP), &taken), placement))
}

#[cfg(test)]
mod tests;
