//! The layer `insolation`.

use super::appended::Appended;
use super::layer::{Derived, Made, NodeLayer};
use crate::options::{OptionSpec, ValueKind};
use orogen_engine::solver::Insolation;
use orogen_grid::error::{Error, ErrorKind, Result};
use orogen_io::dem::latitude;

/// Option for a single day.
const DAY: OptionSpec = OptionSpec::new("day", "N", ValueKind::Whole(1, 365))
    .with_about("Day of the year for insolation, 1 to 365 [default: the whole year]");

/// Option for a season.
const SEASON: OptionSpec =
    OptionSpec::new("season", "WHEN", ValueKind::Word(&["spring", "summer", "autumn", "winter"])).with_about(
        "Season for insolation, from equinox to solstice or solstice to equinox at the latitude: spring, summer, \
             autumn or winter",
    );

/// The time step of a single day, in hours. Over a longer period the sunrise varies, which smooths shadows between time
/// steps.
const STEP_OF_A_DAY: f64 = 0.1;

/// Option for the latitude.
const LATITUDE: OptionSpec = OptionSpec::new("latitude", "DEG", ValueKind::Number(-90.0, 90.0))
    .with_about("Latitude in degrees, positive in the north [default: that of a file of heights, else 45]");

/// Option for the turbidity of the air.
const TURBIDITY: OptionSpec = OptionSpec::new("turbidity", "T", ValueKind::Number(1.0, 10.0))
    .with_about("Linke turbidity of the air: 1 clean and dry, 6 hazy [default: 3]");

/// The first and the last day of each season of the northern hemisphere.
const SEASONS: [(&str, [f64; 2]); 4] =
    [("spring", [79.0, 171.0]), ("summer", [172.0, 265.0]), ("autumn", [266.0, 354.0]), ("winter", [355.0, 78.0])];

/// The layer.
pub static LAYER: Derived = Derived {
    name: "insolation",
    about: "insolation: solar energy on an average day under a clear sky, in kWh/m^2: direct, diffuse and reflected, with cast shadows",
    palette: "inferno",
    options: || &[DAY, SEASON, LATITUDE, TURBIDITY],
    made: Made::Nodes(
        NodeLayer::new(|to| {
            let (options, defaults) = (to.options(), Insolation::default());
            let latitude =
                options.number(LATITUDE.name).unwrap_or_else(|| latitude_of(to).unwrap_or(defaults.latitude));
            let step = if options.has(DAY.name) { STEP_OF_A_DAY } else { defaults.step };
            let node = Insolation {
                source: to.heights(),
                latitude,
                days: days(to, latitude)?.unwrap_or(defaults.days),
                step,
                turbidity: options.number(TURBIDITY.name).unwrap_or(defaults.turbidity),
                ..defaults
            };
            Ok(to.add(node).layer("energy"))
        })
        .bounded(),
    ),
};

/// The chosen first and last day; `None` by default.
fn days(to: &Appended, latitude: f64) -> Result<Option<[f64; 2]>> {
    match (to.options().whole(DAY.name), to.options().word(SEASON.name)) {
        (Some(_), Some(_)) => {
            Err(Error::new(ErrorKind::Request, "--day and --season exclude each other; leave out one of them"))
        }
        (Some(day), None) => Ok(Some([day as f64; 2])),
        (None, Some(season)) => {
            let north = SEASONS.iter().position(|(name, _)| *name == season);
            // In the southern hemisphere seasons are shifted by half a year.
            Ok(north.map(|k| SEASONS[if latitude < 0.0 { (k + 2) % 4 } else { k }].1))
        }
        (None, None) => Ok(None),
    }
}

/// The latitude of the center of the world, if its heights are a real place and its map has a latitude.
fn latitude_of(to: &Appended) -> Option<f64> {
    let size = to.recipe().world.size?;
    latitude::latitude(&to.recipe().georeference()?, size[0] / 2.0, size[1] / 2.0)
}
