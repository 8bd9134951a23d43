//! Changes of a text that the target makes itself, so that its seeds stay valid when the format changes.

/// The text after the changes that the input lists: each has a position (two bytes), how many bytes are cut, how many
/// are inserted, and those bytes.
pub fn edited(text: &[u8], mut edits: &[u8]) -> Vec<u8> {
    let mut text = text.to_vec();
    while let [low, high, cut, insert, rest @ ..] = edits {
        let (new, rest) = rest.split_at(usize::from(*insert).min(rest.len()));
        edits = rest;
        let at = usize::from(u16::from_le_bytes([*low, *high])).min(text.len());
        let end = (at + usize::from(*cut)).min(text.len());
        text.splice(at..end, new.iter().copied());
    }
    text
}
