//! The options of formats on the command line, made of what the formats declare.

use clap::{Arg, ArgAction, ArgMatches, Command};
use orogen::export::options::{Options, Takes};
use orogen::export::registry;

/// Those that were given.
#[derive(Debug, Clone, Default)]
pub struct FormatOptions {
    /// Names and values as they were typed; of an option without a value, nothing.
    given: Vec<(&'static str, String)>,
}

impl FormatOptions {
    /// As the library takes them.
    ///
    /// # Errors
    /// If a value is none that its option has.
    pub fn read(&self) -> orogen::Result<Options> {
        let mut options = Options::default();
        for (spec, _) in registry::options() {
            for (_, text) in self.given.iter().filter(|(name, _)| *name == spec.name) {
                options.give(spec, text)?;
            }
        }
        Ok(options)
    }
}

impl clap::Args for FormatOptions {
    fn augment_args(mut command: Command) -> Command {
        for (spec, formats) in registry::options() {
            let formats: Vec<&str> = formats.iter().map(|format| format.name).collect();
            let arg = Arg::new(spec.name)
                .long(spec.name)
                .help(format!("{} [{}]", spec.about, formats.join(", ")))
                .help_heading("Options of formats");
            // Spelled as people elsewhere do, too.
            let arg = if spec.name == "color" { arg.aliases(["colors", "colour", "colours"]) } else { arg };
            command = command.arg(match spec.takes {
                Takes::Nothing => arg.action(ArgAction::SetTrue),
                _ => arg.value_name(spec.value).allow_hyphen_values(true),
            });
        }
        command
    }

    fn augment_args_for_update(command: Command) -> Command {
        FormatOptions::augment_args(command)
    }
}

impl clap::FromArgMatches for FormatOptions {
    fn from_arg_matches(matches: &ArgMatches) -> Result<FormatOptions, clap::Error> {
        let mut given = Vec::new();
        for (spec, _) in registry::options() {
            match spec.takes {
                Takes::Nothing if matches.get_flag(spec.name) => given.push((spec.name, String::new())),
                Takes::Nothing => {}
                _ => given.extend(matches.get_one::<String>(spec.name).map(|text| (spec.name, text.clone()))),
            }
        }
        Ok(FormatOptions { given })
    }

    fn update_from_arg_matches(&mut self, matches: &ArgMatches) -> Result<(), clap::Error> {
        *self = FormatOptions::from_arg_matches(matches)?;
        Ok(())
    }
}
