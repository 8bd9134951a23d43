//! `orogen ops`.

use orogen::grid::words::suggestion;
use orogen::node::Node;
use orogen::recipe::reference;

use crate::failure::Failure;
use crate::say;

/// Arguments of the command.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// The op to describe
    op: Option<String>,
    /// Print the reference of all ops as Markdown
    #[arg(long, conflicts_with = "op")]
    markdown: bool,
}

/// Prints the list, or the description of one op: its inputs and its parameters with units, ranges and defaults.
pub fn run(args: &Args) -> Result<(), Failure> {
    match &args.op {
        _ if args.markdown => say::out(&reference::markdown()),
        None => say::out(&reference::overview()),
        Some(op) => match Node::named(op) {
            Some(node) => say::out(&reference::describe(&node)),
            None => {
                let all = Node::all();
                let hint = suggestion(op, all.iter().map(|node| node.spec().op));
                Err(Failure::Usage(format!("there is no op `{op}`; {hint}")))
            }
        },
    }
}
