//! A writer for tests that simulates a full disk.

use std::io::{self, Write};

/// Accepts `left` bytes, then fails like a full disk.
pub struct Full {
    /// Number of bytes that the writer still accepts.
    pub left: usize,
}

impl Write for Full {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        if self.left == 0 && !bytes.is_empty() {
            return Err(io::ErrorKind::StorageFull.into());
        }
        let take = bytes.len().min(self.left);
        self.left -= take;
        Ok(take)
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}
