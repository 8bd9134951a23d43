//! What a person asks for.

use std::path::PathBuf;

use super::command::Command;
use crate::catalogue::Language;
use crate::editing::edit::Edit;
use crate::preview::region::Region;
use crate::settings::Theme;

/// Something that a person asks for.
#[derive(Debug, Clone, PartialEq)]
pub enum Action {
    /// A command of the menus.
    Command(Command),
    /// An edit of the recipe.
    Edit(Edit),
    /// Another text of the recipe.
    Type(String),
    /// The end of a gesture, such as the drag of a slider.
    EndGesture,
    /// The selected nodes.
    Select(Vec<String>),
    /// The layer that is shown.
    Show(String),
    /// The palette; that of the layer if `None`.
    Palette(Option<String>),
    /// The direction of the sun: azimuth and altitude in degrees.
    Sun([f64; 2]),
    /// Samples along the longer side of the finest picture.
    Finest(usize),
    /// The part of the world.
    Region(Region),
    /// A preset is opened.
    OpenPreset(&'static str),
    /// A file is opened.
    Open(PathBuf),
    /// The document is saved to a file.
    Save(PathBuf),
    /// The language of the interface.
    Language(Language),
    /// The colors of the interface.
    Theme(Theme),
    /// A line or an area is drawn on the map, by its op.
    Draw(&'static str),
    /// A group is shown in the graph.
    Enter(String),
    /// A text is copied.
    Copy(String),
    /// A line of the text is shown.
    GoToLine(usize),
}
