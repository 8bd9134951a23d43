//! Keeps unsaved text in the settings folder, so that a crash loses nothing.

use std::path::{Path, PathBuf};

use crate::editing::document::Document;
use crate::files;

/// Stores the text of an unsaved document.
#[derive(Debug)]
pub struct Recovery {
    file: Option<PathBuf>,
    /// The stored revision.
    kept: Option<u64>,
}

const FILE: &str = "studio-unsaved.toml";

/// The line before the text; the document's title follows.
const HEAD: &str = "# unsaved: ";

impl Recovery {
    /// Stores texts in a folder. Returns the title and the text that a crash left there.
    #[must_use]
    pub fn new(folder: Option<&Path>) -> (Recovery, Option<(String, String)>) {
        let file = folder.map(|folder| folder.join(FILE));
        let left = file.as_deref().and_then(|file| files::read(file).ok()).and_then(|text| {
            let (head, text) = text.split_once('\n')?;
            Some((head.strip_prefix(HEAD)?.to_owned(), text.to_owned()))
        });
        (Recovery { file, kept: None }, left)
    }

    /// Stores the text of a document if it has unsaved changes that are not stored yet.
    pub fn keep(&mut self, document: &Document) {
        if !document.is_changed() || self.kept == Some(document.revision()) {
            return;
        }
        self.kept = Some(document.revision());
        if let Some(file) = &self.file {
            // Without a settings folder nothing is stored.
            let _ = files::write(file, &format!("{HEAD}{}\n{}", document.title(), document.text()));
        }
    }

    /// Removes the stored text, because it was saved or is not wanted.
    pub fn forget(&mut self) {
        self.kept = None;
        if let Some(file) = &self.file {
            files::remove(file);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use orogen::io::test_folder::TestFolder;
    use orogen::presets;

    #[test]
    fn what_is_not_saved_is_found_again() {
        let folder = TestFolder::new("studio-recovery").unwrap();
        let (mut recovery, left) = Recovery::new(Some(&folder));
        assert!(left.is_none());
        let mut document = Document::of_preset(presets::find("hills").unwrap()).unwrap();
        recovery.keep(&document);
        assert!(Recovery::new(Some(&folder)).1.is_none(), "nothing was changed");
        document.type_text(format!("{}\n# mine\n", document.text()));
        recovery.keep(&document);
        let (_, left) = Recovery::new(Some(&folder));
        assert_eq!(left, Some(("hills".to_owned(), document.text().to_owned())));
        recovery.forget();
        assert!(Recovery::new(Some(&folder)).1.is_none());
    }
}
