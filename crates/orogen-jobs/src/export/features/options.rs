//! Options of vector features, and defaults from the recipe's own water.

use super::outlets::{OUTLET, OUTLETS, Outlets, SNAP};
use crate::export::contour_options;
use crate::options::{OptionSpec, Options, ValueKind};
use orogen_engine::node::Node;
use orogen_engine::recipe::document::Recipe;
use orogen_grid::error::Result;
use orogen_grid::hydrology::rivers::Channel;

/// `--river-area`.
pub const RIVER_AREA: OptionSpec = OptionSpec::new("river-area", "M2", ValueKind::Number(0.0, 1e15))
    .with_about("Minimum drainage area of rivers in m^2 [default: the recipe's, else 1000000, at least 32 samples]");

/// `--lake-area`.
pub const LAKE_AREA: OptionSpec = OptionSpec::new("lake-area", "M2", ValueKind::Number(0.0, 1e15))
    .with_about("Minimum area of lakes in m^2 [default: the recipe's, else 20000, at least 4 samples]");

/// `--runoff`.
pub const RUNOFF: OptionSpec = OptionSpec::new("runoff", "M", ValueKind::Number(0.0, 1000.0))
    .with_about("Runoff in metres per year, for discharges and widths [default: the recipe's, else 0.5]");

/// `--prominence`.
pub const PROMINENCE: OptionSpec = OptionSpec::new("prominence", "M", ValueKind::Number(0.0, 1e6))
    .with_about("Minimum prominence of summits in metres [default: 1/25 of the relief]");

/// The options of formats that hold vector features.
pub const OPTIONS: &[OptionSpec] = &[
    contour_options::INTERVAL,
    contour_options::LEVELS,
    contour_options::SMOOTH,
    RIVER_AREA,
    LAKE_AREA,
    RUNOFF,
    PROMINENCE,
    OUTLET,
    OUTLETS,
    SNAP,
];

/// The names of the options that affect water.
pub const WATER: &[&str] = &[RIVER_AREA.name, LAKE_AREA.name, RUNOFF.name, contour_options::SMOOTH.name];

/// Default number of smoothing rounds, for rivers and for shores and watersheds.
const ROUNDS: [usize; 2] = [3, 1];

/// The options in effect.
pub struct FeatureOptions<'a> {
    /// The options as given.
    pub given: &'a Options,
    /// Minimum drainage area of a river, in m^2, and minimum number of samples.
    pub river: (f64, u32),
    /// Minimum area of a lake, in m^2.
    pub lake: f64,
    /// Whether there is a sea.
    pub sea: bool,
    /// Width and depth of rivers.
    pub channel: Channel,
    /// The chosen outlets of watersheds.
    pub outlets: Option<Outlets>,
}

/// Minimum number of samples that drain to a source, unless a drainage area is given.
const FEWEST: u32 = 32;

impl<'a> FeatureOptions<'a> {
    /// The given values; if there are none, the values of the recipe's own water, or the defaults.
    ///
    /// # Errors
    /// If options contradict each other, or a file of outlets cannot be read.
    pub fn new(given: &'a Options, recipe: &Recipe) -> Result<FeatureOptions<'a>> {
        contour_options::check(given)?;
        let mut options = FeatureOptions {
            given,
            river: (1e6, FEWEST),
            lake: 2e4,
            sea: true,
            channel: Channel::default().with_runoff(0.5).with_width(5.0).with_depth(0.3),
            outlets: Outlets::of(given, recipe)?,
        };
        for named in recipe.nodes() {
            match &named.node {
                Node::Drainage(node) => {
                    options.river = (node.stream, 1);
                    options.sea = node.sea;
                }
                Node::Rivers(node) => {
                    options.river = (node.stream, 1);
                    options.channel =
                        Channel::default().with_runoff(node.runoff).with_width(node.width).with_depth(node.depth);
                    options.sea = node.sea;
                }
                Node::Lakes(node) => {
                    options.lake = node.smallest;
                    options.sea = node.sea;
                }
                _ => {}
            }
        }
        if let Some(area) = given.number(RIVER_AREA.name) {
            options.river = (area, 1);
        }
        options.lake = given.number(LAKE_AREA.name).unwrap_or(options.lake);
        options.channel.runoff = given.number(RUNOFF.name).unwrap_or(options.channel.runoff);
        Ok(options)
    }

    /// Minimum number of samples of this cell that drain to a source, and minimum number of samples of a lake.
    #[must_use]
    pub fn fewest(&self, cell: f64) -> [u32; 2] {
        let samples =
            |area: f64, fewest: u32| (area / (cell * cell)).ceil().clamp(f64::from(fewest), f64::from(u32::MAX)) as u32;
        [samples(self.river.0, self.river.1.max(1)), samples(self.lake, 4)]
    }

    /// Number of smoothing rounds of rivers, and of the borders of polygons.
    #[must_use]
    pub fn rounds(&self) -> [usize; 2] {
        self.given.whole(contour_options::SMOOTH.name).map_or(ROUNDS, |rounds| [rounds as usize; 2])
    }
}
