//! The recipe that refines a real place.

use super::document::Recipe;
use orogen_grid::error::{Error, ErrorKind, Result};
use orogen_grid::words::number;
use orogen_ops::declare::Input;
use orogen_ops::field::Expr;
use orogen_ops::filter::{Blur, Slope, SlopeUnit};
use orogen_ops::levelled::Amplify;
use orogen_ops::solver::{Bake, Breach, Drainage};

/// Cells of the place beyond its edge that its rivers are solved for, so that they leave outside what is seen.
const MARGIN: f64 = 16.0;

/// The most halvings of the place's cell. Slopes below follow other laws than those of rivers.
const MAX_HALVINGS: f64 = 8.0;

/// Maximum depth, in metres, of a channel through the rim of a depression. Rivers of deeper ones run over the rim.
const DEEPEST: f64 = 100.0;

/// Steps that correct the heights, and the radius of each as a share of the place's cell: fewer or wider ones leave
/// larger errors, more or narrower ones flatten the new slopes.
const CORRECTIONS: usize = 3;
const CORRECTION_RADIUS: f64 = 0.5;

/// Uplift over erodibility of which `amplify` makes slopes like those of the place: its law S = s t / (s + t) with s =
/// 0.25 U A^-0.45 (A in km^2) and t = 0.9, solved for U. The factor 6 instead of 4 balances that slopes at a large cell
/// are gentler. Gentle ground needs a limit because it may be level, steep ground because the law has no solution from
/// t on.
const UPLIFT: &str = "log(6 * max(slope, 0.003) / (1 - min(slope / 0.9, 0.7)) * pow(flow * 1e-6, 0.45))";

/// Factor of the width of valley floors. Wide floors are in the heights of the place.
const FLOORS: f64 = 0.2;

impl Recipe {
    /// Refines a real place, the recipe of [`Recipe::from_dem`], to a smaller cell: the rivers of its heights are led
    /// through smaller cells, side valleys and slopes grow between them that are as steep as those of the place, and
    /// what the heights then differ from those of the place is corrected smoothly. The outputs are `height` and, solved
    /// from it if it is read, `flow`.
    ///
    /// # Errors
    /// If the recipe is not a place, or the cell is not smaller than its cell or too small.
    pub fn refine_place(&mut self, cell: f64) -> Result<()> {
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
        let margin = MARGIN * coarse;
        self.add(
            "drained",
            Breach { source: place.as_str().into(), deepest: DEEPEST, cell: coarse, margin, ..Breach::default() },
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
            // Channels through rims stay. Depressions that were filled do not: the place has them.
            let error_of = Expr::new("min(drained, place) - heights").with("place", place.as_str());
            self.add(&error, error_of.with("heights", heights.as_str()));
            self.add(&change, Blur { source: error.as_str().into(), radius: CORRECTION_RADIUS * coarse });
            self.add(
                &corrected,
                Expr::new("heights + change").with("heights", heights.as_str()).with("change", change.as_str()),
            );
            heights = corrected;
        }
        self.add("drainage", Drainage { source: heights.as_str().into(), ..Drainage::default() });
        self.set_outputs(vec![("height".into(), heights.as_str().into()), ("flow".into(), "drainage.flow".into())]);
        Ok(())
    }
}
