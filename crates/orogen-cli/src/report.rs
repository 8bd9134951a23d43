//! Error messages on standard error.

use std::fmt::Write as _;
use std::io::{self, IsTerminal};

use orogen::grid::error::{Diagnostic, Location};
use orogen::grid::words;

use crate::failure::Failure;
use crate::{say, usage};

/// Reports a failure: every diagnostic, with its location in the text.
pub fn report(failure: &Failure) {
    let paint = Paint(colors());
    match failure {
        Failure::Usage(message) => say::painted(&paint.diagnostic(message, None)),
        Failure::Engine(error) => {
            for Diagnostic { message, place, .. } in error.diagnostics() {
                say::painted(&paint.diagnostic(message, place.as_ref()));
            }
        }
        Failure::CommandLine(error) => usage::report(error),
        Failure::Interrupted { message, .. } => say::error(&printable(message)),
        Failure::Told | Failure::BrokenPipe => {}
    }
}

/// Whether standard error shows colors: it is a terminal and `NO_COLOR` is not set (<https://no-color.org>).
fn colors() -> bool {
    let declined = std::env::var_os("NO_COLOR").is_some_and(|value| !value.is_empty());
    let dumb = std::env::var_os("TERM").is_some_and(|term| term == "dumb");
    io::stderr().is_terminal() && !declined && !dumb
}

/// Maximum length of the part of a line that is shown around a diagnostic.
const SHOWN: usize = 100;

/// Formats diagnostics, with color or without.
struct Paint(bool);

impl Paint {
    fn red(&self, text: &str) -> String {
        if self.0 { format!("\x1b[1;31m{text}\x1b[0m") } else { text.to_string() }
    }

    /// Formats `error: file:line:column: message`, then the line with the part underlined.
    fn diagnostic(&self, message: &str, place: Option<&Location>) -> String {
        let mut text = format!("{} ", self.red("error:"));
        if let Some(Location { file, line, column, .. }) = place {
            let _ = write!(text, "{}:{line}:{column}: ", printable(file));
        }
        text.push_str(&printable(message));
        if let Some(place) = place.filter(|place| !place.text.trim().is_empty()) {
            text.push('\n');
            text.push_str(&self.excerpt(place));
        }
        text
    }

    fn excerpt(&self, place: &Location) -> String {
        let characters: Vec<char> = place.text.chars().collect();
        let at = place.column.saturating_sub(1).min(characters.len());
        let (from, before) = if at > SHOWN * 2 / 3 { (at - SHOWN / 2, "...") } else { (0, "") };
        let to = (from + SHOWN).min(characters.len());
        let after = if to < characters.len() { "..." } else { "" };
        // One column per character, so that the underline is at the right position.
        let line: String = characters[from..to].iter().map(|&c| one_column(c)).collect();
        let length = place.length.min(to.saturating_sub(at)).max(1);
        let margin = " ".repeat(place.line.to_string().len());
        let indent = " ".repeat(before.len() + at - from);
        let underline = self.red(&"^".repeat(length));
        format!(" {} | {before}{}{after}\n {margin} | {indent}{underline}", place.line, line.trim_end())
    }
}

fn one_column(c: char) -> char {
    if c == '\t' {
        ' '
    } else if say::is_harmful(c) {
        '\u{fffd}'
    } else {
        c
    }
}

/// Maximum length of a message; longer ones quote overlong input.
const SENTENCE: usize = 2000;

/// A message with control characters escaped; it is shortened in the middle if it is too long.
fn printable(text: &str) -> String {
    let text = &words::readable(text.to_string());
    let count = text.chars().count();
    if count > SENTENCE {
        let part = SENTENCE / 2 - 10;
        let start: String = text.chars().take(part).collect();
        let end: String = text.chars().skip(count - part).collect();
        return printable(&format!("{start} ... {end}"));
    }
    say::harmless(text).into_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn place(column: usize, length: usize, text: &str) -> Location {
        Location::new("a.toml", 12, column).with_length(length).with_text(text)
    }

    fn check(place: &Location, expect: &str) {
        assert_eq!(Paint(false).diagnostic("wrong.", Some(place)), expect);
    }

    #[test]
    fn the_place_is_underlined() {
        check(&place(3, 4, "  gian = 2"), "error: a.toml:12:3: wrong.\n 12 |   gian = 2\n    |   ^^^^");
        check(&place(1, 99, "\tx"), "error: a.toml:12:1: wrong.\n 12 |  x\n    | ^^");
        check(&place(3, 1, "x"), "error: a.toml:12:3: wrong.\n 12 | x\n    |  ^");
        check(&place(1, 1, "  "), "error: a.toml:12:1: wrong.");
    }

    #[test]
    fn long_lines_are_cut_around_the_place() {
        let long = format!("{}BAD{}", "a".repeat(5000), "b".repeat(5000));
        let text = Paint(false).diagnostic("wrong.", Some(&place(5001, 3, &long)));
        let lines: Vec<&str> = text.lines().collect();
        assert!(lines[1].len() < 120 && lines[1].starts_with(" 12 | ...aaa") && lines[1].ends_with("bbb..."));
        assert_eq!(lines[1].find("BAD"), lines[2].find("^^^"));
    }

    #[test]
    fn nothing_in_a_file_commands_the_terminal() {
        let text = Paint(false).diagnostic("bad \x1b[31m key", Some(&place(1, 2, "\x1b]0;title\x07 = 1")));
        assert!(text.starts_with("error: a.toml:12:1: bad \\u{1b}[31m key\n"), "{text:?}");
        assert!(!text.contains('\x1b') && !text.contains('\x07'), "{text:?}");
    }
}
