//! Errors of the library as exceptions of `orogen.errors`.

use orogen::{Error, ErrorKind};
use pyo3::exceptions::{PyImportError, PyKeyboardInterrupt};
use pyo3::prelude::*;
use pyo3::types::PyType;

/// The exception for an error.
pub fn raised(py: Python<'_>, error: &Error) -> PyErr {
    let name = match error.kind() {
        ErrorKind::Recipe => "RecipeError",
        ErrorKind::Request | ErrorKind::Part => "RequestError",
        ErrorKind::Memory => "MemoryLimitError",
        ErrorKind::File => "FileError",
        ErrorKind::Cancelled => return PyKeyboardInterrupt::new_err(error.to_string()),
        _ => "InternalError",
    };
    exception(py, name, &keywords(&error.to_string()))
}

/// The exception for a request that is not valid.
pub fn refused(py: Python<'_>, message: &str) -> PyErr {
    exception(py, "RequestError", message)
}

/// An exception of the library's own kind for a bug.
pub fn internal(py: Python<'_>, message: &str) -> PyErr {
    exception(py, "InternalError", message)
}

/// An exception of the package. They are classes of the Python part, where they can have several bases.
fn exception(py: Python<'_>, name: &str, message: &str) -> PyErr {
    let class = py.import("orogen.errors").and_then(|module| module.getattr(name)).and_then(|class| {
        class.cast_into::<PyType>().map_err(|_| PyImportError::new_err("orogen.errors lacks an exception"))
    });
    match class {
        Ok(class) => PyErr::from_type(class, message.to_owned()),
        Err(error) => error,
    }
}

/// A message in which options are called as in Python: `color_bar` for `--color-bar`.
fn keywords(message: &str) -> String {
    let mut parts = message.split("--");
    let mut text = parts.next().unwrap_or_default().to_owned();
    for part in parts {
        let end = part.find(|c: char| !(c.is_ascii_lowercase() || c == '-')).unwrap_or(part.len());
        let (name, rest) = part.split_at(end);
        match name.starts_with(|c: char| c.is_ascii_lowercase()) {
            true => text.push_str(&name.replace('-', "_")),
            false => text.push_str(&format!("--{name}")),
        }
        text.push_str(rest);
    }
    text
}
