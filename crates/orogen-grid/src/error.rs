//! The error type: a kind for programs, a message for people.

use std::sync::Arc;
use std::{fmt, io};

use crate::words::readable;

/// The result of every fallible call of the crate.
pub type Result<T> = std::result::Result<T, Error>;

/// The kind of an error, for programs that handle cases differently. The message for people is the error's `Display`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum ErrorKind {
    /// A recipe could not be read: a wrong syntax, key, value or name.
    Recipe,
    /// A request for a window, layer or size that the world does not have.
    Request,
    /// The work needs more memory than allowed; it was not started.
    Memory,
    /// A file could not be read or written.
    File,
    /// Only a part of a file's heights was read, and the work needs heights outside of it.
    Part,
    /// The work was cancelled by its caller.
    Cancelled,
    /// The library violated one of its own invariants. This is a bug, whatever the request was.
    Internal,
}

/// One or more messages that say what is wrong, where, and how to correct it.
///
/// The type is opaque so that new causes do not break callers; [`Error::kind`] distinguishes the cases that a program
/// may want to handle.
#[derive(Debug, Clone)]
pub struct Error {
    kind: ErrorKind,
    diagnostics: Vec<Diagnostic>,
    source: Option<Arc<io::Error>>,
}

/// One problem, with its location in a text if it has one.
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
pub struct Diagnostic {
    /// A complete message without the location: what is wrong and how to correct it.
    pub message: String,
    /// The location in a recipe, if there is one.
    pub place: Option<Location>,
}

impl Diagnostic {
    /// A problem without a location.
    #[must_use]
    pub fn new(message: impl Into<String>) -> Diagnostic {
        Diagnostic { message: message.into(), place: None }
    }

    /// Sets the location.
    #[must_use]
    pub fn with_place(self, place: Option<Location>) -> Diagnostic {
        Diagnostic { place, ..self }
    }
}

/// A location in a text, as an editor needs it.
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
pub struct Location {
    /// The file's name as the user gave it, or the name of a text that is not a file.
    pub file: String,
    /// Line, from 1.
    pub line: usize,
    /// Column in characters, from 1.
    pub column: usize,
    /// Length of the marked part, in characters (at least 1).
    pub length: usize,
    /// The whole line, for display; empty if it is too long to read.
    pub text: String,
}

impl Location {
    /// The location of one character in a file: line and column from 1; the line's text is empty.
    #[must_use]
    pub fn new(file: impl Into<String>, line: usize, column: usize) -> Location {
        Location { file: file.into(), line, column, length: 1, text: String::new() }
    }

    /// Sets the length of the marked part, in characters.
    #[must_use]
    pub fn with_length(self, length: usize) -> Location {
        Location { length, ..self }
    }

    /// Sets the line's text.
    #[must_use]
    pub fn with_text(self, text: impl Into<String>) -> Location {
        Location { text: text.into(), ..self }
    }
}

impl Error {
    /// An error with one message and no location.
    pub fn new(kind: ErrorKind, message: impl Into<String>) -> Error {
        Error::from_diagnostics(kind, vec![Diagnostic { message: message.into(), place: None }])
    }

    /// An error with several diagnostics, in the order of the text. Overlong names and numbers in them are
    /// [shortened](crate::words::readable).
    #[must_use]
    pub fn from_diagnostics(kind: ErrorKind, mut diagnostics: Vec<Diagnostic>) -> Error {
        for diagnostic in &mut diagnostics {
            diagnostic.message = readable(std::mem::take(&mut diagnostic.message));
        }
        Error { kind, diagnostics, source: None }
    }

    /// The error of a file that could not be read or written. The message contains the file, the action and the
    /// system's reason.
    #[must_use]
    pub fn file(doing: &str, path: &std::path::Path, cause: &io::Error) -> Error {
        let message = format!("cannot {doing} {}: {}", path.display(), reason(cause));
        Error::new(ErrorKind::File, message).with_source(cause)
    }

    /// Sets the I/O error that caused this one, which [`source`](std::error::Error::source) returns.
    #[must_use]
    pub fn with_source(self, cause: &io::Error) -> Error {
        // An I/O error cannot be cloned. The error that it wraps is kept if it is an `Error`, otherwise only its
        // message.
        let wrapped = cause.get_ref().and_then(|wrapped| wrapped.downcast_ref::<Error>());
        let source = match (cause.raw_os_error(), wrapped) {
            (Some(code), _) => io::Error::from_raw_os_error(code),
            (None, Some(error)) => io::Error::new(cause.kind(), error.clone()),
            (None, None) => io::Error::new(cause.kind(), cause.to_string()),
        };
        Error { source: Some(Arc::new(source)), ..self }
    }

    /// The kind of the error.
    #[must_use]
    pub fn kind(&self) -> ErrorKind {
        self.kind
    }

    /// All problems.
    #[must_use]
    pub fn diagnostics(&self) -> &[Diagnostic] {
        &self.diagnostics
    }
}

/// The system's reason, without the number that the standard library appends.
fn reason(cause: &io::Error) -> String {
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

impl std::error::Error for Error {
    /// The I/O error that caused it, if a file could not be read or written.
    fn source(&self) -> Option<&(dyn std::error::Error + 'static)> {
        self.source.as_deref().map(|source| source as _)
    }
}

/// An [`Error`] travels unchanged through code that returns [`std::io::Result`], such as the body of a writer.
impl From<Error> for io::Error {
    fn from(error: Error) -> io::Error {
        io::Error::other(error)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::error::Error as _;
    use std::path::Path;

    #[test]
    fn the_error_of_the_system_is_the_source() {
        let cause = io::Error::from_raw_os_error(2);
        let error = Error::file("read", Path::new("gone.tif"), &cause);
        assert!(error.to_string().starts_with("cannot read gone.tif: "), "{error}");
        let source = error.source().and_then(|source| source.downcast_ref::<io::Error>()).unwrap();
        assert_eq!((source.kind(), source.raw_os_error()), (cause.kind(), Some(2)));
        assert!(Error::new(ErrorKind::Request, "no").source().is_none());
    }

    #[test]
    fn an_error_that_passes_through_a_writer_keeps_its_own_source() {
        let inner = Error::file("read", Path::new("gone.tif"), &io::Error::from_raw_os_error(2));
        let outer = Error::file("write", Path::new("new.tif"), &io::Error::from(inner));
        let source = outer.source().and_then(|source| source.downcast_ref::<io::Error>()).unwrap();
        let kept = source.get_ref().and_then(|wrapped| wrapped.downcast_ref::<Error>()).unwrap();
        assert_eq!(kept.kind(), ErrorKind::File);
        let system = kept.source().and_then(|source| source.downcast_ref::<io::Error>()).unwrap();
        assert_eq!(system.raw_os_error(), Some(2));
    }
}
