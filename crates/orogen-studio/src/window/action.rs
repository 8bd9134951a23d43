//! What a person asks for.

use std::path::PathBuf;

use super::command::Command;
use super::purpose::Purpose;
use crate::catalogue::Language;
use crate::editing::brush::Effect;
use crate::editing::edit::Edit;
use crate::preview::coloring::Coloring;
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
    /// What the colors show.
    Color(Coloring),
    /// The dialog of color ramps is opened.
    EditColors,
    /// A palette is read from a file, to be edited.
    OpenPalette(PathBuf),
    /// The edited palette is written to a file.
    SavePalette(PathBuf),
    /// A file is to be chosen.
    Choose(Purpose),
    /// The direction of the sun: azimuth and altitude in degrees.
    Sun([f64; 2]),
    /// The interval of contours in metres, 0 for one that suits the land; none if `None`.
    Contours(Option<f64>),
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
    /// A brush is taken on the map.
    Brush(Effect),
    /// A group is shown in the graph.
    Enter(String),
    /// A text is copied.
    Copy(String),
    /// A line of the text is shown.
    GoToLine(usize),
}
