//! Expansion of terrain classes to nodes: the output [`CLASS`] is computed by ordinary ops.

use super::document::{End, ExpandedClass, Share, TerrainClass};
use crate::recipe::condition::expand::ShareNodes;
use crate::recipe::document::Recipe;
use crate::recipe::outputs::{CLASS, HEIGHT};
use orogen_grid::error::{Error, ErrorKind, Result};
use orogen_ops::declare::Input;
use orogen_ops::field::{Expr, Label};
use orogen_ops::solver::SelectShare;

/// Adds the nodes that compute a recipe's classes, and the output with their numbers, unless they exist. Opening a
/// world does this. Shares are exact at the world's cell.
///
/// # Errors
/// If the recipe has classes but no output `height`, or if it has its own output `class`.
pub fn expand(recipe: &mut Recipe) -> Result<()> {
    let codes: Vec<u8> = (0..=u8::MAX).take(recipe.classes().len()).collect();
    expand_at(recipe, 0.0, &codes)
}

/// Like [`expand`], with shares that are exact at `cell`, in metres (0 for the world's cell), and with a given number
/// for each class.
///
/// # Errors
/// As [`expand`].
pub fn expand_at(recipe: &mut Recipe, cell: f64, codes: &[u8]) -> Result<()> {
    if recipe.classes().is_empty() || !recipe.expanded_classes().is_empty() {
        return Ok(());
    }
    let wrong = |message: &str| Err(Error::new(ErrorKind::Recipe, message));
    if recipe.outputs().any(|name| name == CLASS) {
        return wrong(BOTH);
    }
    let Some((_, height)) = recipe.output_inputs().iter().find(|(name, _)| name == HEIGHT) else {
        return wrong(NO_HEIGHT);
    };
    let height = height.clone();
    let classes = recipe.classes().to_vec();
    let mut nodes = ShareNodes::new(recipe, height.clone());
    let mut below = Input::Value(0.0);
    let mut expanded = Vec::new();
    for (k, (class, code)) in classes.iter().zip(codes).enumerate() {
        let first = nodes.recipe.nodes().len();
        below = match k {
            0 => Input::Value(f64::from(*code)),
            _ => nodes.class(k + 1, class, below, *code, cell),
        };
        if k + 1 == classes.len() {
            // A sample without a height has no class.
            let known = Expr::new("class + 0 * height").with("class", below.clone()).with("height", height.clone());
            let source = nodes.add("class-known", known);
            below = nodes.add("class-number", Label { source });
        }
        expanded.push(ExpandedClass { nodes: first..nodes.recipe.nodes().len() });
    }
    recipe.output(CLASS, below);
    recipe.set_expanded_classes(expanded);
    Ok(())
}

/// The message for a recipe with both kinds of classes.
pub(crate) const BOTH: &str = "the recipe has tables `[[class]]` and an output `class`; remove one of them, because both give the class of each cell";

/// The message for classes without heights.
pub(crate) const NO_HEIGHT: &str =
    "`[[class]]` needs an output `height`; name the heights in [outputs], such as height = \"NODE\"";

impl ShareNodes<'_> {
    /// A node with the number of this class where its conditions hold, and `below` elsewhere.
    fn class(&mut self, number: usize, class: &TerrainClass, below: Input, code: u8, cell: f64) -> Input {
        let prefix = format!("class-{number}");
        let TerrainClass { all, any, mask, share, .. } = class;
        let is_conditional = !all.is_empty() || !any.is_empty() || *mask != Input::None;
        let place = match share {
            Some(_) if !is_conditional => Input::None,
            _ => self.share(&prefix, all, any, [mask.clone()]),
        };
        let place = match share {
            Some(Share { of, end, part }) => {
                let source = if of == HEIGHT { self.height.clone() } else { Input::Node(of.clone()) };
                let highest = *end == End::Highest;
                let select =
                    SelectShare { source, among: place, share: *part, highest, cell, ..SelectShare::default() };
                self.add(&format!("{prefix}-exact"), select)
            }
            None => place,
        };
        let covered = Expr::new(&format!("below + (place >= 0.5) * ({code} - below)"));
        self.add(&prefix, covered.with("below", below).with("place", place))
    }
}
