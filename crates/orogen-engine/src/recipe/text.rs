//! The text of a recipe, and positions in it.

use orogen_grid::error::{Diagnostic, Error, ErrorKind, Location, Result};
use orogen_grid::words::count;
use orogen_ops::value::Span;
use std::path::Path;

/// Maximum length of a recipe's text, in bytes.
pub const LONGEST_TEXT: u64 = 16 << 20;

/// A text and its name in diagnostics.
pub struct Text<'a> {
    pub name: &'a str,
    pub text: &'a str,
}

impl Text<'_> {
    /// A diagnostic about a part of the text.
    pub fn diagnostic(&self, span: &Span, message: impl Into<String>) -> Diagnostic {
        Diagnostic::new(message).with_place(Some(self.locate(span)))
    }

    /// An error of one diagnostic.
    pub fn error(&self, span: &Span, message: impl Into<String>) -> Error {
        Error::from_diagnostics(ErrorKind::Recipe, vec![self.diagnostic(span, message)])
    }

    /// An error of several diagnostics: in the order of the text, then diagnostics of other texts, then the number of
    /// `more`.
    pub fn errors(&self, mut diagnostics: Vec<Diagnostic>, elsewhere: Vec<Diagnostic>, more: usize) -> Error {
        diagnostics.sort_by_key(|diagnostic| diagnostic.place.as_ref().map(|place| (place.line, place.column)));
        diagnostics.extend(elsewhere);
        if more > 0 {
            diagnostics.push(Diagnostic::new(format!("and {}", count(more, "more diagnostic"))));
        }
        Error::from_diagnostics(ErrorKind::Recipe, diagnostics)
    }

    /// A part of a string's value as a part of the text: exact if the string has no escapes, otherwise the whole
    /// string.
    pub fn within(&self, string: &Span, value: &str, part: &Span) -> Span {
        let source = self.text.get(string.clone()).unwrap_or_default();
        match source.find(value) {
            Some(at) if !value.is_empty() => {
                let start = string.start + at;
                start + part.start..start + part.end
            }
            _ => string.clone(),
        }
    }

    /// The location of a part of the text.
    pub fn locate(&self, span: &Span) -> Location {
        let start = floor_boundary(self.text, span.start);
        let end = floor_boundary(self.text, span.end).max(start);
        let line_start = self.text[..start].rfind('\n').map_or(0, |newline| newline + 1);
        let line_end = self.text[start..].find('\n').map_or(self.text.len(), |newline| start + newline);
        // Very long lines are not shown: twenty diagnostics about a line of 16 MiB would copy it twenty times.
        const LONGEST_SHOWN: usize = 20_000;
        let line = if line_end - line_start > LONGEST_SHOWN { "" } else { &self.text[line_start..line_end] };
        Location::new(
            self.name.to_string(),
            self.text[..start].matches('\n').count() + 1,
            self.text[line_start..start].chars().count() + 1,
        )
        .with_length(self.text[start..end.clamp(start, line_end)].chars().count().max(1))
        .with_text(line.trim_end_matches('\r').to_string())
    }
}

fn floor_boundary(text: &str, at: usize) -> usize {
    let mut at = at.min(text.len());
    while !text.is_char_boundary(at) {
        at -= 1;
    }
    at
}

/// The error for a text of more than [`LONGEST_TEXT`] bytes.
pub fn too_long(name: &str) -> Error {
    Error::new(
        ErrorKind::Recipe,
        format!(
            "{name} is not a recipe: it is longer than {}, the maximum length of a recipe",
            orogen_grid::words::bytes(LONGEST_TEXT)
        ),
    )
}

/// The content of a file as text.
pub fn text_of(content: Vec<u8>, path: &Path) -> Result<String> {
    // UTF-16, which some Windows editors and shells write.
    if content.starts_with(b"\xff\xfe") || content.starts_with(b"\xfe\xff") {
        let path = path.display();
        return Err(Error::new(
            ErrorKind::Recipe,
            format!("{path} is not a recipe: it is UTF-16 text; save it as UTF-8"),
        ));
    }
    String::from_utf8(content).map_err(|fault| {
        Error::new(
            ErrorKind::Recipe,
            format!(
                "{} is not a recipe: byte {} is not UTF-8 text; a recipe is a TOML or JSON file",
                path.display(),
                fault.utf8_error().valid_up_to()
            ),
        )
    })
}
