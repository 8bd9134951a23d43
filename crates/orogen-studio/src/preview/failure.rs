//! Errors of the work behind the pictures.

use orogen::{Error, ErrorKind};

/// The error that an error of a stream stands for.
#[must_use]
pub fn of_stream(cause: std::io::Error) -> Error {
    let own = cause.get_ref().and_then(|inner| inner.downcast_ref::<Error>()).cloned();
    own.unwrap_or_else(|| Error::new(ErrorKind::File, cause.to_string()))
}

/// A request that gave no layer.
#[must_use]
pub fn nothing() -> Error {
    Error::new(ErrorKind::Internal, "no layer was computed")
}
