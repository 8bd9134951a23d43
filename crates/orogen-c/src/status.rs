//! What a call returns, and the message of an error.

use std::cell::RefCell;
use std::ffi::{CString, c_char};
use std::panic::{AssertUnwindSafe, catch_unwind};

use engine::{Error, ErrorKind, Result};

/// The result of a call.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[allow(non_camel_case_types, reason = "the names in C")]
pub enum OrogenStatus {
    /// The call did what it says.
    OROGEN_OK = 0,
    /// The recipe is not valid.
    OROGEN_RECIPE = 1,
    /// The world has no such window, layer or chunk, or an argument is not valid.
    OROGEN_REQUEST = 2,
    /// The work needs more memory than it may have; it was not started.
    OROGEN_MEMORY = 3,
    /// A file could not be read or written.
    OROGEN_FILE = 4,
    /// The work was cancelled.
    OROGEN_CANCELLED = 5,
    /// The library is wrong: please report the message.
    OROGEN_BUG = 6,
}

thread_local! {
    static MESSAGE: RefCell<CString> = RefCell::default();
}

/// The message of the last call of this thread that failed; an empty text if none did. It is valid until the next call
/// of this thread fails. Never null.
#[unsafe(no_mangle)]
pub extern "C" fn orogen_error() -> *const c_char {
    MESSAGE.with_borrow(|message| message.as_ptr())
}

/// The version of the library, such as "0.1.0".
#[unsafe(no_mangle)]
pub extern "C" fn orogen_version() -> *const c_char {
    const VERSION: &str = concat!(env!("CARGO_PKG_VERSION"), "\0");
    VERSION.as_ptr().cast()
}

/// Keeps a message for [`orogen_error`].
fn keep(message: &str) {
    let text = CString::new(message.replace('\0', " ")).unwrap_or_default();
    MESSAGE.set(text);
}

/// An error for an argument.
pub(crate) fn wrong(message: impl Into<String>) -> Error {
    Error::new(ErrorKind::Request, message.into())
}

/// Runs the body of a call. A panic, which is a bug, ends here: it must not pass into C.
pub(crate) fn guarded(body: impl FnOnce() -> Result<()>) -> OrogenStatus {
    match catch_unwind(AssertUnwindSafe(body)) {
        Ok(Ok(())) => OrogenStatus::OROGEN_OK,
        Ok(Err(error)) => {
            keep(&error.to_string());
            match error.kind() {
                ErrorKind::Recipe => OrogenStatus::OROGEN_RECIPE,
                ErrorKind::Memory => OrogenStatus::OROGEN_MEMORY,
                ErrorKind::File => OrogenStatus::OROGEN_FILE,
                ErrorKind::Cancelled => OrogenStatus::OROGEN_CANCELLED,
                ErrorKind::Internal => OrogenStatus::OROGEN_BUG,
                _ => OrogenStatus::OROGEN_REQUEST,
            }
        }
        Err(panic) => {
            let text = panic.downcast_ref::<String>().cloned();
            let text = text.or_else(|| panic.downcast_ref::<&str>().map(ToString::to_string)).unwrap_or_default();
            keep(&format!("a bug of the library: {text}"));
            OrogenStatus::OROGEN_BUG
        }
    }
}

/// [`guarded`] for a call that returns a pointer: null after an error.
pub(crate) fn made<T>(body: impl FnOnce() -> Result<T>) -> *mut T {
    let mut made = std::ptr::null_mut();
    guarded(|| {
        made = Box::into_raw(Box::new(body()?));
        Ok(())
    });
    made
}
