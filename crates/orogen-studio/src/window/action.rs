//! Actions of the user.

use std::path::PathBuf;

use orogen::Window;

use super::command::Command;
use super::purpose::Purpose;
use crate::catalogue::Language;
use crate::editing::brush::Effect;
use crate::editing::edit::Edit;
use crate::preview::coloring::Coloring;
use crate::preview::region::Region;
use crate::recovery::Unsaved;
use crate::settings::Theme;
use crate::settings::layout::Layout;

/// An action of the user.
#[derive(Debug, Clone, PartialEq)]
pub enum Action {
    /// Runs a command of the menus.
    Command(Command),
    /// Edits the recipe.
    Edit(Edit),
    /// Replaces the text of the recipe.
    Type(String),
    /// Ends a gesture, such as the drag of a slider.
    EndGesture,
    /// Goes to a step of the history.
    GoTo(usize),
    /// Selects nodes.
    Select(Vec<String>),
    /// Shows a layer.
    Show(String),
    /// Selects what the colors show.
    Color(Coloring),
    /// Opens the dialog of color ramps.
    EditColors,
    /// Reads a palette from a file, for editing.
    OpenPalette(PathBuf),
    /// Writes the edited palette to a file.
    SavePalette(PathBuf),
    /// Opens a dialog for choosing a file.
    Choose(Purpose),
    /// Sets the direction of the sun: azimuth and altitude in degrees.
    Sun([f64; 2]),
    /// Sets the interval of contours in metres; 0 chooses one that suits the land. `None` switches contours off.
    Contours(Option<f64>),
    /// Sets whether rivers and lakes are shown.
    Rivers(bool),
    /// Keeps the layout of the window under a name.
    KeepLayout(String),
    /// Forgets the kept layout of this name.
    DropLayout(String),
    /// Arranges the window anew.
    UseLayout(Layout),
    /// Keeps a camera of the 3D view.
    KeepView([f32; 6]),
    /// Forgets a kept camera.
    DropView(usize),
    /// Sets the number of samples along the longer side of the finest picture.
    Finest(usize),
    /// Requests rings of detail with these windows; `None` cancels the work for them.
    Refine(Option<Vec<Window>>),
    /// Selects the part of the world.
    Region(Region),
    /// Opens a preset.
    OpenPreset(&'static str),
    /// Opens a file.
    Open(PathBuf),
    /// Opens a text that was not saved.
    OpenUnsaved(Unsaved),
    /// Removes a text that was not saved.
    DropUnsaved(Unsaved),
    /// Saves the document to a file.
    Save(PathBuf),
    /// Asks for a file of the computer, in a page.
    Upload(Purpose),
    /// Sets whether files are chosen in dialogs of the system.
    SystemDialogs(bool),
    /// Sets the layout of the window.
    Layout(Layout),
    /// Sets the language of the interface.
    Language(Language),
    /// Sets the color theme of the interface.
    Theme(Theme),
    /// Starts drawing a line or an area, by its op.
    Draw(&'static str),
    /// Selects a brush.
    Brush(Effect),
    /// Shows a group in the graph.
    Enter(String),
    /// Copies a text to the clipboard.
    Copy(String),
    /// Shows a line of the text.
    GoToLine(usize),
}

impl Action {
    /// The action for a file that was chosen.
    #[must_use]
    pub fn of_file(purpose: Purpose, path: PathBuf) -> Action {
        match purpose {
            Purpose::Open => Action::Open(path),
            Purpose::Save => Action::Save(path),
            Purpose::OpenPalette => Action::OpenPalette(path),
            Purpose::SavePalette => Action::SavePalette(path),
        }
    }
}
