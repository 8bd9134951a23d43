//! A program of a system.

use std::io;
use std::path::PathBuf;
use std::sync::mpsc::Receiver;
use std::time::Duration;
pub use std::time::{Instant, SystemTime};

use orogen::{Progress, Result, Session};
#[cfg(feature = "window")]
pub use orogen_gpu::Gpu;

use super::Task;

#[cfg(feature = "window")]
mod dialog;
#[cfg(feature = "window")]
mod fonts;

#[cfg(feature = "window")]
pub use dialog::choose_file;
#[cfg(feature = "window")]
pub use fonts::chinese_font;

/// Whether work is cancelled only between its steps, so that it is better not asked for more than can be shown.
pub const IS_STEPWISE: bool = false;

/// Whether this is a page of a browser: it has no windows, and its files are not those of the computer.
pub const IS_PAGE: bool = false;

/// The default memory limit in bytes.
pub const MEMORY: u64 = 2 << 30;

/// A file that arrives later: its path, or why there is none.
pub type Chosen = Receiver<std::result::Result<PathBuf, String>>;

/// Starts a task on a thread of a session. `tell` is called from that thread.
///
/// # Errors
/// If no thread can be started.
pub fn start<T: Task>(
    session: &Session,
    task: T,
    progress: &Progress,
    tell: impl Fn(T::Event) + Send + Sync + 'static,
) -> Result<()> {
    let progress = progress.clone();
    session.start(move |session| task.run(session, &progress, &tell))
}

/// A session whose previews are computed on a graphics card.
#[cfg(feature = "window")]
#[must_use]
pub fn with_gpu(session: &Session, gpu: &Gpu) -> Session {
    session.with_device(std::sync::Arc::new(gpu.clone()))
}

/// Starts a thread that watches files which other programs may change.
///
/// # Errors
/// If no thread can be started.
pub fn watch(name: &str, work: impl FnOnce() + Send + 'static) -> io::Result<()> {
    std::thread::Builder::new().name(name.to_owned()).spawn(work).map(drop)
}

/// Waits for a message; `None` if there is none after `limit`.
#[must_use]
pub fn wait<T>(receiver: &Receiver<T>, limit: Duration) -> Option<T> {
    receiver.recv_timeout(limit).ok()
}

/// The time since `past`; zero if a clock was set back.
#[must_use]
pub fn since(past: SystemTime) -> Duration {
    past.elapsed().unwrap_or_default()
}

/// The folder of the studio's settings: `orogen` in the system's settings folder; `None` if the system has none.
#[must_use]
pub fn settings_folder() -> Option<PathBuf> {
    let var = |name: &str| std::env::var_os(name).filter(|value| !value.is_empty()).map(PathBuf::from);
    let base = if cfg!(windows) {
        var("APPDATA")
    } else if cfg!(target_os = "macos") {
        var("HOME").map(|home| home.join("Library/Application Support"))
    } else {
        var("XDG_CONFIG_HOME").or_else(|| var("HOME").map(|home| home.join(".config")))
    };
    base.map(|base| base.join("orogen"))
}

/// The working folder.
#[must_use]
pub fn working_folder() -> PathBuf {
    std::env::current_dir().unwrap_or_default()
}

/// The name of the system's language, such as `zh_CN.UTF-8`; `None` if it is not set.
#[must_use]
pub fn locale() -> Option<String> {
    let variables = ["LC_ALL", "LC_MESSAGES", "LANG"].into_iter();
    variables.filter_map(|name| std::env::var(name).ok()).find(|value| !value.is_empty())
}

/// Asks for a file of the computer, where others are listed; `None` if there are no others.
#[must_use]
pub fn choose(_: &[&str], _: impl Fn() + 'static) -> Option<Chosen> {
    None
}

/// Reads a file that was dropped onto the window, where that takes time; `None` if its path is enough.
#[cfg(feature = "window")]
#[must_use]
pub fn receive(_: &eframe::egui::DroppedFileHandle, _: impl Fn() + 'static) -> Option<Chosen> {
    None
}

/// Hands a file to the user, if the files of the program are not those of the computer.
pub fn download(_: &str, _: &[u8]) {}

/// What is due at the end of a frame: nothing.
pub fn end_frame() {}

/// Says that the page cannot draw again, if there is one.
pub fn end_page() {}

/// States the title and the language of the page, if there is one.
pub fn describe(_: &str, _: &str) {}

/// Whether the system has dialogs for choosing files. On Linux that is a desktop portal that has such a dialog.
#[must_use]
pub fn has_file_dialogs() -> bool {
    static HAS: std::sync::OnceLock<bool> = std::sync::OnceLock::new();
    *HAS.get_or_init(find_file_dialogs)
}

fn find_file_dialogs() -> bool {
    if cfg!(any(windows, target_os = "macos")) {
        return true;
    }
    let var = |name: &str| std::env::var_os(name).filter(|value| !value.is_empty());
    let dirs = var("XDG_DATA_DIRS").unwrap_or_else(|| "/usr/local/share:/usr/share".into());
    let folders: Vec<PathBuf> = std::env::split_paths(&dirs).collect();
    let starts = |folder: &PathBuf| folder.join("dbus-1/services/org.freedesktop.portal.Desktop.service").is_file();
    let has_dialog = |folder: &PathBuf| {
        let portals = std::fs::read_dir(folder.join("xdg-desktop-portal/portals")).into_iter().flatten().flatten();
        let mut texts = portals.filter_map(|portal| std::fs::read_to_string(portal.path()).ok());
        texts.any(|text| text.contains("org.freedesktop.impl.portal.FileChooser"))
    };
    var("DBUS_SESSION_BUS_ADDRESS").is_some() && folders.iter().any(starts) && folders.iter().any(has_dialog)
}
