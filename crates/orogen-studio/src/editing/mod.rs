//! The edited recipe: its text, the parsed recipe, edits that keep comments, and undo.

pub mod adding;
pub mod brush;
pub mod bypass;
pub mod document;
pub mod drawing;
pub mod drawing_use;
pub mod edit;
pub mod expression;
pub mod ground;
pub mod groups;
pub mod history;
pub mod kept;
pub mod names;
pub mod notes;
pub mod reader;
mod references;
pub mod reroutes;
pub mod strokes;
mod tables;
mod thinning;
pub mod variants;

#[cfg(test)]
mod kept_tests;
#[cfg(test)]
mod tests;
