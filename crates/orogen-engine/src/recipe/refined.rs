//! A recipe that refines a real place.

use super::document::Recipe;
use orogen_grid::error::{Error, ErrorKind, Result};
use orogen_grid::words::number;
use orogen_ops::declare::Input;
use orogen_ops::field::Expr;
use orogen_ops::filter::{Blur, Slope, SlopeUnit};
use orogen_ops::levelled::{Amplify, Learned};
use orogen_ops::solver::{Bake, Breach, Drainage};

/// Margin around the place in which its rivers are solved, in cells of the place, so that they leave the domain outside
/// of the visible area.
const MARGIN: f64 = 16.0;

/// Maximum number of halvings of the place's cell. Slopes at smaller cells do not follow the laws of rivers.
const MAX_HALVINGS: f64 = 8.0;

/// Maximum depth of a channel through the rim of a depression, in metres. If it would be deeper, the river runs over
/// the rim.
const DEEPEST: f64 = 100.0;

/// Number of steps that correct the heights. Fewer steps leave larger errors, more steps flatten the new slopes.
const CORRECTIONS: usize = 3;
/// Radius of the blur of each correction, in cells of the place. A larger radius leaves larger errors, a smaller one
/// flattens the new slopes.
const CORRECTION_RADIUS: f64 = 0.5;

/// Uplift over erodibility for which `amplify` makes slopes like the place's. It is the law S = s t / (s + t) with s =
/// 0.25 U A^-0.45 (A in km^2) and t = 0.9, solved for U. The factor is 6 instead of 4 because slopes at a large cell
/// are gentler. The slope has a lower limit because the ground may be level, and an upper limit because the law has no
/// solution for S >= t.
const UPLIFT: &str = "log(6 * max(slope, 0.003) / (1 - min(slope / 0.9, 0.7)) * pow(flow * 1e-6, 0.45))";

/// Factor of the width of valley floors. It is small because the heights of the place have the wide floors already.
const FLOORS: f64 = 0.2;

/// How the detail of a refined place is made.
#[derive(Debug, Clone, Default, PartialEq)]
pub enum Detail {
    /// The rivers of the place are continued at the smaller cell. Side valleys and slopes are added between them, as
    /// steep as the slopes of the place. The difference to the place's heights is then corrected smoothly.
    #[default]
    Rivers,
    /// A network that has learned from real land adds its detail, by the op `learned`; then the depressions are drained
    /// over the whole place.
    Learned {
        /// How much of the detail is chance: 0 makes the most likely heights, 1 the look of real land.
        noise: f64,
        /// Path of a file with another network; empty for the one that is part of Orogen.
        network: String,
    },
}

impl Recipe {
    /// Refines a real place, a recipe of [`Recipe::from_dem`], to a smaller cell. The outputs are `height` and `flow`,
    /// which is solved from `height` if it is read.
    ///
    /// # Errors
    /// If the recipe is not a place, or the cell is not smaller than the place's cell, or is too small.
    pub fn refine_place(&mut self, cell: f64, detail: &Detail) -> Result<()> {
        let coarse = self.world.cell;
        let Some((_, Input::Node(place))) = self.output_inputs().iter().find(|(name, _)| name == "height").cloned()
        else {
            return Err(Error::new(ErrorKind::Internal, "the recipe to refine is not a place"));
        };
        let halvings = libm::log2(coarse / cell).round();
        if !(1.0..=MAX_HALVINGS).contains(&halvings) {
            let (most, least) = (coarse / 2.0, coarse / libm::pow(2.0, MAX_HALVINGS));
            return Err(Error::new(
                ErrorKind::Request,
                format!(
                    "heights with a cell of {} m can be refined to cells of {} to {} m, not {} m",
                    number(coarse),
                    number(least),
                    number(most),
                    number(cell)
                ),
            ));
        }
        self.world.cell = cell;
        self.about = format!("{}, refined from a cell of {} m", self.about, number(coarse));
        let heights = match detail {
            Detail::Rivers => self.continue_rivers(&place, coarse, halvings),
            Detail::Learned { noise, network } => self.add_learned_detail(&place, coarse, halvings, *noise, network),
        };
        self.add("drainage", Drainage { source: heights.as_str().into(), ..Drainage::default() });
        self.set_outputs(vec![("height".into(), heights.as_str().into()), ("flow".into(), "drainage.flow".into())]);
        Ok(())
    }

    /// Adds the nodes of [`Detail::Learned`]; returns the one of the heights.
    fn add_learned_detail(&mut self, place: &str, coarse: f64, halvings: f64, noise: f64, network: &str) -> String {
        let cell = coarse / libm::pow(2.0, halvings);
        let weights = network.into();
        let learned =
            Learned { source: place.into(), cell, halvings: halvings as u32, noise, weights, ..Learned::default() };
        self.add("learned", learned);
        self.add("drained", Breach { source: "learned".into(), deepest: DEEPEST, ..Breach::default() });
        "drained".to_string()
    }

    /// Adds the nodes of [`Detail::Rivers`]; returns the one of the heights.
    fn continue_rivers(&mut self, place: &str, coarse: f64, halvings: f64) -> String {
        let margin = MARGIN * coarse;
        self.add(
            "drained",
            Breach { source: place.into(), deepest: DEEPEST, cell: coarse, margin, ..Breach::default() },
        );
        self.add("rivers", Drainage { source: "drained".into(), cell: coarse, margin, ..Drainage::default() });
        self.add("slope", Slope { source: "drained".into(), unit: SlopeUnit::Ratio });
        self.add("steepness_here", Expr::new(UPLIFT).with("flow", "rivers.flow"));
        self.add("steepness_around", Blur { source: "steepness_here".into(), radius: coarse });
        self.add("steepness", Bake { source: "steepness_around".into(), cell: coarse, margin });
        self.add("uplift", Expr::new("exp(steepness)"));
        let refined = Amplify {
            source: "rivers.filled".into(),
            flow: "rivers.flow".into(),
            receiver: "rivers.receiver".into(),
            uplift: "uplift".into(),
            floor_factor: FLOORS.into(),
            cell: coarse / libm::pow(2.0, halvings),
            halvings: halvings as u32,
            creep: 1.2,
            variation: 0.75,
            jitter: 0.0,
            ..Amplify::default()
        };
        self.add("refined", refined);
        let mut heights = "refined.surface".to_string();
        for step in 1..=CORRECTIONS {
            let [error, change, corrected] = ["error", "change", "corrected"].map(|name| format!("{name}{step}"));
            // Channels through rims are kept. Filled depressions are restored, because the place has them.
            let error_of = Expr::new("min(drained, place) - heights").with("place", place);
            self.add(&error, error_of.with("heights", heights.as_str()));
            self.add(&change, Blur { source: error.as_str().into(), radius: CORRECTION_RADIUS * coarse });
            self.add(
                &corrected,
                Expr::new("heights + change").with("heights", heights.as_str()).with("change", change.as_str()),
            );
            heights = corrected;
        }
        heights
    }
}
