//! A real place at a smaller cell.

use crate::options::{Choice, Condition, OptionSpec, Options, ValueKind};
use orogen_engine::levelled::Learned;
use orogen_engine::recipe::{Detail, Recipe};
use orogen_grid::error::Result;
use orogen_grid::learned::MAX_NOISE;

/// A real place at a smaller cell: [`prepare`](RefineJob::prepare) its recipe, then request any layer of its world.
#[derive(Debug, Clone, Default, PartialEq)]
#[non_exhaustive]
pub struct RefineJob {
    /// How detail is made.
    pub detail: Detail,
}

/// The word for [`Detail::Rivers`].
const RIVERS: &str = "rivers";
/// The word for [`Detail::Learned`].
const LEARNED: &str = "learned";

const HOW: &[Choice] = &[
    Choice::new(RIVERS, "The rivers of the file are continued, and valleys and slopes are added between them"),
    Choice::new(
        LEARNED,
        "A network that learned from real land adds what such land has at the smaller cell, and depressions are drained",
    ),
];

const OPTIONS: &[OptionSpec] = &[
    OptionSpec::new("detail", "HOW", ValueKind::Choice(HOW)).with_about("How detail is made").with_default(RIVERS),
    OptionSpec::new("noise", "SHARE", ValueKind::Number(0.0, MAX_NOISE))
        .with_about(
            "How much of learned detail is chance, from 0 (the most likely heights) to 1 (the look of real land) and 2",
        )
        .with_default("1")
        .when(Condition::Is("detail", &[LEARNED])),
    OptionSpec::new("network", "FILE", ValueKind::File)
        .with_about("File with a network for learned detail [default: the network that is part of Orogen]")
        .when(Condition::Is("detail", &[LEARNED])),
];

/// Number by which the cell is divided if none is given: the halvings up to which the result is about as realistic as
/// real land.
const FINER: f64 = 8.0;

impl RefineJob {
    /// The options, for front ends.
    pub const OPTIONS: &[OptionSpec] = OPTIONS;

    /// The detail that is chosen by [`OPTIONS`](RefineJob::OPTIONS).
    ///
    /// # Errors
    /// If an option does not apply.
    pub fn new(options: &Options) -> Result<RefineJob> {
        options.check(OPTIONS)?;
        let network = options.file("network").map(|file| file.display().to_string());
        let detail = match options.word("detail") {
            Some(LEARNED) => Detail::Learned {
                noise: options.number("noise").unwrap_or(Learned::default().noise),
                network: network.unwrap_or_default(),
            },
            _ => Detail::Rivers,
        };
        Ok(RefineJob { detail })
    }

    /// Refines a recipe of [`Recipe::from_dem`] to a cell in metres; call it before the world is opened. `None` is an
    /// eighth of the place's cell.
    ///
    /// # Errors
    /// Those of [`Recipe::refine_place`].
    pub fn prepare(&self, recipe: &mut Recipe, cell: Option<f64>) -> Result<()> {
        let cell = cell.unwrap_or(recipe.world.cell / FINER);
        recipe.refine_place(cell, &self.detail)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use orogen_engine::declare::Declared;

    fn job(given: &[(&str, &str)]) -> std::result::Result<RefineJob, String> {
        let options = Options::of(OPTIONS, given.iter().copied());
        options.and_then(|options| RefineJob::new(&options)).map_err(|error| error.to_string())
    }

    #[test]
    fn noise_is_that_of_the_op() {
        let spec = OPTIONS.iter().find(|spec| spec.name == "noise").unwrap();
        let of_op = Learned::default().spec().params.iter().find(|param| param.name == "noise").unwrap();
        assert_eq!(spec.default.parse(), Ok(Learned::default().noise));
        let [low, high] = of_op.range;
        assert_eq!(spec.kind, ValueKind::Number(low, high));
        let learned = |noise| RefineJob { detail: Detail::Learned { noise, network: String::new() } };
        assert_eq!(job(&[("detail", "learned")]), Ok(learned(Learned::default().noise)));
        assert_eq!(job(&[("detail", "learned"), ("noise", "0.5")]), Ok(learned(0.5)));
        assert_eq!(job(&[]), Ok(RefineJob::default()));
        assert_eq!(job(&[("detail", RIVERS)]), Ok(RefineJob::default()));
    }

    #[test]
    fn options_of_learned_detail_need_it() {
        for name in ["noise", "network"] {
            assert_eq!(job(&[(name, "1")]).unwrap_err(), format!("--{name} applies to --detail learned"));
        }
        assert!(job(&[("detail", "fractal")]).unwrap_err().contains("rivers or learned"));
        assert!(job(&[("noise", "3")]).unwrap_err().contains("it must be a number from 0 to 2"));
    }
}
