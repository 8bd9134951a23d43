//! The one error type: a kind for programs, a message for people.

use std::fmt;

use crate::words::readable;

/// What every fallible call of the crate returns.
pub type Result<T> = std::result::Result<T, Error>;

/// What went wrong, for programs that want to tell cases apart. The message for people is the error's `Display`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum ErrorKind {
    /// A recipe could not be read: its text, a key, a value, a name.
    Recipe,
    /// A window, layer or size was asked for that the world does not have.
    Request,
    /// The work would need more memory than allowed; nothing was started.
    Memory,
    /// A file could not be read or written.
    File,
    /// The work was cancelled by its caller.
    Cancelled,
    /// The library broke a rule of its own: a bug, whatever was asked for.
    Internal,
}

/// An error: one or more messages that say what is wrong, where, and what to do instead.
///
/// The type is opaque so that new causes do not break callers; [`Error::kind`] tells the cases that a program may want to
/// handle apart.
#[derive(Debug, Clone)]
pub struct Error {
    kind: ErrorKind,
    diagnostics: Vec<Diagnostic>,
}

/// One thing that is wrong, with its place in a text where there is one.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Diagnostic {
    /// What is wrong and what to do instead, a full message without its place.
    pub message: String,
    /// Where in a recipe, if it is there.
    pub place: Option<Location>,
}

/// A place in a text: what an editor jumps to.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Location {
    /// The file's name as the user gave it, or what the text is called if it is no file.
    pub file: String,
    /// Line, from 1.
    pub line: usize,
    /// Column in characters, from 1.
    pub column: usize,
    /// How many characters of the line are meant (at least 1).
    pub length: usize,
    /// The whole line, for showing; empty if it is longer than anybody would read.
    pub text: String,
}

impl Error {
    /// An error of one message without a place.
    pub fn new(kind: ErrorKind, message: impl Into<String>) -> Error {
        Error::from_diagnostics(kind, vec![Diagnostic { message: message.into(), place: None }])
    }

    /// An error of several diagnostics, in the order of the text they come from. Names and numbers in them that nobody could read are
    /// [shortened](crate::words::readable).
    pub fn from_diagnostics(kind: ErrorKind, mut diagnostics: Vec<Diagnostic>) -> Error {
        for diagnostic in &mut diagnostics {
            diagnostic.message = readable(std::mem::take(&mut diagnostic.message));
        }
        Error { kind, diagnostics }
    }

    /// A file that could not be read or written: names the file, what was tried and the system's reason.
    pub fn file(doing: &str, path: &std::path::Path, cause: &std::io::Error) -> Error {
        Error::new(ErrorKind::File, format!("cannot {doing} {}: {}", path.display(), reason(cause)))
    }

    /// Which case this is.
    pub fn kind(&self) -> ErrorKind {
        self.kind
    }

    /// Everything that is wrong, one by one.
    pub fn diagnostics(&self) -> &[Diagnostic] {
        &self.diagnostics
    }
}

/// The system's reason without the number the standard library adds.
fn reason(cause: &std::io::Error) -> String {
    let text = cause.to_string();
    match text.find(" (os error") {
        Some(end) => text[..end].to_lowercase(),
        None => text,
    }
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (i, diagnostic) in self.diagnostics.iter().enumerate() {
            if i > 0 {
                f.write_str("\n")?;
            }
            if let Some(place) = &diagnostic.place {
                write!(f, "{}:{}:{}: ", place.file, place.line, place.column)?;
            }
            f.write_str(&diagnostic.message)?;
        }
        Ok(())
    }
}

impl std::error::Error for Error {}

/// An [`Error`] travels unchanged through code that returns [`std::io::Result`], such as the body of a writer.
impl From<Error> for std::io::Error {
    fn from(error: Error) -> std::io::Error {
        std::io::Error::other(error)
    }
}
