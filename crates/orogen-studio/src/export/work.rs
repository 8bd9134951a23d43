//! The inputs of an export.

use std::path::PathBuf;

use orogen::io::file::{Output, OutputPolicy};
use orogen::recipe::Recipe;
use orogen::{Progress, Result, Session, World};

/// The inputs of an export.
pub struct Work<'a> {
    /// The session.
    pub session: &'a Session,
    /// The recipe.
    pub recipe: Recipe,
    /// The output file or folder.
    pub path: PathBuf,
    /// Files that are read, and are therefore not replaced.
    pub inputs: Vec<PathBuf>,
    /// The progress.
    pub progress: &'a Progress,
}

impl Work<'_> {
    /// The policy for replacing files.
    #[must_use]
    pub fn policy(&self) -> OutputPolicy {
        OutputPolicy::default().protecting(&self.inputs)
    }

    /// The output file.
    ///
    /// # Errors
    /// If an existing file may not be replaced.
    pub fn output(&self) -> Result<Output> {
        self.policy().output(&self.path)
    }

    /// The world of the recipe.
    ///
    /// # Errors
    /// The errors of [`Session::open`].
    pub fn open(&self) -> Result<World> {
        self.session.open(self.recipe.clone())
    }
}

/// A message followed by warnings, one per line.
#[must_use]
pub fn lines(words: &str, notes: impl IntoIterator<Item = String>) -> String {
    let mut text = words.trim_end().to_owned();
    for note in notes {
        text.push('\n');
        text.push_str(&note);
    }
    text
}
