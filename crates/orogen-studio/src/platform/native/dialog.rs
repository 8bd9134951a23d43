//! Dialogs of the system for choosing a file.

use std::path::{Path, PathBuf};
use std::thread;

use rfd::AsyncFileDialog;

/// Opens a dialog that starts in a folder and lists files with a name for them and these extensions; with the name of a
/// file, one for saving. `tell` is called at its end. Returns false if it cannot be awaited.
#[must_use]
pub fn choose_file(
    title: &str,
    folder: &Path,
    (files, extensions): (&str, &[&str]),
    name: Option<String>,
    tell: impl FnOnce(Option<PathBuf>) + Send + 'static,
) -> bool {
    let dialog = AsyncFileDialog::new()
        .set_title(title)
        .set_directory(folder)
        .add_filter(files, extensions)
        .set_can_create_directories(true);
    // The dialog is opened here, as some systems require; its end is awaited without holding up the window.
    let started = match name {
        Some(name) => {
            let open = dialog.set_file_name(name).save_file();
            thread::Builder::new().spawn(move || tell(pollster::block_on(open).map(|file| file.path().to_path_buf())))
        }
        None => {
            let open = dialog.pick_file();
            thread::Builder::new().spawn(move || tell(pollster::block_on(open).map(|file| file.path().to_path_buf())))
        }
    };
    started.is_ok()
}
