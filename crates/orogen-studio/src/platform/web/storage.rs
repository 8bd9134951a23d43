//! The files of the studio and of its user in the browser's storage.

use std::cell::RefCell;
use std::io;
use std::path::Path;

use js_sys::Function;
use orogen::io::fs;
use wasm_bindgen::JsValue;
use web_sys::Storage;

use super::{clock, warn};

/// The folder of the studio's settings, which workers need not know.
pub const SETTINGS: &str = "/.orogen";

/// The start of the keys of files, before their paths.
const KEY: &str = "orogen:";

/// Longer files are not kept: the browser has a few megabytes for all pages of a host.
const LONGEST: u64 = 1 << 20;

/// The end of the names of files that are only locked.
const LOCK: &str = ".lock";

thread_local! {
    static KEPT: RefCell<u64> = const { RefCell::new(0) };
    static LOCKS: RefCell<Locks> = RefCell::default();
}

/// Locked files of this page and of other pages of the site.
#[derive(Default)]
struct Locks {
    /// Takes a lock of the browser, by its name, until the page is closed.
    hold: Option<Function>,
    /// Files that other pages have locked.
    _others: Vec<fs::File>,
}

fn storage() -> Option<Storage> {
    web_sys::window()?.local_storage().ok()?
}

/// Reads the files that were kept, once. `held` are the locks that other pages of the site have, and `hold` takes one.
pub fn begin(held: &[String], hold: Function) {
    if LOCKS.with_borrow(|locks| locks.hold.is_some()) {
        return;
    }
    fs::memory::set_clock(clock);
    let _ = fs::create_dir_all(SETTINGS);
    if let Some(storage) = storage() {
        for at in 0..storage.length().unwrap_or(0) {
            let Ok(Some(key)) = storage.key(at) else { continue };
            let Some(path) = key.strip_prefix(KEY).map(Path::new) else { continue };
            if let Ok(Some(text)) = storage.get_item(&key) {
                let _ = fs::create_dir_all(fs::folder(path)).and_then(|()| fs::write(path, text));
            }
        }
    }
    let others = held.iter().filter_map(|lock| locked(Path::new(lock.strip_prefix(KEY)?)).ok()).collect();
    LOCKS.set(Locks { hold: Some(hold), _others: others });
    KEPT.set(fs::memory::changes(u64::MAX).0);
}

/// A file that another page has locked.
fn locked(path: &Path) -> io::Result<fs::File> {
    fs::create_dir_all(fs::folder(path))?;
    let file = fs::File::create(path)?;
    file.try_lock()?;
    Ok(file)
}

/// Keeps the texts that were written since the last call, and forgets those that were removed.
pub fn keep() {
    let (last, paths) = fs::memory::changes(KEPT.take());
    KEPT.set(last);
    let Some(storage) = storage().filter(|_| !paths.is_empty()) else { return };
    for path in paths {
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        let key = format!("{KEY}{}", path.display());
        if name.ends_with(LOCK) && path.starts_with(SETTINGS) && !name.starts_with('.') {
            LOCKS.with_borrow(|locks| {
                // Without locks, two pages may offer the same unsaved text.
                let hold = locks.hold.as_ref().filter(|_| fs::is_file(&path));
                hold.map(|hold| hold.call1(&JsValue::NULL, &JsValue::from_str(&key)))
            });
        }
        if name.ends_with(LOCK) || name.ends_with(".tmp") {
            continue;
        }
        let is_short = fs::metadata(&path).is_ok_and(|about| about.len() <= LONGEST);
        let text = is_short.then(|| fs::read_to_string(&path).ok()).flatten();
        let done = match text {
            Some(text) => storage.set_item(&key, &text),
            None => storage.remove_item(&key),
        };
        if done.is_err() {
            warn(&format!("the browser's storage is full: {} is lost when the page is closed", path.display()));
        }
    }
}

/// The files of the user that were changed or removed since the change with this number, with their bytes.
pub fn changed(number: &mut u64) -> Vec<(String, Option<Vec<u8>>)> {
    let (last, paths) = fs::memory::changes(*number);
    *number = last;
    let own = paths.into_iter().filter(|path| !path.starts_with(SETTINGS));
    own.map(|path| (path.to_string_lossy().into_owned(), fs::read(&path).ok())).collect()
}
