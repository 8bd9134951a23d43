//! `/recipe.json`: the seed and the numbers of a recipe that requests can set, for sliders.

use axum::response::Response;
use orogen::declare::short;
use orogen::recipe::Parameter;
use orogen::recipe::values::NodeScalar;
use serde_json::{Value, json};

use crate::answer;
use crate::call::Call;
use crate::refusal::Refusal;

/// The answer.
pub async fn recipe(call: Call) -> Result<Response, Refusal> {
    call.query.only_of_variants(&[])?;
    let served = call.served()?;
    let recipe = served.recipe();
    let spec = &recipe.world;
    let text = json!({
        "name": served.name,
        "about": recipe.about,
        "version": served.version,
        "seed": spec.seed,
        "size": spec.size,
        "cell": spec.cell,
        "sea_level": spec.sea_level,
        "parameters": recipe.parameters().iter().map(parameter).collect::<Vec<_>>(),
        "nodes": recipe.scalars().iter().map(scalar).collect::<Vec<_>>(),
    });
    answer::text(&call.headers, "application/json", &text.to_string(), call.is_private())
}

/// `/recipe.toml`: the recipe itself, or the variant that the parameters ask for.
pub async fn text(call: Call) -> Result<Response, Refusal> {
    call.query.only_of_variants(&[])?;
    let served = call.served()?;
    answer::text(&call.headers, "application/toml", &served.recipe().to_toml(), call.is_private())
}

/// A range in JSON, which has no infinite numbers.
fn range(range: [f64; 2]) -> Value {
    json!(range.map(|bound| bound.is_finite().then_some(bound)))
}

/// A parameter of the recipe.
fn parameter(parameter: &Parameter) -> Value {
    json!({
        "set": parameter.name,
        "value": parameter.value,
        "range": range(parameter.range),
        "unit": parameter.unit,
        "doc": parameter.help,
    })
}

/// A scalar parameter of a node.
fn scalar(scalar: &NodeScalar) -> Value {
    json!({
        "set": scalar.name(),
        "node": scalar.node,
        "op": scalar.op,
        "parameter": scalar.key,
        "value": scalar.value,
        "whole": scalar.is_whole,
        "range": range(scalar.range),
        "unit": scalar.unit,
        "doc": short(scalar.doc),
        "formula": (!scalar.formula.is_empty()).then_some(&scalar.formula),
    })
}
