//! Lines and areas drawn on the map: the points of `path` and `polygon`.

use orogen::node::Node;
use orogen::value::{Spanned, Value};

/// The parameter with the points.
pub const POINTS: &str = "points";

/// The ops that are drawn on the map.
pub const OPS: [&str; 2] = ["path", "polygon"];

/// Converts points to a value of a recipe.
#[must_use]
pub fn value(points: &[[f64; 2]]) -> Value {
    Value::List(points.iter().map(|point| Spanned::unplaced(numbers(point))).collect())
}

/// Converts numbers to a value of a recipe.
#[must_use]
pub fn numbers(numbers: &[f64]) -> Value {
    Value::List(numbers.iter().map(|number| Spanned::unplaced(Value::Number(*number))).collect())
}

/// The points of a node with a single line or area in the plane; `None` for other nodes, several lines, and points with
/// heights, which are edited as text.
#[must_use]
pub fn points_of(node: &Node) -> Option<Vec<[f64; 2]>> {
    let spec = node.spec();
    if !OPS.contains(&spec.op) {
        return None;
    }
    let Value::List(items) = node.param(spec.param_named(POINTS)?) else { return None };
    let pair = |item: &Spanned<Value>| match &item.value {
        Value::List(parts) if parts.len() == 2 => Some([parts[0].value.number()?, parts[1].value.number()?]),
        _ => None,
    };
    items.iter().map(pair).collect::<Option<Vec<_>>>().filter(|points| !points.is_empty())
}
