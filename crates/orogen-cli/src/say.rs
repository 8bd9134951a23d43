//! Standard output and standard error, without panics on closed pipes.

use std::borrow::Cow;
use std::collections::BTreeSet;
use std::io::{self, Write};
use std::path::Path;
use std::sync::{Mutex, PoisonError};

use orogen::options::quoted;

/// The program and its version, for the metadata of files.
pub const SOFTWARE: &str = concat!("Orogen ", env!("CARGO_PKG_VERSION"));

use crate::failure::Failure;

/// Writes text to standard output. Control characters in it are escaped: see [`harmless`].
pub fn out(text: &str) -> Result<(), Failure> {
    let mut stdout = io::stdout().lock();
    stdout.write_all(harmless(text).as_bytes()).and_then(|()| stdout.flush()).map_err(|cause| Failure::stdout(&cause))
}

/// Writes a line to standard error, with control characters escaped as by [`harmless`]. Failures are ignored, because
/// they cannot be reported.
pub fn error(line: &str) {
    painted(&harmless(line));
}

/// Writes a line to standard error, like [`error`], unless it was written before.
pub fn once(line: &str) {
    static WRITTEN: Mutex<BTreeSet<String>> = Mutex::new(BTreeSet::new());
    if WRITTEN.lock().unwrap_or_else(PoisonError::into_inner).insert(line.to_string()) {
        error(line);
    }
}

/// Writes a line with its own colors to standard error.
pub fn painted(line: &str) {
    let _ = writeln!(io::stderr().lock(), "{line}");
}

/// Escapes control characters in a text, except line ends and tabs. Names of files and keys could otherwise move a
/// terminal's cursor, change its colors or reverse the direction of its text.
pub fn harmless(text: &str) -> Cow<'_, str> {
    if !text.contains(|c| is_harmful(c) && !matches!(c, '\n' | '\t')) {
        return Cow::Borrowed(text);
    }
    let mut out = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '\n' | '\t' => out.push(c),
            c if is_harmful(c) => out.extend(c.escape_unicode()),
            c => out.push(c),
        }
    }
    Cow::Owned(out)
}

/// A path as a word of a command line that the user may copy.
pub fn word(path: &Path) -> String {
    let text = path.to_string_lossy();
    // A word that begins with a dash would be read as an option.
    quoted(&if text.starts_with('-') && text.len() > 1 { format!("./{text}") } else { text.into_owned() })
}

/// Whether a character could control a terminal.
pub fn is_harmful(c: char) -> bool {
    c.is_control() || matches!(c, '\u{200e}' | '\u{200f}' | '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}')
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_do_not_control_the_terminal() {
        for (text, expect) in [
            ("a plain line, with ä and ±\n\tand a tab\n", "a plain line, with ä and ±\n\tand a tab\n"),
            ("a\x1b[31mb.tif", "a\\u{1b}[31mb.tif"),
            ("\r\x07\u{9b}2J\u{202e}fit.png", "\\u{d}\\u{7}\\u{9b}2J\\u{202e}fit.png"),
        ] {
            assert_eq!(harmless(text), expect);
        }
    }
}
