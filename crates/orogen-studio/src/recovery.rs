//! Keeps unsaved texts in the settings folder, so that a crash loses nothing.
//!
//! Each window has a slot of its own in the folder `unsaved`: `N.toml` is the text, `N.png` a picture of the land, and
//! `N.lock` is locked as long as the window lives. Slots without a living window are offered at the next start. They
//! are removed only when their text is saved, or the user discards it.

use std::path::{Path, PathBuf};
use std::time::SystemTime;

use serde::{Deserialize, Serialize};

use crate::editing::document::Document;
use crate::files::{self, Lock};

/// Stores the text of an unsaved document.
#[derive(Debug)]
pub struct Recovery {
    folder: Option<PathBuf>,
    slot: Option<Slot>,
    /// The stored revision.
    kept: Option<u64>,
    /// The revision of the stored picture.
    pictured: Option<u64>,
}

/// A slot, and its lock.
#[derive(Debug)]
struct Slot {
    /// The path of its files, without an extension.
    stem: PathBuf,
    _lock: Lock,
}

/// The first line of a stored text: what is known about its document.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
struct Head {
    title: String,
    /// The file of the document, if it has one.
    path: Option<PathBuf>,
    /// The folder that relative paths start in, if it has none.
    folder: Option<PathBuf>,
}

/// A text that was not saved.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Unsaved {
    stem: PathBuf,
    /// The title of its document.
    pub title: String,
    /// The file of its document.
    pub path: Option<PathBuf>,
    folder: Option<PathBuf>,
    /// The time of the last change.
    pub changed: Option<SystemTime>,
    text: String,
}

const FOLDER: &str = "unsaved";

/// The comment before the head.
const HEAD: &str = "# unsaved: ";

/// The maximum number of slots.
const SLOTS: usize = 1000;

impl Recovery {
    /// Stores texts in a settings folder; stores nothing without one.
    #[must_use]
    pub fn new(settings: Option<&Path>) -> Recovery {
        Recovery { folder: settings.map(|folder| folder.join(FOLDER)), slot: None, kept: None, pictured: None }
    }

    /// The texts of windows that no longer live, the latest first.
    #[must_use]
    pub fn left(&self) -> Vec<Unsaved> {
        let entries = self.folder.as_deref().and_then(|folder| files::list(folder).ok()).unwrap_or_default();
        let is_text = |entry: &&files::Entry| entry.path.extension().is_some_and(|extension| extension == "toml");
        let stems = entries.iter().filter(is_text).map(|entry| entry.path.with_extension(""));
        // The lock is free again at once: another window may offer the same text, and the first one to open it has it.
        let mut left: Vec<Unsaved> =
            stems.filter(|stem| files::lock(&lock_of(stem)).is_some()).filter_map(|stem| read(&stem)).collect();
        left.sort_by_key(|unsaved| std::cmp::Reverse(unsaved.changed));
        left
    }

    /// Takes over the slot of a text. Returns its document; `None` if another window was faster.
    #[must_use]
    pub fn take(&mut self, unsaved: &Unsaved) -> Option<Document> {
        let lock = files::lock(&lock_of(&unsaved.stem))?;
        let now = read(&unsaved.stem)?;
        self.slot = Some(Slot { stem: unsaved.stem.clone(), _lock: lock });
        let on_disk = now.path.as_deref().and_then(|path| Some((path, files::read(path).ok()?)));
        let document = match on_disk {
            Some((path, saved)) => Document::of_file(path, saved).with_unsaved(now.text),
            None => Document::unsaved(
                &now.title,
                now.text,
                now.path.as_deref().and_then(Path::parent).or(now.folder.as_deref()),
            ),
        };
        (self.kept, self.pictured) = (Some(document.revision()), Some(document.revision()));
        Some(document)
    }

    /// Removes a text, because the user does not want it. Nothing happens if another window has opened it.
    pub fn discard(&self, unsaved: &Unsaved) {
        if let Some(lock) = files::lock(&lock_of(&unsaved.stem)) {
            remove(&unsaved.stem, lock);
        }
    }

    /// Stores the text of a document if it has unsaved changes that are not stored yet; removes the stored text if it
    /// has none.
    pub fn keep(&mut self, document: &Document) {
        if !document.is_changed() {
            // All changes were undone.
            if self.kept.is_some() {
                self.forget();
            }
            return;
        }
        if self.kept == Some(document.revision()) {
            return;
        }
        self.kept = Some(document.revision());
        let Some(slot) = self.slot() else { return };
        let head = Head {
            title: document.title().to_owned(),
            path: document.path().map(Path::to_path_buf),
            folder: document.folder().map(Path::to_path_buf),
        };
        if let Ok(head) = serde_json::to_string(&head) {
            // Without a place to store it, nothing is stored.
            let _ = files::write(&slot.with_extension("toml"), &format!("{HEAD}{head}\n{}", document.text()));
        }
    }

    /// Stores a picture of a kept document, which `make` gives as PNG, if there is none of this revision.
    pub fn picture(&mut self, document: &Document, make: impl FnOnce() -> Option<Vec<u8>>) {
        let revision = Some(document.revision());
        if self.kept != revision || self.pictured == revision {
            return;
        }
        self.pictured = revision;
        if let Some((slot, picture)) = self.slot.as_ref().zip(make()) {
            let _ = files::write_bytes(&slot.stem.with_extension("png"), &picture);
        }
    }

    /// Removes the stored text, because it was saved or is not wanted.
    pub fn forget(&mut self) {
        (self.kept, self.pictured) = (None, None);
        if let Some(Slot { stem, _lock }) = self.slot.take() {
            remove(&stem, _lock);
        }
    }

    /// The slot of this window; `None` if there is no settings folder, or it cannot be written.
    fn slot(&mut self) -> Option<PathBuf> {
        if self.slot.is_none() {
            let folder = self.folder.as_deref()?;
            files::make_folder(folder).ok()?;
            self.slot = (1..=SLOTS).map(|n| folder.join(n.to_string())).find_map(|stem| {
                let lock = files::lock(&lock_of(&stem))?;
                // Texts of windows that no longer live stay.
                let is_free = files::changed(&stem.with_extension("toml")).is_none();
                is_free.then_some(Slot { stem, _lock: lock })
            });
        }
        self.slot.as_ref().map(|slot| slot.stem.clone())
    }
}

impl Unsaved {
    /// The picture of the land as PNG, if there is one.
    #[must_use]
    pub fn picture(&self) -> Option<Vec<u8>> {
        files::read_bytes(&self.stem.with_extension("png"))
    }
}

fn lock_of(stem: &Path) -> PathBuf {
    stem.with_extension("lock")
}

/// Removes the files of a slot.
fn remove(stem: &Path, lock: Lock) {
    // The text first: without it there is no slot.
    for extension in ["toml", "png"] {
        files::remove(&stem.with_extension(extension));
    }
    // The lock's file stays: another window may just have opened it.
    drop(lock);
}

/// Reads the text of a slot.
fn read(stem: &Path) -> Option<Unsaved> {
    let path = stem.with_extension("toml");
    let text = files::read(&path).ok()?;
    let (head, text) = text.split_once('\n')?;
    let head: Head = serde_json::from_str(head.strip_prefix(HEAD)?).ok()?;
    let (title, own, folder) = (head.title, head.path, head.folder);
    Some(Unsaved {
        stem: stem.to_path_buf(),
        title,
        path: own,
        folder,
        changed: files::changed(&path),
        text: text.to_owned(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use orogen::io::test_folder::TestFolder;
    use orogen::presets;

    fn preset() -> Document {
        Document::of_preset(presets::find("hills").unwrap()).unwrap()
    }

    fn type_into(document: &mut Document, more: &str) {
        document.type_text(format!("{}\n# {more}\n", document.text()));
        document.end_gesture();
    }

    fn titles(recovery: &Recovery) -> Vec<String> {
        recovery.left().into_iter().map(|unsaved| unsaved.title).collect()
    }

    #[test]
    fn what_is_not_saved_is_found_again() {
        let folder = TestFolder::new("studio-recovery").unwrap();
        let mut recovery = Recovery::new(Some(&folder));
        assert!(recovery.left().is_empty());
        let mut document = preset();
        recovery.keep(&document);
        drop(recovery);
        let mut recovery = Recovery::new(Some(&folder));
        assert!(recovery.left().is_empty(), "nothing was changed");
        type_into(&mut document, "mine");
        recovery.keep(&document);
        recovery.picture(&document, || Some(b"picture".to_vec()));
        drop(recovery);
        // The offer alone removes nothing.
        let mut recovery = Recovery::new(Some(&folder));
        let left = recovery.left();
        assert_eq!(titles(&recovery), ["hills"]);
        assert_eq!(left[0].picture().as_deref(), Some(&b"picture"[..]));
        let found = recovery.take(&left[0]).unwrap();
        assert_eq!((found.text(), found.path(), found.is_changed()), (document.text(), None, true));
        // It stays until it is saved.
        drop(recovery);
        assert_eq!(titles(&Recovery::new(Some(&folder))), ["hills"]);
        let mut recovery = Recovery::new(Some(&folder));
        let _ = recovery.take(&left[0]).unwrap();
        recovery.forget();
        assert!(recovery.left().is_empty());
        let names = files::list(&folder.join(FOLDER)).unwrap();
        assert!(names.iter().all(|entry| entry.path.ends_with("1.lock")), "{names:?}");
    }

    #[test]
    fn a_living_window_keeps_its_text() {
        let folder = TestFolder::new("studio-recovery-two").unwrap();
        let (mut one, mut two) = (Recovery::new(Some(&folder)), Recovery::new(Some(&folder)));
        let (mut first, mut second) = (preset(), preset());
        type_into(&mut first, "first");
        one.keep(&first);
        assert!(two.left().is_empty(), "the first window lives");
        type_into(&mut second, "second");
        two.keep(&second);
        drop(one);
        let left = two.left();
        assert!(left.len() == 1 && left[0].text.contains("first"));
        // A third window opens it; the second one can neither open nor discard it any more.
        let mut three = Recovery::new(Some(&folder));
        assert!(three.take(&left[0]).is_some());
        assert!(two.take(&left[0]).is_none());
        two.discard(&left[0]);
        drop(three);
        assert_eq!(two.left().len(), 1);
        two.discard(&left[0]);
        assert!(two.left().is_empty());
        drop(two);
        assert!(Recovery::new(Some(&folder)).left()[0].text.contains("second"));
    }

    #[test]
    fn changes_that_were_undone_are_not_offered() {
        let folder = TestFolder::new("studio-recovery-undone").unwrap();
        let mut recovery = Recovery::new(Some(&folder));
        let mut document = preset();
        type_into(&mut document, "mine");
        recovery.keep(&document);
        document.undo();
        recovery.keep(&document);
        drop(recovery);
        assert!(Recovery::new(Some(&folder)).left().is_empty());
    }

    #[test]
    fn a_file_is_found_again_with_its_path_and_what_was_saved_in_it() {
        let folder = TestFolder::new("studio-recovery-file").unwrap();
        let path = folder.join("land.toml");
        let saved = preset().text().to_owned();
        files::write(&path, &saved).unwrap();
        let mut recovery = Recovery::new(Some(&folder));
        let mut document = Document::of_file(&path, saved.clone());
        type_into(&mut document, "mine");
        recovery.keep(&document);
        drop(recovery);
        let mut recovery = Recovery::new(Some(&folder));
        let mut found = recovery.take(&recovery.left()[0]).unwrap();
        assert_eq!((found.text(), found.path()), (document.text(), Some(path.as_path())));
        assert!(found.is_changed() && found.undo());
        assert!(found.text() == saved && !found.is_changed());
        // The file is gone: its folder is still known, for relative paths.
        found.redo();
        recovery.keep(&found);
        drop(recovery);
        files::remove(&path);
        let mut recovery = Recovery::new(Some(&folder));
        let found = recovery.take(&recovery.left()[0]).unwrap();
        assert_eq!((found.title(), found.path(), found.folder()), ("land", None, Some(&*folder)));
        assert!(found.is_changed());
    }

    #[test]
    fn damaged_files_are_left_alone() {
        let folder = TestFolder::new("studio-recovery-damaged").unwrap();
        for (n, text) in ["", "# unsaved: {\n", "orogen = 1\n"].into_iter().enumerate() {
            files::write(&folder.join(FOLDER).join(format!("{n}.toml")), text).unwrap();
        }
        let mut recovery = Recovery::new(Some(&folder));
        assert!(recovery.left().is_empty());
        let mut document = preset();
        type_into(&mut document, "mine");
        recovery.keep(&document);
        assert_eq!(files::read(&folder.join(FOLDER).join("1.toml")).unwrap(), "# unsaved: {\n");
        drop(recovery);
        assert_eq!(Recovery::new(Some(&folder)).left().len(), 1);
    }
}
