//! A buffered writer whose code is compiled in this crate.

use std::io::{self, BufWriter, Write};

/// A writer that collects small pieces and writes large ones.
pub struct Buffered<'a>(BufWriter<&'a mut dyn Write>);

impl<'a> Buffered<'a> {
    /// A buffer of `bytes` bytes in front of `out`.
    pub fn new(out: &'a mut dyn Write, bytes: usize) -> Buffered<'a> {
        Buffered(BufWriter::with_capacity(bytes, out))
    }

    /// Drops the buffer without writing the bytes that it still holds.
    pub fn discard(self) {
        drop(self.0.into_parts());
    }
}

impl Write for Buffered<'_> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.0.write(bytes)
    }

    fn write_all(&mut self, bytes: &[u8]) -> io::Result<()> {
        self.0.write_all(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.0.flush()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_discarded_is_not_written() {
        let mut bytes = Vec::new();
        let mut out = Buffered::new(&mut bytes, 4);
        out.write_all(b"ab").and_then(|()| out.write_all(b"cde")).unwrap();
        out.discard();
        assert_eq!(bytes, b"ab");
        let mut out = Buffered::new(&mut bytes, 4);
        out.write_all(b"c").and_then(|()| out.flush()).unwrap();
        out.discard();
        assert_eq!(bytes, b"abc");
    }
}
