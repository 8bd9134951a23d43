//! Descriptions of the ops, made from their declarations.

use crate::registry::Registry;
use orogen_ops::declare::{ParamSpec, Shape, Spec, TableSpec, short};
use orogen_ops::layer::{Interpolation, Layer, ONE_LAYER};
use orogen_ops::node::Node;
use orogen_ops::value::Value;
use std::fmt::Write as _;

/// One line per built-in op: its name, its locality and what it does.
#[must_use]
pub fn overview() -> String {
    overview_of(&Registry::new())
}

/// One line for each of these ops.
#[must_use]
pub fn overview_of(registry: &Registry) -> String {
    let nodes = registry.nodes();
    let longest = nodes.iter().map(|node| node.spec().op.len()).max().unwrap_or(0);
    let mut text = String::new();
    for node in &nodes {
        let spec = node.spec();
        let _ = writeln!(text, "{:longest$}  {:8}  {}", spec.op, spec.locality.name(), first_sentence(spec));
    }
    text
}

/// The first sentence of an op's doc.
#[must_use]
pub fn first_sentence(spec: &Spec) -> String {
    let doc = short(spec.doc);
    match doc.find(". ") {
        Some(end) => doc[..end].to_string(),
        None => doc.trim_end_matches('.').to_string(),
    }
}

/// The complete description of an op, for a terminal.
#[must_use]
pub fn describe(node: &Node) -> String {
    let spec = node.spec();
    let mut text = format!("{} ({})\n\n{}\n", spec.op, spec.locality.name(), spec.doc.trim());
    text = text.lines().map(|line| format!("{}\n", line.trim())).collect();
    if !spec.inputs.is_empty() {
        text.push_str("\ninputs: a node, `node.layer`, or a number\n");
    }
    let longest =
        spec.inputs.iter().map(|input| input.name.len()).chain(spec.params.iter().map(|p| p.name.len())).max();
    let longest = longest.unwrap_or(0);
    if spec.named_inputs {
        text.push_str(
            "\ninputs: a key for each name in the expression that is not a node: a node, `node.layer`, or a number\n",
        );
    }
    for input in spec.inputs {
        let optional = if input.required { "" } else { " (optional)" };
        let _ = writeln!(text, "  {:longest$}  {}{optional}", input.name, short(input.doc));
    }
    if !spec.params.is_empty() {
        text.push_str("\nparameters\n");
    }
    for (i, param) in spec.params.iter().enumerate() {
        let default = node.param(i).to_toml();
        let _ = writeln!(text, "  {:longest$}  {}", param.name, short(param.doc));
        let _ = writeln!(text, "  {:longest$}  {}; default {default}", "", param.expected());
        match param.shape {
            Shape::Choice(choices) => {
                for (name, doc) in choices() {
                    let _ = writeln!(text, "  {:longest$}    {name:?}: {}", "", short(doc));
                }
            }
            Shape::Tables(table) => {
                for key in table_keys(table) {
                    let default =
                        key.default.map_or("required".to_string(), |value| format!("default {}", value.to_toml()));
                    let _ = writeln!(text, "  {:longest$}    {}: {}", "", key.spec.name, short(key.spec.doc));
                    let _ = writeln!(text, "  {:longest$}      {}; {default}", "", key.spec.expected());
                }
            }
            _ => {}
        }
    }
    if names_layers(spec) {
        text.push_str("\nlayers; the first one is also the node's own value\n");
        let longest = spec.layers.iter().map(|layer| layer.name.len()).max().unwrap_or(0);
        for layer in spec.layers {
            let _ = writeln!(text, "  {:longest$}  {}", layer.name, short(layer.doc));
            let _ = writeln!(text, "  {:longest$}  between samples: {}", "", between(layer));
        }
    }
    text
}

/// Whether an op lists its layers; most fields do not, because they have only one.
fn names_layers(spec: &Spec) -> bool {
    spec.layers.iter().map(|layer| layer.name).ne(ONE_LAYER.iter().map(|layer| layer.name))
}

/// The interpolation of a layer, and its unit.
fn between(layer: &Layer) -> String {
    let how = match layer.interpolation {
        Interpolation::As(kind) => kind.about(),
        Interpolation::AsSource => "as the source is",
    };
    match layer.unit {
        "" => how.to_string(),
        unit => format!("{how} ({unit})"),
    }
}

/// The reference of all built-in ops as a page of documentation, Markdown.
#[must_use]
pub fn markdown() -> String {
    format!(
        "<!-- Written by `cargo xtask codegen` from the declarations in crates/orogen-ops/src. Do not edit. -->\n\n{}",
        markdown_of(&Registry::new())
    )
}

/// The reference of these ops as a page of documentation, Markdown.
#[must_use]
pub fn markdown_of(registry: &Registry) -> String {
    let nodes = registry.nodes();
    let mut text = String::from(
        "# The ops\n\n\
         Each node of a recipe has an `op`. The value of an input is the name of a node, the name of one of its layers (`node.layer`; \
         the node's name alone is its first layer), or a number. \
         Every node also has an optional input `mask`, from 0 to 1: the result is mixed with the node's first input (or with 0, \
         if it has none), so that 0 shows the input and 1 the result. Lengths are in metres; noise is in -1 ..= 1.\n",
    );
    for (locality, about) in [
        ("field", "evaluated at each point independently, at any resolution"),
        ("filter", "each sample depends on a finite halo around it"),
        ("levelled", "made level by level, each from a finite halo of the next coarser one"),
        ("solver", "solved once over the whole bounded world"),
    ] {
        let _ = write!(text, "\n## {}s: {about}\n", capital(locality));
        for node in nodes.iter().filter(|node| node.spec().locality.name() == locality) {
            section(&mut text, node);
        }
    }
    text
}

fn section(text: &mut String, node: &Node) {
    let spec = node.spec();
    let _ = write!(text, "\n### `{}`\n\n", spec.op);
    for line in spec.doc.trim().lines() {
        let _ = writeln!(text, "{}", line.trim());
    }
    keys(text, node);
    if names_layers(spec) {
        text.push_str("\n| layer | description | between samples |\n|---|---|---|\n");
        for layer in spec.layers {
            let _ = writeln!(text, "| `{}` | {} | {} |", layer.name, short(layer.doc), between(layer));
        }
    }
}

/// The keys of a node.
fn keys(text: &mut String, node: &Node) {
    let spec = node.spec();
    if spec.inputs.is_empty() && spec.params.is_empty() {
        return;
    }
    text.push_str("\n| key | description | values | default |\n|---|---|---|---|\n");
    for input in spec.inputs {
        let needed = if input.required { "required" } else { "none" };
        let _ = writeln!(text, "| `{}` | {} | input | {needed} |", input.name, short(input.doc));
    }
    if spec.named_inputs {
        let _ = writeln!(
            text,
            "| any name | Value of this name in the expression. | input | the parameter or node of that name |"
        );
    }
    for (i, param) in spec.params.iter().enumerate() {
        let takes = taken(param);
        let default = match node.param(i) {
            Value::List(items) if items.is_empty() => "none".to_string(),
            // A drawing is given as points or as a file.
            Value::Text(text) if text.is_empty() && has_points(spec) => "none".to_string(),
            Value::Text(text) if text.is_empty() => "required".to_string(),
            Value::Text(text) => format!("`{text}`"),
            other => format!("`{}`", other.to_toml()),
        };
        let _ = writeln!(text, "| `{}` | {} | {} | {default} |", param.name, cell(short(param.doc)), cell(takes));
    }
    for param in spec.params {
        let Shape::Tables(table) = param.shape else { continue };
        let _ = writeln!(text, "\n| key of a {} | description | values | default |\n|---|---|---|---|", table.names[0]);
        for key in table_keys(table) {
            let default = key.default.map_or("required".to_string(), |value| format!("`{}`", value.to_toml()));
            let (doc, takes) = (cell(short(key.spec.doc)), cell(taken(key.spec)));
            let _ = writeln!(text, "| `{}` | {doc} | {takes} | {default} |", key.spec.name);
        }
    }
}

/// The text of a cell of a table.
fn cell(text: String) -> String {
    text.replace('|', "\\|")
}

/// The values of a parameter.
fn taken(param: &ParamSpec) -> String {
    match param.shape {
        Shape::Choice(choices) => {
            let choices = choices();
            let name = |(name, doc): &(&str, &str)| format!("`{name}` ({})", short(doc).trim_end_matches('.'));
            choices.iter().map(name).collect::<Vec<_>>().join("; ")
        }
        _ => param.expected(),
    }
}

/// A key of a table in a list.
struct TableKey {
    spec: &'static ParamSpec,
    /// `None` if every table has it.
    default: Option<Value>,
}

fn table_keys(table: &TableSpec) -> impl Iterator<Item = TableKey> {
    let required = table.required;
    let keys = table.keys.iter().zip((table.defaults)()).enumerate();
    keys.map(move |(k, (spec, value))| TableKey { spec, default: (k >= required).then_some(value) })
}

fn has_points(spec: &Spec) -> bool {
    spec.params.iter().any(|param| matches!(param.shape, Shape::Points(_)))
}

fn capital(word: &str) -> String {
    let mut letters = word.chars();
    letters.next().map_or_else(String::new, |first| first.to_uppercase().chain(letters).collect())
}
