//! Command lines that produce the same files as the dialog.

use std::fmt::{self, Display};

use orogen::options::quoted;

/// The words of a command line.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct CommandLine {
    words: Vec<String>,
}

impl CommandLine {
    /// Creates the command line `orogen COMMAND RECIPE`.
    #[must_use]
    pub fn new(command: &str, recipe: &str) -> CommandLine {
        CommandLine { words: vec!["orogen".into(), command.into(), recipe.into()] }
    }

    /// Adds an option without a value.
    pub fn flag(&mut self, name: &str) {
        self.words.push(format!("--{name}"));
    }

    /// Adds an option with its value.
    pub fn option(&mut self, name: &str, value: impl Display) {
        let value = value.to_string();
        match value.starts_with('-') {
            // A separate word would be read as another option.
            true => self.words.push(format!("--{name}={value}")),
            false => self.words.extend([format!("--{name}"), value]),
        }
    }

    /// Adds an option with its value, unless it is the default.
    pub fn differing<T: PartialEq + Display>(&mut self, name: &str, value: T, default: &T) {
        if value != *default {
            self.option(name, value);
        }
    }

    /// The words, as a program receives them.
    #[must_use]
    pub fn words(&self) -> &[String] {
        &self.words
    }
}

impl Display for CommandLine {
    /// The words as typed in a shell.
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        let words: Vec<String> = self.words.iter().map(|word| quoted(word)).collect();
        out.write_str(&words.join(" "))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_are_quoted() {
        let mut line = CommandLine::new("map", "a b.toml");
        line.option("out", "my map's.png");
        line.option("title", "-x");
        line.flag("landscape");
        line.differing("haze", 1.0, &1.0);
        line.differing("haze", 0.5, &1.0);
        assert_eq!(
            line.to_string(),
            "orogen map 'a b.toml' --out 'my map'\\''s.png' --title=-x --landscape --haze 0.5"
        );
        assert_eq!(line.words()[4], "my map's.png");
    }
}
