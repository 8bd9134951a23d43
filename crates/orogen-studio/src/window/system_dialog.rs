//! Dialogs of the system for choosing a file.

use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::mpsc::{Receiver, TryRecvError, channel};

use super::purpose::Purpose;
use crate::catalogue::Language;
use crate::files;
use crate::platform;
use crate::preview::worker::Wake;

/// An open dialog of the system.
pub struct SystemDialog {
    purpose: Purpose,
    chosen: Receiver<Option<PathBuf>>,
}

impl SystemDialog {
    /// Opens a dialog that starts at a path; `None` if the system has none.
    #[must_use]
    pub fn open(purpose: Purpose, at: Option<&Path>, language: Language, wake: &Wake) -> Option<SystemDialog> {
        if !files::has_file_dialogs() {
            return None;
        }
        let folder = at.and_then(Path::parent).filter(|folder| !folder.as_os_str().is_empty());
        let folder = folder.map_or_else(files::working_folder, Path::to_path_buf);
        let name = at.and_then(Path::file_name).map(|name| name.to_string_lossy().into_owned());
        let name = purpose.saves().then(|| name.unwrap_or_else(|| "untitled.toml".into()));
        let (sender, chosen) = channel();
        let wake = Arc::clone(wake);
        let tell = move |path: Option<PathBuf>| {
            let _ = sender.send(path);
            wake();
        };
        let listed = (language.text(purpose.files()), purpose.extensions());
        let is_open = platform::choose_file(language.text(purpose.title()), &folder, listed, name, tell);
        is_open.then_some(SystemDialog { purpose, chosen })
    }

    /// Its purpose.
    #[must_use]
    pub fn purpose(&self) -> Purpose {
        self.purpose
    }

    /// The end of the dialog: the chosen file, or none. `None` while it is open.
    #[must_use]
    pub fn end(&self) -> Option<Option<PathBuf>> {
        match self.chosen.try_recv() {
            Ok(path) => Some(path),
            Err(TryRecvError::Disconnected) => Some(None),
            Err(TryRecvError::Empty) => None,
        }
    }
}
