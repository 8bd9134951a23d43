//! Command-line options of formats and of derived layers, made from their declarations.

use std::marker::PhantomData;

use clap::{Arg, ArgAction, ArgMatches, Command};
use orogen::export::derived::list;
use orogen::export::options::{OptionSpec, Options, ValueKind};
use orogen::export::registry;

/// A source of option declarations.
pub trait Declares {
    /// The heading in the help.
    const HEADING: &'static str;

    /// All options, each with the names of the formats or layers that have it.
    fn options() -> Vec<(&'static OptionSpec, Vec<&'static str>)>;
}

/// The formats.
#[derive(Debug, Clone, Default)]
pub struct Formats;

impl Declares for Formats {
    const HEADING: &'static str = "Format options [formats that take them]";

    fn options() -> Vec<(&'static OptionSpec, Vec<&'static str>)> {
        let names = |(spec, formats): (_, Vec<&orogen::export::format::Format>)| {
            (spec, formats.iter().map(|format| format.name).collect())
        };
        registry::options().into_iter().map(names).collect()
    }
}

/// The layers that follow from the heights.
#[derive(Debug, Clone, Default)]
pub struct Layers;

impl Declares for Layers {
    const HEADING: &'static str = "Layer options [layers that take them]";

    fn options() -> Vec<(&'static OptionSpec, Vec<&'static str>)> {
        list::options()
    }
}

/// Those that were given.
#[derive(Debug, Clone, Default)]
pub struct OptionsOf<D> {
    /// Names and values as they were typed; of an option without a value, nothing.
    given: Vec<(&'static str, String)>,
    declares: PhantomData<D>,
}

/// The options of formats.
pub type FormatOptions = OptionsOf<Formats>;

/// The options of layers.
pub type LayerOptions = OptionsOf<Layers>;

impl<D: Declares> OptionsOf<D> {
    /// The options, as the library takes them.
    ///
    /// # Errors
    /// If a value is not valid.
    pub fn read(&self) -> orogen::Result<Options> {
        let mut options = Options::default();
        for (spec, _) in D::options() {
            for (_, text) in self.given.iter().filter(|(name, _)| *name == spec.name) {
                options.give(spec, text)?;
            }
        }
        Ok(options)
    }
}

impl<D: Declares> clap::Args for OptionsOf<D> {
    fn augment_args(mut command: Command) -> Command {
        for (spec, known) in D::options() {
            let arg = Arg::new(spec.name)
                .long(spec.name)
                .help(format!("{} [{}]", spec.about, known.join(", ")))
                .help_heading(D::HEADING);
            // Common alternative spellings are accepted.
            let arg = if spec.name == "color" { arg.aliases(["colors", "colour", "colours"]) } else { arg };
            command = command.arg(match spec.value_kind {
                ValueKind::Nothing => arg.action(ArgAction::SetTrue),
                _ => arg.value_name(spec.value).allow_hyphen_values(true),
            });
        }
        command
    }

    fn augment_args_for_update(command: Command) -> Command {
        OptionsOf::<D>::augment_args(command)
    }
}

impl<D: Declares> clap::FromArgMatches for OptionsOf<D> {
    fn from_arg_matches(matches: &ArgMatches) -> Result<OptionsOf<D>, clap::Error> {
        let mut given = Vec::new();
        for (spec, _) in D::options() {
            match spec.value_kind {
                ValueKind::Nothing if matches.get_flag(spec.name) => given.push((spec.name, String::new())),
                ValueKind::Nothing => {}
                _ => given.extend(matches.get_one::<String>(spec.name).map(|text| (spec.name, text.clone()))),
            }
        }
        Ok(OptionsOf { given, declares: PhantomData })
    }

    fn update_from_arg_matches(&mut self, matches: &ArgMatches) -> Result<(), clap::Error> {
        *self = OptionsOf::from_arg_matches(matches)?;
        Ok(())
    }
}
