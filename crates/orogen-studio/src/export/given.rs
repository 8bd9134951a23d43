//! Options as held by a dialog: texts by name.

use std::collections::BTreeMap;

use orogen::Result;
use orogen::options::{OptionSpec, Options, ValueKind};

use super::command_line::CommandLine;

/// Options as texts by name; a switch has an empty text.
pub type Given = BTreeMap<&'static str, String>;

/// Options that duplicate a choice of another option, so that a dialog needs no field for them.
pub const WITHOUT_FIELD: [&str; 1] = ["no-shade"];

/// Whether an option applies together with the other given options.
#[must_use]
pub fn applies(spec: &OptionSpec, specs: &[OptionSpec], given: &Given) -> bool {
    spec.applies(specs, |other| given.get(other.name).cloned())
}

/// The given options that apply; others stay in the dialog until they apply.
fn applying<'a>(
    specs: &'static [OptionSpec],
    given: &'a Given,
) -> impl Iterator<Item = (&'static OptionSpec, &'a str)> {
    let value = |spec: &'static OptionSpec| Some((spec, given.get(spec.name)?.as_str()));
    specs.iter().filter_map(value).filter(|(spec, _)| applies(spec, specs, given))
}

/// Converts the options for the library.
///
/// # Errors
/// If a value is not valid.
pub fn read(specs: &'static [OptionSpec], given: &Given) -> Result<Options> {
    Options::of(specs, applying(specs, given).map(|(spec, text)| (spec.name, text)))
}

/// The options of declarations from texts that a recipe keeps; unknown ones are dropped.
#[must_use]
pub fn of_kept(specs: &'static [OptionSpec], kept: &BTreeMap<String, String>) -> Given {
    specs.iter().filter_map(|spec| Some((spec.name, kept.get(spec.name)?.clone()))).collect()
}

/// The options as a recipe keeps them: those that apply.
#[must_use]
pub fn kept(specs: &'static [OptionSpec], given: &Given) -> BTreeMap<String, String> {
    applying(specs, given).map(|(spec, text)| (spec.name.to_owned(), text.to_owned())).collect()
}

/// Adds the options to a command line.
pub fn words(specs: &'static [OptionSpec], given: &Given, line: &mut CommandLine) {
    for (spec, text) in applying(specs, given) {
        match spec.kind {
            ValueKind::Nothing => line.flag(spec.name),
            ValueKind::Automatic if text == "auto" => line.flag(spec.name),
            _ => line.differing(spec.name, text, &spec.default),
        }
    }
}
