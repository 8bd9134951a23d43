//! I/O errors of an input, kept while a reader turns them into messages.

use std::io::{Error as IoError, ErrorKind, Read, Result as IoResult, Seek, SeekFrom};

use super::dem::Input;
use orogen_grid::error::Result;

/// Runs a reader on an input. If the input failed, the failure becomes the source of the reader's error, because
/// readers report most problems as text.
pub fn noted<T>(input: &mut dyn Input, read: impl FnOnce(&mut dyn Input) -> Result<T>) -> Result<T> {
    let mut noted = Noted { inner: input, failure: None };
    read(&mut noted).map_err(|error| match &noted.failure {
        Some(cause) => error.with_source(cause),
        None => error,
    })
}

/// An input that keeps its last failure.
struct Noted<'a> {
    inner: &'a mut dyn Input,
    failure: Option<IoError>,
}

impl Noted<'_> {
    /// Keeps a copy with the number or the message of the failure.
    fn note<T>(&mut self, result: IoResult<T>) -> IoResult<T> {
        if let Err(cause) = &result
            && cause.kind() != ErrorKind::Interrupted
        {
            self.failure = Some(match cause.raw_os_error() {
                Some(code) => IoError::from_raw_os_error(code),
                None => IoError::new(cause.kind(), cause.to_string()),
            });
        }
        result
    }
}

impl Read for Noted<'_> {
    fn read(&mut self, to: &mut [u8]) -> IoResult<usize> {
        let result = self.inner.read(to);
        self.note(result)
    }
}

impl Seek for Noted<'_> {
    fn seek(&mut self, to: SeekFrom) -> IoResult<u64> {
        let result = self.inner.seek(to);
        self.note(result)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::format::import::{EXTENSIONS, parse};
    use crate::format::sidecar::Sidecar;
    use std::error::Error;
    use std::io::Cursor;

    /// A disk that fails.
    struct Failing;

    impl Read for Failing {
        fn read(&mut self, _: &mut [u8]) -> IoResult<usize> {
            Err(IoError::from_raw_os_error(5))
        }
    }

    impl Seek for Failing {
        fn seek(&mut self, _: SeekFrom) -> IoResult<u64> {
            Err(IoError::from_raw_os_error(5))
        }
    }

    #[test]
    fn the_failure_of_a_disk_is_the_source_of_every_readers_error() {
        for extension in EXTENSIONS {
            let (width, height) = (Some(4), Some(4));
            let sidecar = Sidecar { width, height, low: Some(0.0), high: Some(1.0), ..Sidecar::default() };
            let error = parse(&mut Failing, "a file", extension, Some(sidecar), 1 << 20).unwrap_err();
            let source = error.source().and_then(|source| source.downcast_ref::<IoError>());
            assert_eq!(source.and_then(IoError::raw_os_error), Some(5), "{extension}: {error}");
        }
        // Errors about damaged content have no such source.
        let error = parse(&mut Cursor::new(vec![0; 100]), "a file", "tif", None, 1 << 20).unwrap_err();
        assert!(error.source().is_none(), "{error}");
    }
}
