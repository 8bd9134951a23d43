//! Failures of stores as I/O errors with short sentences.

use std::error::Error as StdError;
use std::io;

use object_store::Error;
use object_store::client::{HttpError, HttpErrorKind};

/// Longest text of a server that a message repeats, in characters.
const LONGEST: usize = 200;

/// The I/O error for a failure.
pub fn failure(error: &Error) -> io::Error {
    let of = |kind: io::ErrorKind, text: &str| io::Error::new(kind, text.to_string());
    match error {
        Error::NotFound { .. } => of(io::ErrorKind::NotFound, "there is no such object or bucket"),
        Error::AlreadyExists { .. } => of(io::ErrorKind::AlreadyExists, "the object already exists"),
        Error::Precondition { .. } => of(io::ErrorKind::Other, "it was changed by another process"),
        Error::PermissionDenied { .. } => of(
            io::ErrorKind::PermissionDenied,
            "the store denies it to these credentials; check the environment variables of its account",
        ),
        Error::Unauthenticated { .. } => of(
            io::ErrorKind::PermissionDenied,
            "the store does not accept the credentials; check the environment variables of its account",
        ),
        Error::NotSupported { .. } | Error::NotImplemented { .. } => {
            io::Error::new(io::ErrorKind::Unsupported, format!("the server cannot do it: {}", innermost(error)))
        }
        _ if is_without_tls(error) => of(
            io::ErrorKind::InvalidInput,
            "the address of the server starts with http://; set AWS_ALLOW_HTTP=true (GOOGLE_ALLOW_HTTP, AZURE_ALLOW_HTTP) if it has no TLS",
        ),
        _ if is_unreachable(error) => io::Error::other(format!("the store cannot be reached: {}", innermost(error))),
        _ => io::Error::other(innermost(error)),
    }
}

/// Whether the client refused an address because it is not encrypted. Its text is the only sign.
fn is_without_tls(error: &Error) -> bool {
    innermost(error) == "URL scheme is not allowed"
}

/// Whether no answer came.
fn is_unreachable(error: &Error) -> bool {
    matches!(http(error), Some(HttpErrorKind::Connect | HttpErrorKind::Timeout))
}

/// Whether an answer broke off.
pub fn is_broken_off(error: &Error) -> bool {
    matches!(http(error), Some(HttpErrorKind::Interrupted | HttpErrorKind::Decode | HttpErrorKind::Unknown))
}

/// What went wrong with a request, if that is the cause.
fn http(error: &Error) -> Option<HttpErrorKind> {
    let mut cause: Option<&dyn StdError> = Some(error);
    while let Some(inner) = cause {
        if let Some(failed) = inner.downcast_ref::<HttpError>() {
            return Some(failed.kind());
        }
        cause = inner.source();
    }
    None
}

/// The text of the innermost cause, in one line. The outer ones repeat it behind the names of their types.
fn innermost(error: &Error) -> String {
    let mut cause: &dyn StdError = error;
    while let Some(inner) = cause.source() {
        cause = inner;
    }
    let text: String = cause.to_string().split_whitespace().collect::<Vec<_>>().join(" ");
    // The answers of S3 and Azure are XML with a sentence for people.
    let sentence = text.split_once("<Message>").and_then(|(_, rest)| Some(rest.split_once("</Message>")?.0));
    let text = sentence.map_or(text.clone(), |sentence| format!("the store answers: {sentence}"));
    match text.char_indices().nth(LONGEST) {
        Some((end, _)) => format!("{} ...", &text[..end]),
        None => text,
    }
}
