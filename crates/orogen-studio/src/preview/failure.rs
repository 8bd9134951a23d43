//! Errors of the work that makes pictures.

use orogen::{Error, ErrorKind};

/// Converts the error of a stream.
#[must_use]
pub fn of_stream(cause: std::io::Error) -> Error {
    let own = cause.get_ref().and_then(|inner| inner.downcast_ref::<Error>()).cloned();
    own.unwrap_or_else(|| Error::new(ErrorKind::File, cause.to_string()))
}

/// The error of a request that returned no layer.
#[must_use]
pub fn nothing() -> Error {
    Error::new(ErrorKind::Internal, "no layer was computed")
}
