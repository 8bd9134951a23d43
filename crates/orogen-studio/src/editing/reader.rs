//! What reads a node.

use orogen::declare::Input;
use orogen::recipe::Recipe;

/// What reads a node.
#[derive(Debug, Clone, PartialEq, Eq)]
#[allow(missing_docs, reason = "the names of fields say what they are")]
pub enum Reader {
    /// An input of a node, or its `mask`.
    Input { node: String, key: String },
    /// An output of the recipe.
    Output(String),
}

/// The node or layer that a reader reads.
pub(super) fn read_by(recipe: &Recipe, reader: &Reader) -> Option<String> {
    let input = match reader {
        Reader::Output(name) => {
            recipe.output_inputs().iter().find(|(output, _)| output == name).map(|(_, input)| input)
        }
        Reader::Input { node, key } => {
            let named = recipe.nodes().iter().find(|named| named.name == *node)?;
            let own = named.node.inputs().iter().position(|input| input.name == key);
            own.map(|i| named.node.input(i)).or((key == "mask").then_some(&named.mask))
        }
    };
    match input? {
        Input::Node(source) => Some(source.clone()),
        _ => None,
    }
}
