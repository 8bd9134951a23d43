//! The open dialogs.

use std::sync::mpsc::TryRecvError;

use eframe::egui::Context;

use super::action::Action;
use super::dialogs::{self, CommandPalette, FileDialog};
use super::export_dialog::ExportDialog;
use super::purpose::Purpose;
use super::ramp_editor::RampEditor;
use super::recovery_dialog::RecoveryDialog;
use super::relief_panel::ShownView;
use super::system_dialog::SystemDialog;
use super::tour::Tour;
use crate::catalogue::Language;
use crate::platform::Chosen;
use crate::preview::worker::Wake;
use crate::studio::Studio;

/// The open dialogs.
#[derive(Default)]
pub struct OpenDialogs {
    /// The dialog for choosing a file.
    pub files: Option<FileDialog>,
    /// The dialog of the system for choosing a file.
    pub system: Option<SystemDialog>,
    /// A file that arrives from the computer, in a page.
    pub upload: Option<(Purpose, Chosen)>,
    /// The editor for the colors of the view.
    pub ramp: Option<RampEditor>,
    /// The export dialog.
    pub export: Option<ExportDialog>,
    /// The offer of texts that were not saved.
    pub recovery: Option<RecoveryDialog>,
    /// The command palette.
    pub palette: Option<CommandPalette>,
    /// The tour.
    pub tour: Option<Tour>,
    /// Whether the list of shortcuts is shown.
    pub has_shortcuts: bool,
    /// A message: title and text.
    pub message: Option<(String, String)>,
}

impl OpenDialogs {
    /// Shows the open dialogs. `shown` is the document with the settings of the 3D view, if there is one.
    pub fn show(
        &mut self,
        context: &Context,
        shown: Option<(&Studio, &ShownView)>,
        wake: &Wake,
        language: Language,
        actions: &mut Vec<Action>,
    ) {
        let studio = shown.map(|(studio, _)| studio);
        self.recovery.take_if(|recovery| !recovery.show(context, language, actions));
        self.end_system(actions);
        self.end_upload(language, actions);
        self.files.take_if(|files| !files.show(context, language, actions));
        self.ramp.take_if(|ramp| studio.is_none() || !ramp.show(context, language, actions));
        if let Some(shown) = shown {
            self.export.take_if(|export| !export.show(context, shown, wake, language, actions));
        }
        self.palette.take_if(|palette| !palette.show(context, studio, language, actions));
        self.tour.take_if(|tour| !tour.show(context, studio, language, actions));
        if self.has_shortcuts {
            self.has_shortcuts = dialogs::shortcuts(context, language);
        }
        self.message.take_if(|(title, text)| !dialogs::message(context, title, text));
    }

    /// Whether a file is being chosen.
    #[must_use]
    pub fn is_choosing(&self) -> bool {
        self.files.is_some() || self.system.is_some()
    }

    /// Takes a file that has arrived from the computer.
    fn end_upload(&mut self, language: Language, actions: &mut Vec<Action>) {
        let Some((purpose, chosen)) = &self.upload else { return };
        match chosen.try_recv() {
            Ok(Ok(path)) => {
                actions.push(Action::of_file(*purpose, path));
                self.files = None;
            }
            Ok(Err(why)) => {
                self.message = Some((language.text("message.title").into(), language.message(&why).into_owned()));
            }
            Err(TryRecvError::Empty) => return,
            Err(TryRecvError::Disconnected) => {}
        }
        self.upload = None;
    }

    /// Takes what was chosen in the dialog of the system.
    fn end_system(&mut self, actions: &mut Vec<Action>) {
        let Some((purpose, end)) = self.system.as_ref().and_then(|system| Some((system.purpose(), system.end()?)))
        else {
            return;
        };
        self.system = None;
        let Some(path) = end else { return };
        let completed = purpose.completed(path.clone());
        // The system asked about the name that was typed, not about the one with an extension.
        match completed != path && completed.exists() {
            true => self.files = Some(FileDialog::asking(purpose, &completed)),
            false => actions.push(Action::of_file(purpose, completed)),
        }
    }
}
