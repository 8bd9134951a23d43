//! A mark that distinguishes a text written by Orogen from one written or changed by hand.
//!
//! Recipes are texts that people edit. A recipe written by Orogen contains a comment with the SHA-256 of all its other
//! lines. After any change the hash no longer matches, and the file counts as written by hand.

use orogen_grid::hex;
use sha2::{Digest, Sha256};

/// The text of the mark before the hexadecimal digits.
const BEFORE: &str = "# Orogen replaces this file only while it is unchanged: SHA-256 ";

/// Adds the mark to a text: after the first line if that is a comment, otherwise at the top.
///
/// ```
/// use orogen_io::file::mark::{is_intact, marked};
///
/// let text = marked("# A comment.\norogen = 1\n");
/// assert!(is_intact(&text) && !is_intact(&text.replace("orogen = 1", "orogen = 2")));
/// ```
#[must_use]
pub fn marked(text: &str) -> String {
    let first = match text.starts_with('#') {
        true => text.find('\n').map_or(0, |end| end + 1),
        false => 0,
    };
    let (head, tail) = text.split_at(first);
    format!("{head}{BEFORE}{}\n{tail}", digest([head, tail]))
}

/// Whether a text has a mark that matches its content.
#[must_use]
pub fn is_intact(text: &str) -> bool {
    let Some(start) = text.find(BEFORE).filter(|start| *start == 0 || text[..*start].ends_with('\n')) else {
        return false;
    };
    let rest = &text[start + BEFORE.len()..];
    let Some((digits, tail)) = rest.split_once('\n') else { return false };
    digest([&text[..start], tail]) == digits
}

fn digest(parts: [&str; 2]) -> String {
    let mut hash = Sha256::new();
    parts.iter().for_each(|part| hash.update(part.as_bytes()));
    hex::encode(&hash.finalize())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn any_change_ends_it() {
        for text in ["", "orogen = 1\n", "# head\norogen = 1\n# tail", "# only a comment"] {
            let whole = marked(text);
            assert!(is_intact(&whole), "{whole}");
            let without: String = whole.lines().filter(|line| !line.starts_with(BEFORE)).collect::<Vec<_>>().join("\n");
            assert!(!is_intact(&without));
            for at in 0..whole.len() {
                let mut other = whole.clone().into_bytes();
                other[at] ^= 1;
                assert!(!is_intact(&String::from_utf8(other).unwrap()), "{at} of {whole}");
            }
            assert!(!is_intact(&format!("{whole}# mine\n")));
            assert!(!is_intact(&format!("# mine\n{whole}")));
        }
    }
}
