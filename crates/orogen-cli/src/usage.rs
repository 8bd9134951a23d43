//! Errors of the command line, and the texts of `--help` and `--version`.

use std::io::Write;

use clap::error::{ContextKind, ContextValue};
use orogen::grid::words;

use crate::failure::Failure;
use crate::say;

/// Handles what clap returned instead of arguments: help is printed, anything else is a failure.
pub fn answer(error: clap::Error) -> Result<(), Failure> {
    if error.use_stderr() {
        return Err(Failure::CommandLine(Box::new(sensible(error))));
    }
    error.print().and_then(|()| std::io::stdout().flush()).map_err(|cause| Failure::stdout(&cause))
}

/// Prints an error of the command line on standard error.
pub fn report(error: &clap::Error) {
    let plain = error.render().to_string();
    match say::harmless(&plain) {
        // With clap's colors.
        text if text == plain => drop(error.print()),
        text => say::painted(text.trim_end()),
    }
}

/// Kinds of invalid words, each with the kind of clap's suggestion for it.
const SUGGESTIONS: [(ContextKind, ContextKind); 3] = [
    (ContextKind::InvalidArg, ContextKind::SuggestedArg),
    (ContextKind::InvalidSubcommand, ContextKind::SuggestedSubcommand),
    (ContextKind::InvalidValue, ContextKind::SuggestedValue),
];

/// Removes suggestions that only share some letters with the word: clap suggests `--cache` for `--scale`.
fn sensible(mut error: clap::Error) -> clap::Error {
    for (wrong, suggested) in SUGGESTIONS {
        let Some(ContextValue::String(word)) = error.get(wrong) else { continue };
        let bare = |word: &str| word.trim_start_matches('-').to_string();
        let word = bare(word);
        let is_near = |candidate: &String| words::nearest(&word, [bare(candidate).as_str()]).is_some();
        let near: Vec<String> = match error.get(suggested) {
            Some(ContextValue::String(candidate)) if is_near(candidate) => continue,
            Some(ContextValue::Strings(all)) => all.iter().filter(|candidate| is_near(candidate)).cloned().collect(),
            _ => Vec::new(),
        };
        if !near.is_empty() {
            error.insert(suggested, ContextValue::Strings(near));
        } else if error.remove(suggested).is_some() {
            // The usage would list the suggestion as well.
            error.remove(ContextKind::Usage);
        }
    }
    error
}
