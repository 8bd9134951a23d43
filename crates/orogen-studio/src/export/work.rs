//! What an export works with.

use std::path::PathBuf;

use orogen::io::file::{Output, OutputPolicy};
use orogen::recipe::Recipe;
use orogen::{Progress, Result, Session, World};

/// What an export works with.
pub struct Work<'a> {
    /// The session.
    pub session: &'a Session,
    /// The recipe.
    pub recipe: Recipe,
    /// The file or folder that is made.
    pub path: PathBuf,
    /// Files that are read, and therefore not replaced.
    pub inputs: Vec<PathBuf>,
    /// The progress.
    pub progress: &'a Progress,
}

impl Work<'_> {
    /// Which files may be replaced.
    #[must_use]
    pub fn policy(&self) -> OutputPolicy {
        OutputPolicy::default().protecting(&self.inputs)
    }

    /// The file.
    ///
    /// # Errors
    /// If there is one that may not be replaced.
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

/// A message with the warnings behind it, a line each.
#[must_use]
pub fn lines(words: &str, notes: impl IntoIterator<Item = String>) -> String {
    let mut text = words.trim_end().to_owned();
    for note in notes {
        text.push('\n');
        text.push_str(&note);
    }
    text
}
