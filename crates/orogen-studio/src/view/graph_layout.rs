//! A tidy layout of a recipe's graph: columns by what a node reads, rows so that few wires cross.

use std::collections::HashMap;

use orogen::declare::Input;
use orogen::recipe::document::Recipe;

/// The position of a node: its column, from 0 at the left, and its row.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NodePosition {
    /// The column.
    pub column: usize,
    /// The row; rows of a column are at least 1 apart.
    pub row: f32,
}

/// Sweeps over the columns.
const SWEEPS: usize = 8;

/// The node of a reference to a node or a layer of one.
#[must_use]
pub fn source_of(input: &Input) -> Option<&str> {
    match input {
        Input::Node(name) => Some(name.split_once('.').map_or(name.as_str(), |(node, _)| node)),
        _ => None,
    }
}

/// The sources of a node, by the names of its inputs; `mask` is the last one.
#[must_use]
pub fn wires(recipe: &Recipe, at: usize) -> Vec<(String, String)> {
    let named = &recipe.nodes()[at];
    let inputs = named.node.inputs();
    let own = inputs.iter().enumerate().map(|(i, input)| (input.name.to_owned(), named.node.input(i)));
    own.chain([("mask".to_owned(), &named.mask)])
        .filter_map(|(key, input)| Some((key, source_of(input)?.to_owned())))
        .collect()
}

/// The places of all nodes, in their order. Nodes of a circle are placed, too.
#[must_use]
pub fn tidy(recipe: &Recipe) -> Vec<NodePosition> {
    let names: HashMap<&str, usize> =
        recipe.nodes().iter().enumerate().map(|(at, named)| (named.name.as_str(), at)).collect();
    let count = recipe.nodes().len();
    let sources: Vec<Vec<usize>> = (0..count)
        .map(|at| wires(recipe, at).iter().filter_map(|(_, source)| names.get(source.as_str()).copied()).collect())
        .collect();
    let columns = columns(&sources);
    let mut readers = vec![Vec::new(); count];
    for (at, sources) in sources.iter().enumerate() {
        sources.iter().for_each(|source| readers[*source].push(at));
    }
    let last = columns.iter().copied().max().unwrap_or(0);
    let mut members: Vec<Vec<usize>> = vec![Vec::new(); last + 1];
    columns.iter().enumerate().for_each(|(at, column)| members[*column].push(at));
    let mut rows: Vec<f32> = vec![0.0; count];
    members.iter().for_each(|column| place(column, &mut rows, |k, _| k as f32));
    for sweep in 0..SWEEPS {
        let is_forward = sweep % 2 == 0;
        let order: Vec<usize> = if is_forward { (0..=last).collect() } else { (0..=last).rev().collect() };
        for column in order {
            let mut wanted: Vec<(f32, usize)> = members[column]
                .iter()
                .map(|at| {
                    let near = if is_forward { &sources[*at] } else { &readers[*at] };
                    let mean = near.iter().map(|other| rows[*other]).sum::<f32>() / near.len().max(1) as f32;
                    (if near.is_empty() { rows[*at] } else { mean }, *at)
                })
                .collect();
            wanted.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
            members[column] = wanted.iter().map(|(_, at)| *at).collect();
            place(&members[column], &mut rows, |k, _| wanted[k].0);
        }
    }
    let top = rows.iter().copied().fold(f32::INFINITY, f32::min);
    columns.iter().zip(&rows).map(|(column, row)| NodePosition { column: *column, row: row - top }).collect()
}

/// The column of each node: one more than the largest of its sources.
fn columns(sources: &[Vec<usize>]) -> Vec<usize> {
    let mut columns = vec![0; sources.len()];
    // Without circles as many rounds as there are columns suffice.
    for _ in 0..sources.len() {
        let mut changed = false;
        for at in 0..sources.len() {
            let column = sources[at].iter().map(|source| columns[*source] + 1).max().unwrap_or(0);
            if column > columns[at] && column < sources.len() {
                columns[at] = column;
                changed = true;
            }
        }
        if !changed {
            break;
        }
    }
    columns
}

/// Places nodes of a column, in this order, near the rows that they want and at least 1 apart.
fn place(members: &[usize], rows: &mut [f32], wanted: impl Fn(usize, usize) -> f32) {
    let mut next = f32::NEG_INFINITY;
    let mut sum = 0.0;
    for (k, at) in members.iter().enumerate() {
        let want = wanted(k, *at);
        rows[*at] = want.max(next);
        next = rows[*at] + 1.0;
        sum += rows[*at] - want;
    }
    // What was pushed down is shared out.
    let shift = sum / members.len().max(1) as f32;
    members.iter().for_each(|at| rows[*at] -= shift);
}

#[cfg(test)]
mod tests {
    use super::*;
    use orogen::presets;

    #[test]
    fn nodes_are_right_of_what_they_read_and_do_not_overlap() {
        for preset in presets::all() {
            let recipe = preset.recipe().unwrap();
            let places = tidy(&recipe);
            let at = |name: &str| recipe.nodes().iter().position(|named| named.name == name);
            for (n, place) in places.iter().enumerate() {
                for (_, source) in wires(&recipe, n) {
                    if let Some(source) = at(&source) {
                        assert!(places[source].column < place.column, "{}: {source}", preset.name);
                    }
                }
                for other in &places[..n] {
                    let apart = (place.row - other.row).abs();
                    assert!(other.column != place.column || apart > 0.99, "{}: {place:?} {other:?}", preset.name);
                }
                assert!(place.row >= 0.0);
            }
        }
    }
}
