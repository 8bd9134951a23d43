//! Text within markup: escaped characters, and bytes.

use std::io::{self, Write};

/// Text without control characters, with the characters escaped that begin markup.
pub(crate) fn escaped(text: &str) -> String {
    let text: String = text.chars().filter(|letter| !letter.is_control()).collect();
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;")
}

/// Writes bytes as base64 (RFC 4648).
pub(crate) fn base64(out: &mut dyn Write, bytes: &[u8]) -> io::Result<()> {
    const LETTERS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let mut text = Vec::with_capacity(4096);
    for chunk in bytes.chunks(3 * 1024) {
        text.clear();
        for three in chunk.chunks(3) {
            let at = |k: usize| u32::from(three.get(k).copied().unwrap_or(0));
            let bits = at(0) << 16 | at(1) << 8 | at(2);
            for k in 0..4 {
                let letter = LETTERS[(bits >> (18 - 6 * k)) as usize & 63];
                text.push(if k > three.len() { b'=' } else { letter });
            }
        }
        out.write_all(&text)?;
    }
    Ok(())
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
    }
}
