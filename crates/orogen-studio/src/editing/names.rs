//! Names of nodes.

use std::collections::HashSet;

/// Maximum number of parts of a name: nested groups, and the node in them.
const DEEPEST: usize = 17;

/// A name that is not taken: `name` itself, otherwise with a number from 2.
#[must_use]
pub fn free(name: &str, taken: &HashSet<&str>) -> String {
    if !taken.contains(name) {
        return name.to_string();
    }
    // "hills2" is followed by "hills3".
    let stem = name.trim_end_matches(|c: char| c.is_ascii_digit());
    let stem = if stem.is_empty() { name } else { stem };
    let mut n = 2_u64;
    loop {
        let candidate = format!("{stem}{n}");
        if !taken.contains(candidate.as_str()) {
            return candidate;
        }
        n += 1;
    }
}

/// The name for a new node of an op: the name of the op, made valid for expressions.
#[must_use]
pub fn of_op(op: &str) -> String {
    op.rsplit('.').next().unwrap_or(op).replace('-', "_")
}

/// Why a node or a group cannot have a name, as a key of the catalog of texts. A `/` separates a group from its
/// content.
#[must_use]
pub fn fault(name: &str) -> Option<&'static str> {
    let is_word = |c: char| c.is_ascii_alphanumeric() || matches!(c, '_' | '-');
    let is_good = |part: &str| part.chars().all(is_word) && !part.starts_with(|c: char| c.is_ascii_digit() || c == '-');
    let mut parts = name.split('/');
    match () {
        () if parts.clone().any(str::is_empty) => Some("name.empty"),
        () if parts.clone().any(|part| part.len() > 64) || parts.clone().count() > DEEPEST => Some("name.long"),
        () if !parts.all(is_good) => Some("name.characters"),
        () => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_free() {
        let taken = HashSet::from(["hills", "hills2", "7"]);
        for (name, expect) in [("ridges", "ridges"), ("hills", "hills3"), ("hills2", "hills3"), ("7", "72")] {
            assert_eq!(free(name, &taken), expect);
        }
    }

    #[test]
    fn names_of_ops() {
        assert_eq!(of_op("stream-power"), "stream_power");
        assert_eq!(of_op("mygame.terraces"), "terraces");
    }

    #[test]
    fn faults() {
        for (name, is_good) in [
            ("a", true),
            ("ridge-2_b", true),
            ("hills/rocks/a", true),
            ("", false),
            ("hills/", false),
            ("a.b", false),
            ("a b", false),
            ("2a", false),
            ("山", false),
        ] {
            assert_eq!(fault(name).is_none(), is_good, "{name}");
        }
    }
}
