//! Options of formats: declared once beside the format, checked here.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use orogen_grid::error::{Error, ErrorKind, Result};

/// The declaration of an option, from which front ends derive flags, checks and help.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct OptionSpec {
    /// The name, in lower case with hyphens: `bits` for `--bits`.
    pub name: &'static str,
    /// The placeholder of the value in a help: `N`; empty for an option without a value.
    pub value: &'static str,
    /// One line for the help, with unit and default.
    pub about: &'static str,
    /// The valid values.
    pub value_kind: ValueKind,
}

/// The kind of an option's values.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum ValueKind {
    /// No value: the option is a switch.
    Nothing,
    /// An integer in this inclusive range.
    Whole(u64, u64),
    /// A number in this inclusive range.
    Number(f64, f64),
    /// Two numbers separated by a comma, the lower first.
    Range,
    /// Two numbers separated by a comma: a position.
    Point,
    /// One of these words.
    Word(&'static [&'static str]),
    /// Any text.
    Text,
    /// The path of a file that is read.
    File,
}

/// A given value.
#[derive(Debug, Clone, PartialEq)]
enum Value {
    Given,
    Whole(u64),
    Number(f64),
    Range([f64; 2]),
    Point([f64; 2]),
    Word(&'static str),
    Text(String),
    File(PathBuf),
}

impl OptionSpec {
    fn parse(&self, text: &str) -> std::result::Result<Value, String> {
        let text = text.trim();
        let number = |text: &str| text.trim().parse::<f64>().ok().filter(|number| number.is_finite());
        match self.value_kind {
            ValueKind::Nothing => Ok(Value::Given),
            ValueKind::Whole(from, to) => match text.parse::<u64>() {
                Ok(n) if (from..=to).contains(&n) => Ok(Value::Whole(n)),
                _ => Err(format!("it must be a whole number from {from} to {to}")),
            },
            ValueKind::Number(from, to) => match number(text) {
                Some(n) if (from..=to).contains(&n) => Ok(Value::Number(n)),
                _ => Err(format!("it must be a number from {from} to {to}")),
            },
            ValueKind::Range => match text.split_once(',').map(|(low, high)| (number(low), number(high))) {
                Some((Some(low), Some(high))) if low < high => Ok(Value::Range([low, high])),
                _ => Err("it must be two numbers, the lower first, such as -500,4500".into()),
            },
            ValueKind::Point => match text.split_once(',').map(|(x, y)| (number(x), number(y))) {
                Some((Some(x), Some(y))) => Ok(Value::Point([x, y])),
                _ => Err("it must be two numbers separated by a comma, such as 1200,850".into()),
            },
            ValueKind::Word(words) => match words.iter().find(|word| word.eq_ignore_ascii_case(text)) {
                Some(word) => Ok(Value::Word(word)),
                None => Err(format!("it must be {}", one_of(words))),
            },
            ValueKind::Text => Ok(Value::Text(text.to_string())),
            ValueKind::File if text.is_empty() => Err("it must be the path of a file".into()),
            ValueKind::File => Ok(Value::File(text.into())),
        }
    }
}

/// All options of several declarations, by name, each with those that have it.
pub(super) fn by_name<T: Copy>(
    declared: impl IntoIterator<Item = (T, &'static [OptionSpec])>,
) -> Vec<(&'static OptionSpec, Vec<T>)> {
    let mut all: Vec<(&OptionSpec, Vec<T>)> = Vec::new();
    for (owner, specs) in declared {
        for spec in specs {
            match all.iter_mut().find(|(known, _)| known.name == spec.name) {
                Some((_, owners)) => owners.push(owner),
                None => all.push((spec, vec![owner])),
            }
        }
    }
    all.sort_by_key(|(spec, _)| spec.name);
    all
}

/// "a, b or c".
fn one_of(words: &[&str]) -> String {
    match words {
        [init @ .., last] if !init.is_empty() => format!("{} or {last}", init.join(", ")),
        words => words.concat(),
    }
}

/// The given options, by name.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Options {
    given: BTreeMap<&'static str, Value>,
}

impl Options {
    /// Sets an option from text. For a switch the text is ignored.
    ///
    /// # Errors
    /// If the value is not valid.
    pub fn give(&mut self, spec: &OptionSpec, text: &str) -> Result<()> {
        let value = spec.parse(text).map_err(|why| {
            let message = format!("`{}` is not a value for --{}: {why}", text.escape_debug(), spec.name);
            Error::new(ErrorKind::Request, message)
        })?;
        self.given.insert(spec.name, value);
        Ok(())
    }

    /// The names of the given options.
    pub fn names(&self) -> impl Iterator<Item = &'static str> {
        self.given.keys().copied()
    }

    /// Whether the option was given.
    #[must_use]
    pub fn has(&self, name: &str) -> bool {
        self.given.contains_key(name)
    }

    /// The value of an integer option.
    #[must_use]
    pub fn whole(&self, name: &str) -> Option<u64> {
        match self.given.get(name)? {
            Value::Whole(n) => Some(*n),
            _ => None,
        }
    }

    /// The value of a number option.
    #[must_use]
    pub fn number(&self, name: &str) -> Option<f64> {
        match self.given.get(name)? {
            Value::Number(n) => Some(*n),
            _ => None,
        }
    }

    /// The value of a range option.
    #[must_use]
    pub fn range(&self, name: &str) -> Option<[f64; 2]> {
        match self.given.get(name)? {
            Value::Range(ends) => Some(*ends),
            _ => None,
        }
    }

    /// The value of a position option.
    #[must_use]
    pub fn point(&self, name: &str) -> Option<[f64; 2]> {
        match self.given.get(name)? {
            Value::Point(place) => Some(*place),
            _ => None,
        }
    }

    /// The value of a word option, as declared.
    #[must_use]
    pub fn word(&self, name: &str) -> Option<&'static str> {
        match self.given.get(name)? {
            Value::Word(word) => Some(word),
            _ => None,
        }
    }

    /// The value of a text option.
    #[must_use]
    pub fn text(&self, name: &str) -> Option<&str> {
        match self.given.get(name)? {
            Value::Text(text) => Some(text),
            _ => None,
        }
    }

    /// The value of a file option.
    #[must_use]
    pub fn file(&self, name: &str) -> Option<&Path> {
        match self.given.get(name)? {
            Value::File(path) => Some(path),
            _ => None,
        }
    }

    /// The files of all given options.
    pub fn files(&self) -> impl Iterator<Item = &Path> {
        self.given.values().filter_map(|value| match value {
            Value::File(path) => Some(path.as_path()),
            _ => None,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn spec(value_kind: ValueKind) -> OptionSpec {
        OptionSpec { name: "x", value: "X", about: "a test", value_kind }
    }

    fn given(value_kind: ValueKind, text: &str) -> std::result::Result<Options, String> {
        let mut options = Options::default();
        options.give(&spec(value_kind), text).map_err(|error| error.to_string())?;
        Ok(options)
    }

    #[test]
    fn values_are_what_is_declared() {
        assert_eq!(given(ValueKind::Whole(1, 9), "9").unwrap().whole("x"), Some(9));
        assert_eq!(given(ValueKind::Number(0.0, 1.0), " .5").unwrap().number("x"), Some(0.5));
        assert_eq!(given(ValueKind::Range, "-5, 7").unwrap().range("x"), Some([-5.0, 7.0]));
        assert_eq!(given(ValueKind::Word(&["half", "float"]), "HALF").unwrap().word("x"), Some("half"));
        assert_eq!(given(ValueKind::Point, "7, -5").unwrap().point("x"), Some([7.0, -5.0]));
        assert_eq!(given(ValueKind::Text, "any").unwrap().text("x"), Some("any"));
        let file = given(ValueKind::File, "a.csv").unwrap();
        assert!(file.file("x") == Some(Path::new("a.csv")) && file.files().eq(file.file("x")));
        let flag = given(ValueKind::Nothing, "").unwrap();
        assert!(flag.has("x") && !flag.has("y") && flag.whole("x").is_none());
    }

    #[test]
    fn what_is_no_value_is_a_sentence() {
        for (value_kind, text, expect) in [
            (ValueKind::Whole(1, 9), "10", "`10` is not a value for --x: it must be a whole number from 1 to 9"),
            (ValueKind::Number(0.0, 1.0), "nan", "a number from 0 to 1"),
            (ValueKind::Range, "7,-5", "the lower first"),
            (ValueKind::Range, "7", "two numbers"),
            (ValueKind::Point, "7", "two numbers"),
            (ValueKind::Point, "7,inf", "two numbers"),
            (ValueKind::File, " ", "it must be the path of a file"),
            (ValueKind::Word(&["a", "b", "c"]), "d", "it must be a, b or c"),
        ] {
            let why = given(value_kind, text).unwrap_err();
            assert!(why.contains(expect), "{why}");
        }
    }
}
