//! Values that are names of formats or engines.

use clap::builder::PossibleValue;
use orogen::export::targets::target::EngineTarget;
use orogen::export::{Format, registry, targets};

/// The parser of a value that is one of several names, with a line of help for each.
#[derive(Clone)]
pub struct NameOf {
    all: Vec<PossibleValue>,
    /// The declared name, for a name or an alternative spelling.
    declared: fn(&str) -> Option<&'static str>,
}

impl NameOf {
    /// The formats.
    pub fn format() -> NameOf {
        let value = |format: &&Format| PossibleValue::new(format.name).help(format.about).aliases(format.aliases);
        NameOf {
            all: registry::all().iter().map(value).collect(),
            declared: |name| registry::named(name).map(|format| format.name),
        }
    }

    /// The engines.
    pub fn engine() -> NameOf {
        let value = |target: &&EngineTarget| PossibleValue::new(target.name).help(target.about);
        NameOf {
            all: targets::list::all().iter().map(value).collect(),
            declared: |name| targets::list::named(name).map(|target| target.name),
        }
    }
}

impl clap::builder::TypedValueParser for NameOf {
    type Value = &'static str;

    fn parse_ref(
        &self,
        command: &clap::Command,
        arg: Option<&clap::Arg>,
        value: &std::ffi::OsStr,
    ) -> Result<&'static str, clap::Error> {
        let known = clap::builder::PossibleValuesParser::new(self.all.clone());
        let name = known.parse_ref(command, arg, value)?;
        (self.declared)(&name).ok_or_else(|| clap::Error::new(clap::error::ErrorKind::InvalidValue).with_cmd(command))
    }

    fn possible_values(&self) -> Option<Box<dyn Iterator<Item = PossibleValue> + '_>> {
        Some(Box::new(self.all.iter().cloned()))
    }
}
