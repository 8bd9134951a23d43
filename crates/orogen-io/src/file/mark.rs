//! The line that tells a text written by Orogen from one that a person wrote or changed.
//!
//! A recipe is a text that people edit. One that Orogen wrote holds a comment with the SHA-256 of all its other lines; once a single
//! character is changed, they no longer agree, and the file is the person's.

use sha2::{Digest, Sha256};

/// What stands before the digits, and after them.
const BEFORE: &str = "# Orogen replaces this file only while it is unchanged: SHA-256 ";

/// The text with its mark, behind the first line if that is a comment, else at the top.
///
/// ```
/// use orogen_io::file::mark::{is_intact, marked};
///
/// let text = marked("# A comment.\norogen = 1\n");
/// assert!(is_intact(&text) && !is_intact(&text.replace("orogen = 1", "orogen = 2")));
/// ```
pub fn marked(text: &str) -> String {
    let first = match text.starts_with('#') {
        true => text.find('\n').map_or(0, |end| end + 1),
        false => 0,
    };
    let (head, tail) = text.split_at(first);
    format!("{head}{BEFORE}{}\n{tail}", digest([head, tail]))
}

/// Whether a text holds a mark and is what it was when it was marked.
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
    hash.finalize().iter().map(|byte| format!("{byte:02x}")).collect()
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
