//! Writing that can be cancelled.

use std::io::{self, Write};

use orogen_grid::progress::Progress;

/// A writer that fails after cancellation.
pub struct CancellableWriter<'a> {
    /// The inner writer.
    pub out: &'a mut dyn Write,
    /// Checked before each write.
    pub progress: &'a Progress,
}

impl Write for CancellableWriter<'_> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.progress.check()?;
        self.out.write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.out.flush()
    }
}
