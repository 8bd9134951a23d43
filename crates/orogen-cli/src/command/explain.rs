//! `orogen explain`.

use std::path::PathBuf;

use orogen::Recipe;

use crate::failure::Failure;
use crate::options::Limits;
use crate::say;
use crate::source::Source;
use crate::view::SizedView;

/// Arguments of the command.
#[derive(Debug, Clone, clap::Args)]
pub struct Args {
    /// A recipe file, the name of a preset, or a file of heights (GeoTIFF, .asc, .hgt, ...)
    #[arg(default_value = orogen::recipe::presets::DEFAULT)]
    recipe: PathBuf,
    #[command(flatten)]
    samples: SizedView,
    /// The layer to explain [default: all layers]
    #[arg(long, value_name = "L")]
    layer: Option<String>,
    #[command(flatten)]
    limits: Limits,
}

/// Prints the plan.
pub fn run(args: &Args) -> Result<(), Failure> {
    args.samples.each_seed(None, |samples, _| tell(&Args { samples, ..args.clone() }))
}

/// The recipe's parameters, one per line: name, value, unit and range, description.
fn parameters(recipe: &Recipe) -> String {
    let parameters = recipe.parameters();
    if parameters.is_empty() {
        return String::new();
    }
    let values: Vec<String> = parameters
        .iter()
        .map(|parameter| format!("{} {}", parameter.value, parameter.unit).trim_end().into())
        .collect();
    let longest = parameters.iter().map(|parameter| parameter.name.len()).max().unwrap_or(0);
    let widest = values.iter().map(|value| value.chars().count()).max().unwrap_or(0);
    let mut text = String::from("parameters, set by --set NAME=VALUE\n");
    for (parameter, value) in parameters.iter().zip(values) {
        let range = match parameter.range {
            [low, high] if low.is_finite() || high.is_finite() => format!("{low} to {high}"),
            _ => "any number".into(),
        };
        let line = format!("  {:longest$}  {value:widest$}  {range:16}  {}", parameter.name, parameter.help);
        text += &format!("{}\n", line.trim_end());
    }
    text + "\n"
}

fn tell(args: &Args) -> Result<(), Failure> {
    let budget = args.limits.budget();
    let recipe = args.samples.view.recipe(&Source::find(&args.recipe)?, &budget)?;
    let layers: Vec<String> = match &args.layer {
        Some(layer) => vec![layer.clone()],
        None => recipe.outputs().map(String::from).collect(),
    };
    let layers: Vec<&str> = layers.iter().map(String::as_str).collect();
    let world = args.limits.open(recipe, &budget)?;
    let plan = world.plan(&layers, &args.samples.window(&world)?)?;
    say::out(&(parameters(world.recipe()) + &world.explain(&plan)?))
}
