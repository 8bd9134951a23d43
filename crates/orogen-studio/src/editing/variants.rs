//! Variants of a document: other seeds, and values of a parameter.

use orogen::declare::Shape;
use orogen::declare::spec::ParamSpec;
use orogen::node::Node;
use orogen::value::Value;

use super::document::Document;
use super::edit::Edit;

/// Maximum number of variants that are shown.
pub const COUNT: usize = 9;

/// The quantity that varies.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Varied {
    /// The seed of the world, starting with the current one.
    Seed,
    /// A parameter of the recipe.
    Parameter(String),
    /// A parameter of a node.
    Param {
        /// The node.
        node: String,
        /// The parameter.
        key: String,
    },
}

impl Varied {
    /// The quantities that can vary: the seed, the parameters of the recipe, and the numbers of a node.
    #[must_use]
    pub fn of(document: &Document, node: Option<&str>) -> Vec<Varied> {
        let recipe = document.recipe();
        let mut all = vec![Varied::Seed];
        all.extend(recipe.parameters().iter().map(|parameter| Varied::Parameter(parameter.name.clone())));
        if let Some(named) = node.and_then(|node| recipe.nodes().iter().find(|named| named.name == node)) {
            let is_number = |param: &&ParamSpec| matches!(param.shape, Shape::Number | Shape::Integer);
            all.extend(
                named
                    .node
                    .spec()
                    .params
                    .iter()
                    .filter(is_number)
                    .map(|param| Varied::Param { node: named.name.clone(), key: param.name.to_owned() }),
            );
        }
        all
    }

    /// The edits that give the variants, each with its value; fewer than [`COUNT`] if values are whole and close
    /// together.
    #[must_use]
    pub fn edits(&self, document: &Document) -> Vec<(String, Edit)> {
        let recipe = document.recipe();
        match self {
            Varied::Seed => {
                let first = recipe.world.seed.min(i64::MAX as u64 - COUNT as u64);
                (0..COUNT as u64).map(|k| ((first + k).to_string(), Edit::Seed(first + k))).collect()
            }
            Varied::Parameter(name) => {
                let Some(parameter) = recipe.parameters().iter().find(|parameter| parameter.name == *name) else {
                    return Vec::new();
                };
                let edit = |value: f64| Edit::Default { parameter: name.clone(), value };
                sweep(parameter.value, parameter.range, false)
                    .into_iter()
                    .map(|value| (text(value), edit(value)))
                    .collect()
            }
            Varied::Param { node, key } => {
                let Some(named) = recipe.nodes().iter().find(|named| named.name == *node) else { return Vec::new() };
                numbers(&named.node, key)
                    .into_iter()
                    .map(|value| {
                        let label = value.number().map_or_else(String::new, text);
                        (label, Edit::Param { node: node.clone(), key: key.clone(), value })
                    })
                    .collect()
            }
        }
    }
}

fn text(value: f64) -> String {
    orogen::grid::words::number((value * 1e4).round() / 1e4)
}

/// Values of a parameter of a node.
fn numbers(node: &Node, key: &str) -> Vec<Value> {
    let spec = node.spec();
    let Some(i) = spec.param_named(key) else { return Vec::new() };
    let param = &spec.params[i];
    let is_whole = matches!(param.shape, Shape::Integer);
    let Some(own) = node.param(i).number() else { return Vec::new() };
    let value = |value: f64| if is_whole { Value::Integer(value as i64) } else { Value::Number(value) };
    sweep(own, param.range, is_whole).into_iter().map(value).collect()
}

/// Values from half of `own` to twice as much, within a range; if `own` is 0, values of the whole range, or from -1 to
/// 1.
fn sweep(own: f64, [low, high]: [f64; 2], is_whole: bool) -> Vec<f64> {
    let is_bounded = low.is_finite() && high.is_finite() && high - low <= 1e3;
    let [from, to] = match own {
        own if own != 0.0 => [own * 0.5, own * 2.0],
        _ if is_bounded => [low, high],
        _ => [-1.0, 1.0],
    };
    let mut values: Vec<f64> = (0..COUNT)
        .map(|k| {
            let share = k as f64 / (COUNT - 1) as f64;
            // Steps with equal ratios, with the value itself in the middle.
            let value = if own == 0.0 { from + (to - from) * share } else { from * libm::pow(4.0, share) };
            let value = if is_whole { value.round() } else { value };
            value.max(low).min(high)
        })
        .collect();
    values.sort_by(f64::total_cmp);
    values.dedup();
    values
}

#[cfg(test)]
mod tests {
    use super::*;
    use orogen::presets;

    #[test]
    fn sweeps_have_the_value_in_the_middle_and_stay_in_their_range() {
        let around = sweep(8.0, [0.0, 1e9], false);
        assert!((around[0], around[8]) == (4.0, 16.0) && (around[4] - 8.0).abs() < 1e-12);
        assert_eq!(sweep(4.0, [1.0, 6.0], true), [2.0, 3.0, 4.0, 5.0, 6.0]);
        assert_eq!(sweep(0.0, [0.0, 1.0], false)[8], 1.0);
        assert!(sweep(-2.0, [-9.0, 9.0], false).iter().all(|value| (-4.0..=-1.0).contains(value)));
    }

    #[test]
    fn every_variant_of_every_preset_is_a_recipe() {
        for preset in presets::all() {
            let document = Document::of_preset(preset).unwrap();
            for named in document.recipe().nodes() {
                for varied in Varied::of(&document, Some(&named.name)) {
                    for (value, edit) in varied.edits(&document) {
                        let mut variant = document.clone();
                        // Some values contradict other parameters; then nothing changes.
                        if variant.apply(&edit).is_ok() {
                            assert!(variant.is_valid(), "{}: {varied:?} {value}", preset.name);
                        }
                    }
                }
            }
        }
    }
}
