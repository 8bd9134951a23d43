//! Declarations of options.

use std::path::{Path, PathBuf};

use super::value::Value;
use orogen_io::palette::names::{hexadecimal, named};
use orogen_output::sheet::paper::Paper;

/// The declaration of an option, from which front ends derive flags, checks, help and fields.
#[derive(Debug, Clone, Copy, PartialEq)]
#[must_use]
pub struct OptionSpec {
    /// The name, in lower case with hyphens: `bits` for `--bits`.
    pub name: &'static str,
    /// The placeholder of the value in the help: `N`; empty for an option without a value.
    pub value: &'static str,
    /// One line for the help, with unit and default, unless [`default`](OptionSpec::default) is set.
    pub about: &'static str,
    /// The valid values.
    pub kind: ValueKind,
    /// The default value, as text; empty if there is none, or if it depends on the data.
    pub default: &'static str,
    /// A typical value, as text, with which a dialog starts; empty if there is none.
    pub example: &'static str,
    /// The texts before and after the value in a dialog: the unit.
    pub affixes: [&'static str; 2],
    /// Other spellings of the name.
    pub aliases: &'static [&'static str],
    /// The options that cannot be used together with this one.
    pub excludes: &'static [&'static str],
    /// When the option applies.
    pub condition: Condition,
    /// The heading of the group in the help; empty for the job's own options.
    pub heading: &'static str,
}

/// When an option applies.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Condition {
    /// Always.
    Always,
    /// If the named option is given.
    Given(&'static str),
    /// If the named option has one of these values.
    Is(&'static str, &'static [&'static str]),
    /// If the named option has a value other than this one.
    IsNot(&'static str, &'static str),
    /// If the value of the named option is a file, that is, has an extension.
    IsFile(&'static str),
}

/// A word that an option can have as its value.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Choice {
    /// The word.
    pub name: &'static str,
    /// One line for the help.
    pub about: &'static str,
}

impl Choice {
    /// The declaration of a word.
    #[must_use]
    pub const fn new(name: &'static str, about: &'static str) -> Choice {
        Choice { name, about }
    }
}

/// One number of a tuple.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Component {
    /// The name of the number.
    pub name: &'static str,
    /// The text after the number in a dialog: the unit.
    pub unit: &'static str,
    /// The range that a dialog offers; the job checks the value.
    pub ends: [f64; 2],
}

impl Component {
    /// The declaration of a number.
    #[must_use]
    pub const fn new(name: &'static str, unit: &'static str, ends: [f64; 2]) -> Component {
        Component { name, unit, ends }
    }
}

/// The kind of an option's values.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum ValueKind {
    /// No value: the option is a switch.
    Nothing,
    /// An integer in this inclusive range.
    Whole(u64, u64),
    /// A number in this inclusive range, which may be infinite upwards or on both sides.
    Number(f64, f64),
    /// A number above 0.
    Positive,
    /// A number above 0, or `auto`, which is also the value if it is left out.
    Automatic,
    /// One number or more, separated by commas.
    Numbers,
    /// Two numbers separated by a comma, the lower first.
    Range,
    /// Two numbers separated by a comma: a position.
    Point,
    /// Numbers separated by commas; the first ones, of this count, are required.
    Tuple(&'static [Component], usize),
    /// A number of samples or pixels, up to this one, along the longer side or along both sides: `N` or `WxH`.
    Size(usize),
    /// A time of day, such as 17:30.
    Clock,
    /// One of this many parts at most: `K/N`, from 1/N to N/N.
    Part(u64),
    /// One of these words.
    Word(&'static [&'static str]),
    /// One of these words, each with a line of help.
    Choice(&'static [Choice]),
    /// Any text.
    Text,
    /// A color: `#rrggbb` or a name.
    Color,
    /// The name of a layer of the recipe, or of a layer derived from its heights.
    Layer,
    /// The name of a palette, or a file that contains one.
    Palette,
    /// A size of paper.
    Paper,
    /// The name of a built-in tileset, or a file that contains one.
    Tileset,
    /// The path of a file to read.
    File,
}

impl OptionSpec {
    /// An option with a value.
    pub const fn new(name: &'static str, value: &'static str, kind: ValueKind) -> OptionSpec {
        OptionSpec {
            name,
            value,
            about: "",
            kind,
            default: "",
            example: "",
            affixes: ["", ""],
            aliases: &[],
            excludes: &[],
            condition: Condition::Always,
            heading: "",
        }
    }

    /// An option without a value.
    pub const fn switch(name: &'static str) -> OptionSpec {
        OptionSpec::new(name, "", ValueKind::Nothing)
    }

    /// Sets the line for the help.
    pub const fn with_about(self, about: &'static str) -> OptionSpec {
        OptionSpec { about, ..self }
    }

    /// Sets the default.
    pub const fn with_default(self, default: &'static str) -> OptionSpec {
        OptionSpec { default, ..self }
    }

    /// Sets a typical value, and the texts before and after it.
    pub const fn with_example(self, example: &'static str, affixes: [&'static str; 2]) -> OptionSpec {
        OptionSpec { example, affixes, ..self }
    }

    /// Sets other spellings of the name.
    pub const fn with_aliases(self, aliases: &'static [&'static str]) -> OptionSpec {
        OptionSpec { aliases, ..self }
    }

    /// Sets the options that cannot be used together with this one.
    pub const fn without(self, excludes: &'static [&'static str]) -> OptionSpec {
        OptionSpec { excludes, ..self }
    }

    /// Sets the condition under which the option applies.
    pub const fn when(self, condition: Condition) -> OptionSpec {
        OptionSpec { condition, ..self }
    }

    /// Sets the heading.
    pub const fn under(self, heading: &'static str) -> OptionSpec {
        OptionSpec { heading, ..self }
    }

    /// Whether the option applies. `value` returns the value of another option as text, by its declaration.
    #[must_use]
    pub fn applies(&self, specs: &[OptionSpec], value: impl Fn(&OptionSpec) -> Option<String>) -> bool {
        let of = |name: &str| {
            let spec = specs.iter().find(|spec| spec.name == name)?;
            value(spec).or_else(|| (!spec.default.is_empty()).then(|| spec.default.to_owned()))
        };
        let is_given = |name: &str| specs.iter().any(|spec| spec.name == name && value(spec).is_some());
        let holds = match self.condition {
            Condition::Always => true,
            Condition::Given(name) => is_given(name),
            Condition::Is(name, words) => of(name).is_some_and(|value| words.contains(&value.as_str())),
            Condition::IsFile(name) => of(name).is_some_and(|value| Path::new(&value).extension().is_some()),
            Condition::IsNot(name, word) => of(name).is_none_or(|value| value != word),
        };
        holds && !self.excludes.iter().any(|name| is_given(name))
    }

    /// Parses a value.
    ///
    /// # Errors
    /// A message that says what the text must be.
    pub(super) fn parse(&self, text: &str) -> Result<Value, String> {
        let text = text.trim();
        match self.kind {
            ValueKind::Nothing => Ok(Value::Given),
            ValueKind::Whole(from, to) => match text.parse::<u64>() {
                Ok(n) if (from..=to).contains(&n) => Ok(Value::Whole(n)),
                _ => Err(format!("it must be a whole number from {from} to {to}")),
            },
            ValueKind::Number(from, to) => match number(text) {
                Some(n) if (from..=to).contains(&n) => Ok(Value::Number(n)),
                _ if to < f64::INFINITY => Err(format!("it must be a number from {from} to {to}")),
                _ if from > f64::NEG_INFINITY => Err(format!("it must be a number, at least {from}")),
                _ => Err("it must be a number, such as 2 or 0.5".into()),
            },
            ValueKind::Positive => {
                positive(text).map(Value::Number).ok_or_else(|| "it must be a number greater than 0".into())
            }
            ValueKind::Automatic if text == AUTO => Ok(Value::Given),
            ValueKind::Automatic => positive(text).map(Value::Number).ok_or_else(|| {
                let name = self.name;
                format!("it must be a number greater than 0, or {AUTO}; to leave it out, write --{name} at the end")
            }),
            ValueKind::Numbers => match text.split(',').map(number).collect::<Option<Vec<f64>>>() {
                Some(numbers) => Ok(Value::Numbers(numbers)),
                None => Err("it must be numbers separated by commas, such as 100,250.5,500".into()),
            },
            ValueKind::Range => match text.split_once(',').map(|(low, high)| (number(low), number(high))) {
                Some((Some(low), Some(high))) if low < high => Ok(Value::Numbers(vec![low, high])),
                _ => Err("it must be two numbers, the lower first, such as -500,4500".into()),
            },
            ValueKind::Point => match text.split_once(',').map(|(x, y)| (number(x), number(y))) {
                Some((Some(x), Some(y))) => Ok(Value::Numbers(vec![x, y])),
                _ => Err("it must be two numbers separated by a comma, such as 1200,850".into()),
            },
            ValueKind::Tuple(components, least) => tuple(text, components, least).map(Value::Numbers),
            ValueKind::Size(most) => sides(text, most).map(Value::Numbers),
            ValueKind::Clock => match clock(text) {
                Some(hour) => Ok(Value::Number(hour)),
                None => Err("a time must be from 00:00 to 23:59, such as 17:30".into()),
            },
            ValueKind::Part(most) => part(text, most).map(Value::Numbers),
            ValueKind::Word(words) => word(text, words.iter().copied()),
            ValueKind::Choice(choices) => word(text, choices.iter().map(|choice| choice.name)),
            ValueKind::Text => Ok(Value::Text(text.into())),
            ValueKind::Layer | ValueKind::Tileset => Ok(Value::Text(text.into())),
            ValueKind::Color => match hexadecimal(text).or_else(|| named(text)) {
                Some(color) => Ok(Value::Color(color)),
                None => Err("a color must be #rrggbb or a name, such as #fdf6e3 or ivory".into()),
            },
            ValueKind::Paper => text.parse::<Paper>().map(Value::Paper),
            ValueKind::Palette if text.is_empty() => Err("it must be the name of a palette, or a file with one".into()),
            ValueKind::File if text.is_empty() => Err("it must be the path of a file".into()),
            ValueKind::Palette | ValueKind::File => Ok(Value::File(PathBuf::from(text))),
        }
    }

    /// Checks a value given as text.
    ///
    /// # Errors
    /// A message that says what the text must be.
    pub fn check(&self, text: &str) -> Result<(), String> {
        self.parse(text).map(drop)
    }
}

/// The word for a value that is chosen from the data.
const AUTO: &str = "auto";

fn number(text: &str) -> Option<f64> {
    text.trim().parse::<f64>().ok().filter(|number| number.is_finite())
}

fn positive(text: &str) -> Option<f64> {
    number(text).filter(|number| *number > 0.0)
}

/// Parses the numbers of a tuple.
fn tuple(text: &str, components: &[Component], least: usize) -> Result<Vec<f64>, String> {
    let counts = least..=components.len();
    let numbers = text.split(',').map(number).collect::<Option<Vec<f64>>>();
    numbers.filter(|numbers| counts.contains(&numbers.len())).ok_or_else(|| {
        let mut names = String::new();
        for (nth, component) in components.iter().enumerate() {
            let open = if nth < least { "" } else { "[" };
            let comma = if nth == 0 { "" } else { "," };
            names += &format!("{open}{comma}{}", component.name.to_uppercase());
        }
        format!("it must be {names}{}: numbers separated by commas", "]".repeat(components.len() - least))
    })
}

/// Parses one or two sides.
fn sides(text: &str, most: usize) -> Result<Vec<f64>, String> {
    let side = |text: &str| text.trim().parse::<usize>().ok().filter(|side| (1..=most).contains(side));
    let sides = match text.split_once(['x', 'X', '×']) {
        Some((width, height)) => side(width).zip(side(height)).map(|(width, height)| vec![width as f64, height as f64]),
        None => side(text).map(|side| vec![side as f64]),
    };
    let example = if most < 1920 { "2x2" } else { "1920x1080" };
    sides.ok_or_else(|| format!("it must be N or WxH, such as {example}, with sides from 1 to {most}"))
}

/// Parses a time of day; returns hours after midnight.
fn clock(text: &str) -> Option<f64> {
    let number = |text: &str, end: u32| text.trim().parse::<u32>().ok().filter(|n| *n < end).map(f64::from);
    let (hour, minute) = text.split_once(':')?;
    Some(number(hour, 24)? + number(minute, 60)? / 60.0)
}

/// Parses the number of a part and the number of all parts.
fn part(text: &str, most: u64) -> Result<Vec<f64>, String> {
    let number = |text: &str| text.trim().parse::<u64>().ok();
    let numbers = text.split_once('/').and_then(|(part, all)| number(part).zip(number(all)));
    match numbers {
        Some((part, all)) if (1..=all).contains(&part) && all <= most => Ok(vec![part as f64, all as f64]),
        Some((0, _)) => Err("parts are counted from 1: the first of 64 parts is 1/64".into()),
        Some((part, all)) if all <= most => Err(format!("there is no part {part} of {all}: the last is {all}/{all}")),
        Some(_) => Err(format!("there must be at most {most} parts")),
        None => Err("it must be K/N, such as 3/64 for the third of 64 parts".into()),
    }
}

fn word(text: &str, words: impl Iterator<Item = &'static str> + Clone) -> Result<Value, String> {
    let found = words.clone().find(|word| word.eq_ignore_ascii_case(text));
    found.map(Value::Word).ok_or_else(|| format!("it must be {}", one_of(&words.collect::<Vec<_>>())))
}

/// Joins words as in "a, b or c".
fn one_of(words: &[&str]) -> String {
    match words {
        [init @ .., last] if !init.is_empty() => format!("{} or {last}", init.join(", ")),
        words => words.concat(),
    }
}

/// All options of several declarations, by name, each with the owners that declare it.
pub(crate) fn by_name<T: Copy>(
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
