//! The diagram as Graphviz source.

use std::fmt::Write;

use super::diagram::{Block, Diagram};
use super::draw::color;
use orogen::io::palette::color::hex;

/// The source: boxes with their lines, colored by kind, and wires labeled with layers.
pub fn text(diagram: &Diagram, title: &str) -> String {
    let mut text = format!(
        "digraph {} {{\n  rankdir = LR;\n  node [shape = box, style = \"filled,rounded\", fontname = \"sans-serif\", fontcolor = white];\n  \
         edge [fontname = \"sans-serif\", fontsize = 10];\n",
        quoted(title)
    );
    // Writing to a string does not fail.
    for (k, block) in diagram.blocks.iter().enumerate() {
        let fill = hex(color(block.kind)) + if block.used { "" } else { "60" };
        let _ = writeln!(text, "  b{k} [label = {}, fillcolor = \"{fill}\"];", label(block));
    }
    for wire in &diagram.wires {
        let reader = &diagram.blocks[wire.to];
        let input = wire.row.and_then(|row| reader.rows.get(row));
        let head = input.map_or(String::new(), |input| format!(" [headlabel = {}]", quoted(input)));
        let layer = wire.layer.map_or(String::new(), |layer| format!(" [label = {}]", quoted(layer)));
        let _ = writeln!(text, "  b{} -> b{}{layer}{head};", wire.from, wire.to);
    }
    text + "}\n"
}

/// The box's name, op and parameters, without the inputs, which wires show.
fn label(block: &Block) -> String {
    let head = if block.op.is_empty() { block.kind.name() } else { block.op };
    let settings = block.rows.iter().filter(|row| row.contains(' ')).cloned();
    let lines: Vec<String> = [block.name.clone(), head.to_string()].into_iter().chain(settings).collect();
    quoted(&lines.join("\n"))
}

/// Quotes a string for DOT.
fn quoted(text: &str) -> String {
    format!("\"{}\"", text.replace('\\', "\\\\").replace('"', "\\\"").replace('\n', "\\n"))
}
