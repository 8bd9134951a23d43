//! Given options.

use std::collections::BTreeMap;
use std::path::Path;

use super::palette::find_palette;
use super::spec::{Condition, OptionSpec};
use super::value::Value;
use orogen_grid::error::{Error, ErrorKind, Result};
use orogen_grid::words::nearest;
use orogen_io::palette::color::Rgb;
use orogen_io::palette::palette::Palette;
use orogen_output::sheet::paper::Paper;

/// The given options, by name.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Options {
    given: BTreeMap<&'static str, (Value, String)>,
}

impl Options {
    /// Parses options of these declarations from text; the text of a switch is ignored.
    ///
    /// # Errors
    /// If no declaration has this name, or a value is not valid.
    pub fn of<'a>(
        specs: impl IntoIterator<Item = &'static OptionSpec>,
        given: impl IntoIterator<Item = (&'a str, &'a str)>,
    ) -> Result<Options> {
        let specs: Vec<&OptionSpec> = specs.into_iter().collect();
        let mut options = Options::default();
        for (name, text) in given {
            let Some(spec) = specs.iter().find(|spec| spec.name == name) else {
                let hint = nearest(name, specs.iter().map(|spec| spec.name));
                let hint = hint.map_or(String::new(), |near| format!("; did you mean `{near}`?"));
                return Err(request(format!("there is no option `{}`{hint}", name.escape_debug())));
            };
            options.give(spec, text)?;
        }
        Ok(options)
    }

    /// Sets an option from text. For a switch the text is ignored.
    ///
    /// # Errors
    /// If the value is not valid.
    pub fn give(&mut self, spec: &OptionSpec, text: &str) -> Result<()> {
        let value = spec
            .parse(text)
            .map_err(|why| request(format!("`{}` is not a value for --{}: {why}", text.escape_debug(), spec.name)))?;
        self.given.insert(spec.name, (value, text.to_owned()));
        Ok(())
    }

    /// Checks that each given option of these declarations applies together with the others.
    ///
    /// # Errors
    /// If one does not apply.
    pub fn check(&self, specs: &[OptionSpec]) -> Result<()> {
        let value = |spec: &OptionSpec| self.given.get(spec.name).map(|(_, text)| text.clone());
        for spec in specs.iter().filter(|spec| self.has(spec.name)) {
            let name = spec.name;
            if let Some(other) = spec.excludes.iter().find(|other| self.has(other)) {
                let message = format!("--{name} and --{other} exclude each other; leave out one of them");
                return Err(request(message));
            }
            if !spec.applies(specs, value) {
                return Err(request(match spec.condition {
                    Condition::Always => continue,
                    Condition::Given(other) => format!("--{name} needs --{other}"),
                    Condition::Is(other, words) => format!("--{name} applies to --{other} {}", words.join(" or ")),
                    Condition::IsFile(other) => format!("--{name} needs a file as --{other}"),
                    Condition::IsNot(other, word) => format!("--{name} needs a --{other} other than {word}"),
                }));
            }
        }
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

    fn value(&self, name: &str) -> Option<&Value> {
        self.given.get(name).map(|(value, _)| value)
    }

    /// The value of an integer option.
    #[must_use]
    pub fn whole(&self, name: &str) -> Option<u64> {
        match self.value(name)? {
            Value::Whole(n) => Some(*n),
            _ => None,
        }
    }

    /// The value of a number option; `None` if it is `auto`.
    #[must_use]
    pub fn number(&self, name: &str) -> Option<f64> {
        match self.value(name)? {
            Value::Number(n) => Some(*n),
            _ => None,
        }
    }

    /// The value of an option with several numbers.
    #[must_use]
    pub fn numbers(&self, name: &str) -> Option<&[f64]> {
        match self.value(name)? {
            Value::Numbers(numbers) => Some(numbers),
            _ => None,
        }
    }

    /// The value of an option with two numbers: a range or a position.
    #[must_use]
    pub fn pair(&self, name: &str) -> Option<[f64; 2]> {
        self.numbers(name)?.try_into().ok()
    }

    /// The value of a word option, as declared.
    #[must_use]
    pub fn word(&self, name: &str) -> Option<&'static str> {
        match self.value(name)? {
            Value::Word(word) => Some(word),
            _ => None,
        }
    }

    /// The value of a text option.
    #[must_use]
    pub fn text(&self, name: &str) -> Option<&str> {
        match self.value(name)? {
            Value::Text(text) => Some(text),
            _ => None,
        }
    }

    /// The value of a color option.
    #[must_use]
    pub fn color(&self, name: &str) -> Option<Rgb> {
        match self.value(name)? {
            Value::Color(color) => Some(*color),
            _ => None,
        }
    }

    /// The value of a paper option.
    #[must_use]
    pub fn paper(&self, name: &str) -> Option<Paper> {
        match self.value(name)? {
            Value::Paper(paper) => Some(*paper),
            _ => None,
        }
    }

    /// The palette of the option `palette`, by name or from its file; with `nearest-color` its colors are not
    /// interpolated.
    ///
    /// # Errors
    /// If there is none, or its file cannot be read.
    pub fn palette(&self) -> Result<Option<Palette>> {
        let palette = self.file("palette").map(find_palette).transpose()?;
        Ok(if self.has("nearest-color") { palette.map(Palette::nearest) } else { palette })
    }

    /// The value of a file or palette option.
    #[must_use]
    pub fn file(&self, name: &str) -> Option<&Path> {
        match self.value(name)? {
            Value::File(path) => Some(path),
            _ => None,
        }
    }

    /// The files of all given options.
    pub fn files(&self) -> impl Iterator<Item = &Path> {
        self.given.values().filter_map(|(value, _)| match value {
            Value::File(path) => Some(path.as_path()),
            _ => None,
        })
    }
}

fn request(message: String) -> Error {
    Error::new(ErrorKind::Request, message)
}

#[cfg(test)]
mod tests {
    use super::super::{Choice, Component, ValueKind};
    use super::*;

    fn given(kind: ValueKind, text: &str) -> std::result::Result<Options, String> {
        let mut options = Options::default();
        options.give(&OptionSpec::new("x", "X", kind).with_about("a test"), text).map_err(|error| error.to_string())?;
        Ok(options)
    }

    const PLACE: &[Component] = &[
        Component::new("east", " m", [0.0, 1e4]),
        Component::new("south", " m", [0.0, 1e4]),
        Component::new("height", " m", [0.0, 1e4]),
    ];
    const WHICH: &[Choice] = &[Choice::new("all", "All of them"), Choice::new("none", "None of them")];

    #[test]
    fn values_are_what_is_declared() {
        assert_eq!(given(ValueKind::Whole(1, 9), "9").unwrap().whole("x"), Some(9));
        assert_eq!(given(ValueKind::Number(0.0, 1.0), " .5").unwrap().number("x"), Some(0.5));
        assert_eq!(given(ValueKind::Range, "-5, 7").unwrap().pair("x"), Some([-5.0, 7.0]));
        assert_eq!(given(ValueKind::Word(&["half", "float"]), "HALF").unwrap().word("x"), Some("half"));
        assert_eq!(given(ValueKind::Point, "7, -5").unwrap().pair("x"), Some([7.0, -5.0]));
        assert_eq!(given(ValueKind::Positive, "5e-3").unwrap().number("x"), Some(0.005));
        assert_eq!(given(ValueKind::Numbers, "1, -2,3.5").unwrap().numbers("x"), Some(&[1.0, -2.0, 3.5][..]));
        assert_eq!(given(ValueKind::Tuple(PLACE, 2), "1,2").unwrap().pair("x"), Some([1.0, 2.0]));
        assert_eq!(given(ValueKind::Tuple(PLACE, 2), "1,2,-3").unwrap().numbers("x"), Some(&[1.0, 2.0, -3.0][..]));
        assert_eq!(given(ValueKind::Size(99), "64X40").unwrap().pair("x"), Some([64.0, 40.0]));
        assert_eq!(given(ValueKind::Size(99), "64").unwrap().numbers("x"), Some(&[64.0][..]));
        assert_eq!(given(ValueKind::Clock, "17:30").unwrap().number("x"), Some(17.5));
        assert_eq!(given(ValueKind::Part(64), "3/64").unwrap().pair("x"), Some([3.0, 64.0]));
        assert_eq!(given(ValueKind::Choice(WHICH), "All").unwrap().word("x"), Some("all"));
        assert_eq!(given(ValueKind::Color, "ivory").unwrap().color("x"), Some([255, 255, 240]));
        assert_eq!(
            given(ValueKind::Paper, "a4").unwrap().paper("x").map(|paper| paper.sides(true)),
            Some([297.0, 210.0])
        );
        let automatic = given(ValueKind::Automatic, "auto").unwrap();
        assert!(automatic.has("x") && automatic.number("x").is_none());
        assert_eq!(given(ValueKind::Automatic, "250").unwrap().number("x"), Some(250.0));
        assert_eq!(given(ValueKind::Text, "any").unwrap().text("x"), Some("any"));
        let file = given(ValueKind::File, "a.csv").unwrap();
        assert!(file.file("x") == Some(Path::new("a.csv")) && file.files().eq(file.file("x")));
        let flag = given(ValueKind::Nothing, "").unwrap();
        assert!(flag.has("x") && !flag.has("y") && flag.whole("x").is_none());
    }

    #[test]
    fn what_is_no_value_is_a_sentence() {
        for (kind, text, expect) in [
            (ValueKind::Whole(1, 9), "10", "`10` is not a value for --x: it must be a whole number from 1 to 9"),
            (ValueKind::Number(0.0, 1.0), "nan", "a number from 0 to 1"),
            (ValueKind::Range, "7,-5", "the lower first"),
            (ValueKind::Range, "7", "two numbers"),
            (ValueKind::Point, "7", "two numbers"),
            (ValueKind::Point, "7,inf", "two numbers"),
            (ValueKind::File, " ", "it must be the path of a file"),
            (ValueKind::Word(&["a", "b", "c"]), "d", "it must be a, b or c"),
            (ValueKind::Choice(WHICH), "some", "it must be all or none"),
            (ValueKind::Positive, "0", "greater than 0"),
            (ValueKind::Tuple(PLACE, 2), "1", "it must be EAST,SOUTH[,HEIGHT]: numbers"),
            (ValueKind::Tuple(PLACE, 2), "1,2,3,4", "EAST,SOUTH[,HEIGHT]"),
            (ValueKind::Tuple(PLACE, 2), "1,nan", "EAST,SOUTH[,HEIGHT]"),
            (ValueKind::Size(1920), "1921", "N or WxH, such as 1920x1080, with sides from 1 to 1920"),
            (ValueKind::Size(99), "0x5", "N or WxH, such as 2x2, with sides from 1 to 99"),
            (ValueKind::Clock, "24:00", "from 00:00 to 23:59"),
            (ValueKind::Clock, "12:60", "from 00:00 to 23:59"),
            (ValueKind::Clock, "12", "from 00:00 to 23:59"),
            (ValueKind::Part(64), "3", "it must be K/N, such as 3/64 for the third of 64 parts"),
            (ValueKind::Part(64), "a/b", "it must be K/N"),
            (ValueKind::Part(64), "-1/4", "it must be K/N"),
            (ValueKind::Part(64), "0/4", "parts are counted from 1"),
            (ValueKind::Part(64), "0/0", "parts are counted from 1"),
            (ValueKind::Part(64), "5/4", "there is no part 5 of 4: the last is 4/4"),
            (ValueKind::Part(64), "1/65", "at most 64 parts"),
            (ValueKind::Automatic, "-1", "or auto"),
            (ValueKind::Numbers, "1,,2", "separated by commas"),
            (ValueKind::Color, "#12345", "a color must be"),
            (ValueKind::Paper, "10x200mm", "the paper size must be"),
            (ValueKind::Palette, "", "the name of a palette"),
        ] {
            let why = given(kind, text).unwrap_err();
            assert!(why.contains(expect), "{why}");
        }
    }

    #[test]
    fn options_without_a_declaration_are_refused() {
        const SPECS: &[OptionSpec] = &[OptionSpec::switch("landscape")];
        let why = Options::of(SPECS, [("landscap", "")]).unwrap_err().to_string();
        assert_eq!(why, "there is no option `landscap`; did you mean `landscape`?");
    }

    /// The result of the check of these options, with the message.
    fn checked(given: &[(&str, &str)]) -> std::result::Result<(), String> {
        const SPECS: &[OptionSpec] = &[
            OptionSpec::new("color", "WHAT", ValueKind::Word(&["map", "clay"])).with_default("map"),
            OptionSpec::new("palette", "NAME", ValueKind::Palette).when(Condition::Is("color", &["map"])),
            OptionSpec::switch("nearest").when(Condition::Given("palette")),
            OptionSpec::switch("gloss").when(Condition::IsNot("color", "map")),
            OptionSpec::switch("matt").without(&["gloss"]),
        ];
        let options = Options::of(SPECS, given.iter().copied()).unwrap();
        options.check(SPECS).map_err(|error| error.to_string())
    }

    #[test]
    fn options_that_do_not_apply_are_named() {
        for (given, expect) in [
            (&[][..], Ok(())),
            (&[("palette", "x"), ("nearest", "")], Ok(())),
            (&[("color", "clay"), ("gloss", "")], Ok(())),
            (&[("nearest", "")], Err("--nearest needs --palette")),
            (&[("color", "clay"), ("palette", "x")], Err("--palette applies to --color map")),
            (&[("gloss", "")], Err("--gloss needs a --color other than map")),
            (
                &[("color", "clay"), ("gloss", ""), ("matt", "")],
                Err("--matt and --gloss exclude each other; leave out one of them"),
            ),
        ] {
            assert_eq!(checked(given), expect.map_err(str::to_owned), "{given:?}");
        }
    }
}
