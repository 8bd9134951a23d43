//! Outlets of watersheds: `--outlet`, `--outlets` and `--snap`.

use crate::options::{OptionSpec, Options, ValueKind};
use orogen_engine::recipe::document::Recipe;
use orogen_grid::error::{Error, ErrorKind, Result};
use orogen_grid::grid::Window;
use orogen_grid::words::number;
use orogen_io::format::dem::Georeference;
use orogen_io::format::points::NamedPoints;

/// `--outlet`.
pub const OUTLET: OptionSpec = OptionSpec::new("outlet", "E,N", ValueKind::Point).with_about(
    "Outlet of a watershed: easting and northing in the CRS of the heights; without a CRS, metres east and \
             north of the world's north-west corner (points south of it are negative)",
);

/// `--outlets`.
pub const OUTLETS: OptionSpec = OptionSpec::new("outlets", "FILE", ValueKind::File).with_about(
    "Outlets of watersheds, in the same coordinates: points of a .csv file (columns x, y and name) or a \
             .geojson file",
);

/// `--snap`.
pub const SNAP: OptionSpec = OptionSpec::new("snap", "M", ValueKind::Number(0.0, 1e6)).with_about(
    "Maximum distance that an outlet is moved to the nearest stream, in metres; streams are those of \
             --river-area; 0 moves none [default: 5 samples]",
);

/// Maximum number of outlets.
const MOST: usize = 1000;

/// The chosen outlets.
#[derive(Debug, Clone, PartialEq)]
pub struct Outlets {
    /// The outlets, in the given order.
    pub all: Vec<Outlet>,
    /// Maximum distance of an outlet to its stream, in metres.
    pub snap: Option<f64>,
    /// The map that the coordinates refer to.
    map: Georeference,
}

/// An outlet.
#[derive(Debug, Clone, PartialEq)]
pub struct Outlet {
    /// The name, if it has one.
    pub name: Option<String>,
    /// The coordinates as given.
    pub given: [f64; 2],
    /// Metres east and south of the world's origin.
    pub at: [f64; 2],
}

impl Outlets {
    /// The outlets that the options give; `None` if there are none.
    ///
    /// # Errors
    /// If outlets are given in two ways, or the file cannot be read or has another coordinate system.
    pub fn of(given: &Options, recipe: &Recipe) -> Result<Option<Outlets>> {
        let map = recipe.georeference();
        let points = match (given.pair(OUTLET.name), given.file(OUTLETS.name)) {
            (None, None) => return Ok(None),
            (Some(_), Some(_)) => {
                let message = "--outlet and --outlets exclude each other; leave out one of them";
                return Err(Error::new(ErrorKind::Request, message));
            }
            (Some(at), None) => vec![(None, at)],
            (None, Some(path)) => {
                let found = NamedPoints::read_on(path, map.as_ref(), "the heights", MOST)?;
                if found.points.is_empty() {
                    let message = format!("{}: it has no points, and outlets are points", path.display());
                    return Err(Error::new(ErrorKind::File, message));
                }
                found.points.into_iter().map(|point| (point.name, point.at)).collect()
            }
        };
        let map = map.unwrap_or(Georeference::LOCAL);
        let all = points.into_iter().map(|(name, given)| Outlet { name, given, at: map.metres(given[0], given[1]) });
        Ok(Some(Outlets { all: all.collect(), snap: given.number(SNAP.name), map }))
    }

    /// Map coordinates of metres east and south of the world's origin.
    #[must_use]
    pub fn coordinates(&self, [east, south]: [f64; 2]) -> [f64; 2] {
        self.map.at(east, south)
    }

    /// The error for an outlet outside a window.
    #[must_use]
    pub fn outside(&self, outlet: &Outlet, window: &Window) -> Error {
        // Squares around samples extend half a cell beyond them.
        let ends = |count: usize| [-0.5, count as f64 - 0.5];
        let ([left, right], [top, bottom]) = (ends(window.width), ends(window.height));
        let place =
            |x: f64, y: f64| self.map.at((window.x as f64 + x) * window.cell, (window.y as f64 + y) * window.cell);
        let ([west, north], [east, south]) = (place(left, top), place(right, bottom));
        let epsg = self.map.epsg().map_or(String::new(), |code| format!(" in EPSG:{code}"));
        let is_degrees = |[east, north]: [f64; 2]| east.abs() <= 180.0 && north.abs() <= 90.0;
        let hint = match self.map.keys.is_some() && !self.map.counts_degrees() && is_degrees(outlet.given) {
            true => "; longitude and latitude must be converted to this CRS first",
            false => "",
        };
        let [west, south, east, north] = [west, south, east, north].map(|at| self.rounded(at));
        outlet.refused(&format!(
            "is outside the window, which extends from {west} to {east} east and from {south} to {north} north{epsg}{hint}"
        ))
    }

    /// A coordinate, with a resolution of about a centimetre.
    fn rounded(&self, at: f64) -> f64 {
        let scale = if self.map.counts_degrees() { 1e7 } else { 1e2 };
        (at * scale).round() / scale
    }
}

impl Outlet {
    /// The error about this outlet, with the reason `why`.
    #[must_use]
    pub fn refused(&self, why: &str) -> Error {
        let name = self.name.as_ref().map_or(String::new(), |name| format!("`{}` ", name.escape_debug()));
        let [east, north] = self.given;
        Error::new(ErrorKind::Request, format!("the outlet {name}at {east},{north} {why}"))
    }

    /// The error about an outlet without a stream that drains `least` m^2 within `snap` metres. `beside` says why there
    /// is none at the outlet itself; the nearest stream is `nearest` metres away.
    #[must_use]
    pub fn far(&self, beside: Option<&str>, least: f64, snap: f64, nearest: Option<f64>) -> Error {
        let next = match nearest {
            Some(metres) => format!("the nearest is {metres:.0} m away (--snap {})", metres.ceil()),
            None => "there is none in the window (--river-area sets the minimum)".into(),
        };
        let why = beside.map_or(String::new(), |beside| format!("{beside}, and "));
        self.refused(&format!(
            "{why}has no stream within {} m that drains at least {} m^2; {next}",
            number(snap),
            number(least)
        ))
    }
}
