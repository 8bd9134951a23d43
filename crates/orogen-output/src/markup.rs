//! Text within markup: escaped characters, and bytes.

use std::io::{self, Write};

/// Removes control characters from text and escapes the characters that begin markup.
#[must_use]
pub fn escaped(text: &str) -> String {
    let text: String = text.chars().filter(|letter| !letter.is_control()).collect();
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;")
}

/// A writer that encodes its input as base64 (RFC 4648).
pub struct Base64<'a> {
    out: &'a mut dyn Write,
    /// Up to two bytes that do not yet form a group of three.
    rest: [u8; 3],
    waiting: usize,
    text: Vec<u8>,
}

impl<'a> Base64<'a> {
    pub fn new(out: &'a mut dyn Write) -> Base64<'a> {
        Base64 { out, rest: [0; 3], waiting: 0, text: Vec::new() }
    }

    /// Writes the remaining bytes and the padding.
    pub fn finish(mut self) -> io::Result<()> {
        if self.waiting > 0 {
            let mut letters = letters(self.rest);
            letters[self.waiting + 1..].fill(b'=');
            self.out.write_all(&letters)?;
            self.waiting = 0;
        }
        Ok(())
    }
}

impl Write for Base64<'_> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let mut left = &bytes[..bytes.len().min(48 << 10)];
        let taken = left.len();
        self.text.clear();
        if self.waiting > 0 {
            let more = left.len().min(3 - self.waiting);
            self.rest[self.waiting..self.waiting + more].copy_from_slice(&left[..more]);
            self.waiting += more;
            left = &left[more..];
            if self.waiting == 3 {
                self.text.extend(letters(self.rest));
                self.waiting = 0;
            }
        }
        let threes = left.chunks_exact(3);
        let rest = threes.remainder();
        self.text.extend(threes.flat_map(|three| letters([three[0], three[1], three[2]])));
        if !rest.is_empty() {
            self.rest = [0; 3];
            self.rest[..rest.len()].copy_from_slice(rest);
            self.waiting = rest.len();
        }
        self.out.write_all(&self.text)?;
        Ok(taken)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.out.flush()
    }
}

/// The base64 characters for three bytes.
fn letters([a, b, c]: [u8; 3]) -> [u8; 4] {
    const LETTERS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let bits = u32::from(a) << 16 | u32::from(b) << 8 | u32::from(c);
    [18, 12, 6, 0].map(|shift| LETTERS[(bits >> shift) as usize & 63])
}

/// Writes bytes as base64 (RFC 4648).
pub fn base64(out: &mut dyn Write, bytes: &[u8]) -> io::Result<()> {
    let mut base64 = Base64::new(out);
    base64.write_all(bytes)?;
    base64.finish()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn base64_is_the_standards() {
        for (bytes, expect) in [("", ""), ("f", "Zg=="), ("fo", "Zm8="), ("foo", "Zm9v"), ("foobar", "Zm9vYmFy")] {
            let mut out = Vec::new();
            base64(&mut out, bytes.as_bytes()).unwrap();
            assert_eq!(String::from_utf8(out).unwrap(), expect);
        }
        let bytes: Vec<u8> = (0..100_000u32).map(|k| (k.wrapping_mul(k) >> 7) as u8).collect();
        let mut whole = Vec::new();
        base64(&mut whole, &bytes).unwrap();
        for piece in [1, 2, 4, 1000] {
            let mut parts = Vec::new();
            let mut stream = Base64::new(&mut parts);
            bytes.chunks(piece).for_each(|piece| stream.write_all(piece).unwrap());
            stream.finish().unwrap();
            assert!(parts == whole, "pieces of {piece}");
        }
    }
}
