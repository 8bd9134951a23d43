//! Command-line options of formats, derived layers and jobs, made from their declarations.

use std::marker::PhantomData;

use clap::builder::{PossibleValuesParser, ValueParser};
use clap::parser::ValueSource;
use clap::{Arg, ArgAction, ArgMatches, Command};
use orogen::builder::BuildSpec;
use orogen::export::derived::list;
use orogen::export::registry;
use orogen::export::targets::job::EngineJob;
use orogen::fit::FitJob;
use orogen::jobs::noise::NoiseJob;
use orogen::jobs::refine::RefineJob;
use orogen::jobs::variants::VariantsJob;
use orogen::jobs::{AnalyzeJob, BlocksJob, GrowJob, MapJob, RenderJob};
use orogen::locate::LocateJob;
use orogen::options::{Choice, Condition, OptionSpec, Options, ValueKind, quoted};
use orogen::tilemap::TilemapJob;

/// A source of option declarations.
pub trait Declares {
    /// The heading in the help, of options without one of their own.
    const HEADING: Option<&str> = None;

    /// All options, each with the names of the formats or layers that have it.
    fn options() -> Vec<(&'static OptionSpec, Vec<&'static str>)>;
}

/// The formats.
#[derive(Debug, Clone, Default)]
pub struct Formats;

impl Declares for Formats {
    const HEADING: Option<&str> = Some("Format options [formats that take them]");

    fn options() -> Vec<(&'static OptionSpec, Vec<&'static str>)> {
        let names = |(spec, formats): (_, Vec<&orogen::export::Format>)| {
            (spec, formats.iter().map(|format| format.name).collect())
        };
        registry::options().into_iter().map(names).collect()
    }
}

/// The layers that follow from the heights.
#[derive(Debug, Clone, Default)]
pub struct Layers;

impl Declares for Layers {
    const HEADING: Option<&str> = Some("Layer options [layers that take them]");

    fn options() -> Vec<(&'static OptionSpec, Vec<&'static str>)> {
        list::options()
    }
}

/// The options of a job.
macro_rules! jobs {
    ($($job:ident),*) => { $(
        impl Declares for $job {
            fn options() -> Vec<(&'static OptionSpec, Vec<&'static str>)> {
                $job::OPTIONS.iter().map(|spec| (spec, Vec::new())).collect()
            }
        }
    )* };
}

jobs!(
    MapJob,
    RenderJob,
    BlocksJob,
    TilemapJob,
    NoiseJob,
    VariantsJob,
    BuildSpec,
    GrowJob,
    RefineJob,
    AnalyzeJob,
    LocateJob,
    FitJob,
    EngineJob
);

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
    /// The words of a command line that gives the same options, each after a space.
    pub fn words(&self) -> String {
        let word = |(name, text): &(&str, String)| match text.as_str() {
            "" => format!(" --{name}"),
            // A separate word would be read as another option.
            text if text.starts_with('-') => format!(" --{name}={}", quoted(text)),
            text => format!(" --{name} {}", quoted(text)),
        };
        self.given.iter().map(word).collect()
    }

    /// The options, as the library takes them.
    ///
    /// # Errors
    /// If a value is not valid.
    pub fn read(&self) -> orogen::Result<Options> {
        let specs = D::options().into_iter().map(|(spec, _)| spec);
        Options::of(specs, self.given.iter().map(|(name, text)| (*name, text.as_str())))
    }
}

impl<D: Declares> clap::Args for OptionsOf<D> {
    fn augment_args(command: Command) -> Command {
        D::options().into_iter().fold(command, |command, (spec, known)| command.arg(arg(spec, &known, D::HEADING)))
    }

    fn augment_args_for_update(command: Command) -> Command {
        OptionsOf::<D>::augment_args(command)
    }
}

/// The argument for an option; `known` are the formats or layers that have it.
fn arg(spec: &'static OptionSpec, known: &[&str], heading: Option<&'static str>) -> Arg {
    let about = match known {
        [] => spec.about.to_owned(),
        known => format!("{} [{}]", spec.about, known.join(", ")),
    };
    let own = Some(spec.heading).filter(|heading| !heading.is_empty());
    let arg = Arg::new(spec.name).long(spec.name).help(about).help_heading(own.or(heading));
    // Common alternative spellings are accepted.
    let arg = match (spec.name, spec.aliases) {
        ("color", []) => arg.aliases(["colors", "colour", "colours"]),
        (_, aliases) => arg.aliases(aliases),
    };
    let arg = arg.conflicts_with_all(spec.excludes);
    let arg = match spec.condition {
        Condition::Given(other) => arg.requires(other),
        Condition::Always | Condition::Is(..) | Condition::IsNot(..) | Condition::IsFile(..) => arg,
    };
    if spec.kind == ValueKind::Nothing {
        return arg.action(ArgAction::SetTrue);
    }
    let arg = arg.value_name(spec.value);
    let arg = if spec.default.is_empty() { arg } else { arg.default_value(spec.default) };
    let checked = move |text: &str| spec.check(text).map(|()| text.to_owned());
    match spec.kind {
        ValueKind::Choice(choices) => arg.ignore_case(true).value_parser(words(choices)),
        ValueKind::Automatic => {
            arg.num_args(0..=1).default_missing_value("auto").allow_negative_numbers(true).value_parser(checked)
        }
        ValueKind::Whole(..) | ValueKind::Number(..) | ValueKind::Positive | ValueKind::Size(..) => {
            arg.allow_negative_numbers(true).value_parser(checked)
        }
        ValueKind::Numbers | ValueKind::Range | ValueKind::Point | ValueKind::Tuple(..) => {
            arg.allow_hyphen_values(true).value_parser(checked)
        }
        // Lists of heights and letters may begin with a minus.
        ValueKind::Text if !known.is_empty() => arg.allow_hyphen_values(true).value_parser(checked),
        _ => arg.value_parser(checked),
    }
}

fn words(choices: &'static [Choice]) -> ValueParser {
    let words = choices.iter().map(|choice| clap::builder::PossibleValue::new(choice.name).help(choice.about));
    PossibleValuesParser::new(words).into()
}

impl<D: Declares> clap::FromArgMatches for OptionsOf<D> {
    fn from_arg_matches(matches: &ArgMatches) -> Result<OptionsOf<D>, clap::Error> {
        let mut given = Vec::new();
        for (spec, _) in D::options() {
            if matches.value_source(spec.name) != Some(ValueSource::CommandLine) {
                continue;
            }
            match spec.kind {
                ValueKind::Nothing => given.push((spec.name, String::new())),
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
