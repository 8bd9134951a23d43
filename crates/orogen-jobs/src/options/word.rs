//! Words of command lines.

/// A word of a command line, such as a path, quoted if a POSIX shell would not read it literally.
#[must_use]
pub fn quoted(word: &str) -> String {
    let is_plain = |c: char| c.is_alphanumeric() || "_-./,:=@+%".contains(c);
    match !word.is_empty() && word.chars().all(is_plain) {
        true => word.to_owned(),
        false => format!("'{}'", word.replace('\'', "'\\''")),
    }
}

#[cfg(test)]
mod tests {
    use super::quoted;

    #[test]
    fn only_what_a_shell_would_change_is_quoted() {
        for plain in ["a.toml", "-x", "../b_1/c,d:e=f@g+h%", "höhe/山.toml"] {
            assert_eq!(quoted(plain), plain);
        }
        for (word, expect) in
            [("", "''"), ("a b", "'a b'"), ("it's", "'it'\\''s'"), ("$(x)*", "'$(x)*'"), ("a\\b", "'a\\b'")]
        {
            assert_eq!(quoted(word), expect);
        }
    }
}
