//! The boxes and wires of a recipe.

use orogen::declare::Input;
use orogen::grid::words::number;
use orogen::ids::Id;
use orogen::node::Node;
use orogen::recipe::Graph;
use orogen::value::Value;
use orogen::{Recipe, Result};

/// The kind of a box.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    /// A node whose samples depend on one position.
    Field,
    /// A node whose samples depend on a finite halo.
    Filter,
    /// A node whose samples depend on the whole world.
    Solver,
    /// An output of the recipe.
    Output,
}

impl Kind {
    /// All kinds.
    pub const ALL: [Kind; 4] = [Kind::Field, Kind::Filter, Kind::Solver, Kind::Output];

    /// The name.
    pub fn name(self) -> &'static str {
        match self {
            Kind::Field => "field",
            Kind::Filter => "filter",
            Kind::Solver => "solver",
            Kind::Output => "output",
        }
    }
}

/// A box.
#[derive(Debug, Clone, PartialEq)]
pub struct Block {
    /// The kind.
    pub kind: Kind,
    /// The node's or the output's name.
    pub name: String,
    /// The op; empty for an output.
    pub op: &'static str,
    /// The lines below the name: inputs, then parameters that differ from their defaults.
    pub rows: Vec<String>,
    /// Whether an output depends on it.
    pub used: bool,
}

/// A wire from one box to another.
#[derive(Debug, Clone, PartialEq)]
pub struct Wire {
    /// The box that is read.
    pub from: usize,
    /// The layer that is read, unless it is the first.
    pub layer: Option<&'static str>,
    /// The box that reads.
    pub to: usize,
    /// The row at which the wire ends; `None` for an output, which has no rows.
    pub row: Option<usize>,
}

/// Boxes and wires.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Diagram {
    /// The nodes in the order of evaluation, then the outputs.
    pub blocks: Vec<Block>,
    /// The wires.
    pub wires: Vec<Wire>,
}

/// Maximum number of parameter lines of a box.
const MAX_PARAMS: usize = 6;

/// Maximum number of characters of a name or a line.
const MAX_LETTERS: usize = 40;

impl Diagram {
    /// The boxes and wires of a recipe.
    ///
    /// # Errors
    /// If the recipe is not valid.
    pub fn of(recipe: &Recipe) -> Result<Diagram> {
        let graph = Graph::resolve(recipe).map_err(Graph::error)?;
        let mut block_of = vec![0; recipe.nodes().len()];
        graph.order.iter().enumerate().for_each(|(block, node)| block_of[node.index()] = block);
        let mut diagram = Diagram::default();
        let wire = |text: &str, to: usize, row: Option<usize>| {
            let target = Graph::find(recipe, text).ok()?;
            let layers = recipe.nodes()[target.node.index()].node.layers();
            let layer = (target.layer > 0).then(|| layers[target.layer].name);
            Some(Wire { from: block_of[target.node.index()], layer, to, row })
        };
        for (to, &index) in graph.order.iter().enumerate() {
            let named = &recipe.nodes()[index.index()];
            let spec = named.node.spec();
            let mut rows = Vec::new();
            let names = named.node.inputs();
            let inputs = names.iter().enumerate().map(|(i, input)| (input.name, named.node.input(i)));
            for (name, input) in inputs.chain([("mask", &named.mask)]) {
                match input {
                    Input::None => {}
                    Input::Value(value) => rows.push(format!("{name} {}", number(*value))),
                    Input::Node(text) => {
                        diagram.wires.extend(wire(text, to, Some(rows.len())));
                        rows.push(name.to_string());
                    }
                }
            }
            let mut params = params(&named.node);
            let more = params.len().saturating_sub(MAX_PARAMS);
            params.truncate(MAX_PARAMS);
            rows.append(&mut params);
            if more > 0 {
                rows.push(format!("and {more} more"));
            }
            let kind = match spec.locality.name() {
                "field" => Kind::Field,
                "filter" | "levelled" => Kind::Filter,
                _ => Kind::Solver,
            };
            diagram.blocks.push(Block { kind, name: cut(&named.name), op: spec.op, rows, used: false });
        }
        for (name, input) in recipe.output_inputs() {
            let to = diagram.blocks.len();
            let rows = match input {
                Input::Value(value) => vec![number(*value)],
                _ => Vec::new(),
            };
            if let Input::Node(text) = input {
                diagram.wires.extend(wire(text, to, None));
            }
            diagram.blocks.push(Block { kind: Kind::Output, name: cut(name), op: "", rows, used: true });
        }
        // A box comes after the boxes that it reads, so one pass backwards from the outputs suffices.
        let mut wires: Vec<&Wire> = diagram.wires.iter().collect();
        wires.sort_by_key(|wire| std::cmp::Reverse(wire.to));
        for wire in wires {
            let used = diagram.blocks[wire.to].used;
            diagram.blocks[wire.from].used |= used;
        }
        Ok(diagram)
    }
}

/// The parameters that differ from their defaults, as "name value unit".
fn params(node: &Node) -> Vec<String> {
    let spec = node.spec();
    let usual = Node::named(spec.op);
    (spec.params.iter().enumerate())
        .filter(|(i, _)| usual.as_ref().is_none_or(|usual| usual.param(*i) != node.param(*i)))
        .map(|(i, param)| {
            let unit = if param.unit.is_empty() { String::new() } else { format!(" {}", param.unit) };
            cut(&format!("{} {}{unit}", param.name, brief(&node.param(i))))
        })
        .collect()
}

/// A short form of a value.
fn brief(value: &Value) -> String {
    match value {
        Value::Number(value) => number(*value),
        Value::Text(text) => text.clone(),
        Value::List(items) if items.len() > 2 => format!("({} of them)", items.len()),
        Value::List(items) => items.iter().map(|item| brief(&item.value)).collect::<Vec<_>>().join(", "),
        other => other.to_toml(),
    }
}

fn cut(text: &str) -> String {
    match text.chars().count() > MAX_LETTERS {
        true => text.chars().take(MAX_LETTERS - 3).chain("...".chars()).collect(),
        false => text.to_string(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn boxes_and_wires_of_a_recipe() {
        let text = "orogen = 1\n[world]\nsize = 1000\n[nodes.out]\nop = \"mix\"\na = \"rivers.strahler\"\nb = 5.25\namount = \"hills\"\nmask = \"hills\"\n\
                    [nodes.rivers]\nop = \"drainage\"\nsource = \"hills\"\n[nodes.hills]\nop = \"fbm\"\nwavelength = 300\n[nodes.spare]\nop = \
                    \"blur\"\nsource = \"hills\"\n[outputs]\nheight = \"out\"\nflat = 7\n";
        let diagram = Diagram::of(&Recipe::parse(text, "test").unwrap()).unwrap();
        let at = |name: &str| diagram.blocks.iter().position(|block| block.name == name).unwrap();
        let block = |name: &str| &diagram.blocks[at(name)];
        assert_eq!(diagram.blocks.len(), 6);
        assert_eq!(block("out").rows, ["a", "b 5.25", "amount", "mask"]);
        assert_eq!(
            (block("hills").kind, block("hills").rows.as_slice()),
            (Kind::Field, &["wavelength 300 m".to_string()][..])
        );
        let kinds = ["rivers", "spare", "height"].map(|name| block(name).kind);
        assert_eq!(kinds, [Kind::Solver, Kind::Filter, Kind::Output]);
        assert_eq!(block("flat").rows, ["7"]);
        let used: Vec<bool> = ["out", "rivers", "hills", "spare", "height"].map(|name| block(name).used).into();
        assert_eq!(used, [true, true, true, false, true]);
        let wire = |from: &str, layer, to: &str, row| Wire { from: at(from), layer, to: at(to), row };
        for wire in [
            wire("rivers", Some("strahler"), "out", Some(0)),
            wire("hills", None, "out", Some(2)),
            wire("hills", None, "out", Some(3)),
            wire("hills", None, "rivers", Some(0)),
            wire("hills", None, "spare", Some(0)),
            wire("out", None, "height", None),
        ] {
            assert!(diagram.wires.contains(&wire), "{wire:?} in {:?}", diagram.wires);
        }
        assert_eq!(diagram.wires.len(), 6);
    }
}
