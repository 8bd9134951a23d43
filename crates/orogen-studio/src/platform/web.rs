//! A page of a browser.

mod desk;
mod files;
#[cfg(feature = "window")]
mod gpu;
mod group;
mod message;
mod storage;
mod worker;

use std::io;
use std::path::{Path, PathBuf};
use std::sync::mpsc::Receiver;
use std::time::{Duration, SystemTime};

pub use desk::{end_frame, prepare, start};
#[cfg(feature = "window")]
pub use files::receive;
pub use files::{Chosen, choose, download, fetch};
#[cfg(feature = "window")]
pub use gpu::{Gpu, with_gpu};
pub use storage::begin;
use wasm_bindgen::JsValue;
use web_sys::{Event, UrlSearchParams};
pub use web_time::Instant;
#[cfg(target_feature = "atomics")]
pub use worker::lend;
pub use worker::{Runner, work};

/// Whether workers share memory: they compute with several threads, and can be interrupted.
const SHARES_MEMORY: bool = cfg!(target_feature = "atomics");

/// Whether work is cancelled only between its steps, so that it is better not asked for more than can be shown.
pub const IS_STEPWISE: bool = !SHARES_MEMORY;

/// Whether this is a page of a browser: it has no windows, and its files are not those of the computer.
pub const IS_PAGE: bool = true;

/// The default memory limit in bytes: half of what a page can have.
pub const MEMORY: u64 = 2 << 30;

/// Does nothing: no other program changes the files of a page.
///
/// # Errors
/// Never.
pub fn watch(_: &str, _: impl FnOnce() + Send + 'static) -> io::Result<()> {
    Ok(())
}

/// Takes a message that is there; a page never waits.
#[must_use]
pub fn wait<T>(receiver: &Receiver<T>, _: Duration) -> Option<T> {
    receiver.try_recv().ok()
}

/// The time since `past`.
#[must_use]
pub fn since(past: SystemTime) -> Duration {
    let now = SystemTime::UNIX_EPOCH + clock();
    now.duration_since(past).unwrap_or_default()
}

/// The time since 1970.
fn clock() -> Duration {
    Duration::from_millis(js_sys::Date::now() as u64)
}

/// The folder of the studio's settings.
#[must_use]
pub fn settings_folder() -> Option<PathBuf> {
    Some(PathBuf::from(storage::SETTINGS))
}

/// The folder of the user's files.
#[must_use]
pub fn working_folder() -> PathBuf {
    PathBuf::from("/")
}

/// There are no dialogs of the system that choose among the page's files.
#[must_use]
pub fn has_file_dialogs() -> bool {
    false
}

/// The name of the browser's language, such as `zh-CN`.
#[must_use]
pub fn locale() -> Option<String> {
    web_sys::window()?.navigator().language()
}

/// Prints a message where developers look.
fn warn(message: &str) {
    web_sys::console::warn_1(&JsValue::from_str(message));
}

/// Opens nothing: see [`has_file_dialogs`].
#[must_use]
pub fn choose_file(
    _: &str,
    _: &Path,
    _: (&str, &[&str]),
    _: Option<String>,
    _: impl FnOnce(Option<PathBuf>) + Send + 'static,
) -> bool {
    false
}

/// There are no fonts of the system; the browser draws characters with them by itself.
#[must_use]
pub fn chinese_font() -> Option<(&'static str, Vec<u8>, u32)> {
    None
}

/// Says that the page cannot draw again: its script hears the event `graphicslost`.
pub fn end_page() {
    if let (Some(window), Ok(event)) = (web_sys::window(), Event::new("graphicslost")) {
        let _ = window.dispatch_event(&event);
    }
}

/// States the title and the language of the page. The language chooses among the variants of Chinese characters.
pub fn describe(title: &str, language: &str) {
    let Some(document) = web_sys::window().and_then(|window| window.document()) else { return };
    document.set_title(title);
    if let Some(root) = document.document_element() {
        let _ = root.set_attribute("lang", language);
    }
}

/// A value in the address of the page.
#[must_use]
pub fn query(name: &str) -> Option<String> {
    let search = web_sys::window()?.location().search().ok()?;
    UrlSearchParams::new_with_str(&search).ok()?.get(name)
}
