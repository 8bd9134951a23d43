//! The options of a rendered picture.

use super::render::{EXAGGERATION, FOV, HAZE, MAX_SIDE, RenderJob, SAMPLES, SUN, around};
use crate::options::Condition::{Given, Is};
use crate::options::{Choice, Component, OptionSpec, Options, ValueKind};
use orogen_grid::analysis::sun::Moment;
use orogen_grid::error::{Error, ErrorKind, Result};
use orogen_output::render::camera::View;
use orogen_output::render::scene::{Colors, Edge};

const COLORS: &[Choice] = &[
    Choice::new("natural", "Forest, meadow, scree, rock and snow"),
    Choice::new("desert", "Red and yellow rock layers, sand"),
    Choice::new("surfaces", "The recipe's surfaces, or the standard ones: grass, sand, scree, rock, snow, river beds"),
    Choice::new("map", "The colors of the relief map"),
    Choice::new("clay", "Uniform clay"),
];

const EDGES: &[Choice] = &[
    Choice::new("cut", "A block cut out of the land, on a table"),
    Choice::new("haze", "Open sea, or the land mirrored repeatedly until haze hides it"),
];

pub(super) const CAMERA: &[Component] = &[
    Component::new("azimuth", "°", [0.0, 360.0]),
    Component::new("elevation", "°", [0.0, 90.0]),
    Component::new("distance", " m", [0.1, 1e7]),
];

const LIGHT: &[Component] =
    &[Component::new("azimuth", "°", [0.0, 360.0]), Component::new("elevation", "°", [*SUN.start(), *SUN.end()])];

/// The options, in the order of a help.
const OPTIONS: &[OptionSpec] = &[
    OptionSpec::new("size", "WxH", ValueKind::Size(MAX_SIDE))
        .with_about("Size of the picture in pixels")
        .with_default("1920x1080"),
    OptionSpec::new("camera", "A,E[,D]|X,Y,H", ValueKind::Tuple(CAMERA, 2))
        .with_about(
            "Camera position: AZIMUTH,ELEVATION[,DISTANCE] around the center of the land (degrees clockwise from \
             north, degrees above the horizon, metres), or with --look X,Y,HEIGHT in the world's metres [default: \
             200,24 at the distance that shows everything]",
        )
        .with_example("200,24", ["", ""]),
    OptionSpec::new("look", "X,Y", ValueKind::Point)
        .with_about("Point that the camera looks at, in metres east and south; --camera is then a position, too")
        .when(Given("camera")),
    OptionSpec::new("fov", "DEG", ValueKind::Number(*FOV.start(), *FOV.end()))
        .with_about("Field of view along the longer side of the picture, in degrees")
        .with_default("40")
        .with_example("40", ["", "°"]),
    OptionSpec::new("sun", "A,E", ValueKind::Tuple(LIGHT, 2))
        .with_about(
            "Position of the sun: AZIMUTH,ELEVATION, in degrees clockwise from north and above the horizon [default: \
             265,27]",
        )
        .with_example("265,27", ["", ""])
        .without(&["time"]),
    OptionSpec::new("time", "HH:MM", ValueKind::Clock)
        .with_about("Solar time (12:00 is noon) that determines the position of the sun, instead of --sun")
        .with_example("17:30", ["", ""])
        .without(&["sun"]),
    OptionSpec::new("latitude", "DEG", ValueKind::Number(-90.0, 90.0))
        .with_about("Latitude for --time, in degrees; negative in the south [default: 45]")
        .with_example("45", ["", "°"])
        .when(Given("time")),
    OptionSpec::new("day", "N", ValueKind::Whole(1, 366))
        .with_about("Day of the year for --time [default: 172, the June solstice]")
        .with_example("172", ["", ""])
        .when(Given("time")),
    OptionSpec::new("haze", "N", ValueKind::Number(*HAZE.start(), *HAZE.end()))
        .with_about("Density of the haze: 0 is none, 1 is a clear day, higher values are denser")
        .with_default("1")
        .with_example("1", ["", ""]),
    OptionSpec::new("exaggeration", "N", ValueKind::Number(*EXAGGERATION.start(), *EXAGGERATION.end()))
        .with_about("Vertical exaggeration")
        .with_default("1")
        .with_example("1", ["", "×"]),
    OptionSpec::new("edge", "EDGE", ValueKind::Choice(EDGES))
        .with_about("What is shown beyond the edge of the land [default: haze if most of the edge is sea, else cut]"),
    OptionSpec::new("color", "COLOR", ValueKind::Choice(COLORS))
        .with_about("Colors of the ground")
        .with_default("natural")
        .with_aliases(&["colors", "colour", "colours"]),
    OptionSpec::new("snow-line", "M", ValueKind::Number(-1e5, 1e5))
        .with_about("Height of the snow line in metres [default: three fifths of the relief, no snow on low land]")
        .with_example("2000", ["", " m"]),
    OptionSpec::new("samples", "N", ValueKind::Whole(*SAMPLES.start() as u64, *SAMPLES.end() as u64))
        .with_about("Samples per pixel (antialiasing)")
        .with_default("5")
        .with_example("5", ["", ""]),
    OptionSpec::new("palette", "NAME|FILE", ValueKind::Palette)
        .with_about(
            "Palette of --color map: a name or a file (.cpt, .gpl, .toml, gdaldem .txt) [default: that of the relief \
             map]",
        )
        .when(Is("color", &["map"])),
    OptionSpec::switch("nearest-color")
        .with_about(
            "Give each value the color of the nearest stop of the palette, without mixing (as gdaldem's \
             -nearest_color_entry)",
        )
        .when(Given("palette")),
    OptionSpec::new("range", "LOW,HIGH", ValueKind::Range)
        .with_about(
            "Heights at the ends of the palette of --color map, for example to use the same range for several pictures \
             [default: the lowest and the highest]",
        )
        .with_example("0,1000", ["", " m"])
        .when(Is("color", &["map"])),
    OptionSpec::switch("color-bar")
        .with_about("Draw a color bar with the heights of --color map in the lower left corner")
        .with_aliases(&["colour-bar"])
        .when(Is("color", &["map"])),
];

impl RenderJob {
    /// The options, for front ends.
    pub const OPTIONS: &[OptionSpec] = OPTIONS;

    /// The same with all that is chosen by [`OPTIONS`](RenderJob::OPTIONS).
    ///
    /// # Errors
    /// If an option does not apply, a palette cannot be read, or the errors of [`check`](RenderJob::check).
    pub fn with_options(self, options: &Options) -> Result<RenderJob> {
        read(self, options)
    }
}

/// Sets the fields of a job from its options.
fn read(mut job: RenderJob, options: &Options) -> Result<RenderJob> {
    options.check(OPTIONS)?;
    job.size = match options.numbers("size") {
        Some(&[width, height]) => [width as usize, height as usize],
        Some(&[longer]) => [longer as usize, (longer as usize * 9).div_ceil(16)],
        _ => job.size,
    };
    job.view = match (options.numbers("camera"), options.pair("look")) {
        (Some(camera), Some(look)) => at(camera, look)?,
        (Some(camera), None) => around(camera)?,
        (None, _) => job.view,
    };
    job.fov = options.number("fov").unwrap_or(job.fov);
    job.sun = match options.number("time") {
        Some(hour) => {
            let day = options.whole("day").unwrap_or(172) as u16;
            sun(&Moment::new(options.number("latitude").unwrap_or(45.0), day, hour))?
        }
        None => options.pair("sun").unwrap_or(job.sun),
    };
    job.haze = options.number("haze").unwrap_or(job.haze);
    job.exaggeration = options.number("exaggeration").unwrap_or(job.exaggeration);
    job.edge = options.word("edge").map(|word| if word == "cut" { Edge::Cut } else { Edge::Haze });
    job.colors = match options.word("color") {
        Some("desert") => Colors::Desert,
        Some("surfaces") => Colors::Surfaces,
        Some("map") => Colors::Map,
        Some("clay") => Colors::Clay,
        _ => Colors::Natural,
    };
    job.snow_line = options.number("snow-line");
    job.samples = options.whole("samples").map_or(job.samples, |samples| samples as u32);
    job.palette = options.palette()?;
    job.range = options.pair("range");
    job.color_bar = options.has("color-bar");
    job.check()?;
    Ok(job)
}

/// The view from a position to a point.
fn at(camera: &[f64], look: [f64; 2]) -> Result<View> {
    let &[x, y, height] = camera else {
        return refuse("with --look, --camera must be X,Y,HEIGHT in metres, such as 2000,9000,1500".into());
    };
    if [x, y] == look {
        return refuse(format!(
            "the camera is directly above the point that it looks at ({x},{y}, from a height of {height} m); move one \
             of them"
        ));
    }
    Ok(View::At { eye: [x, y, height], look })
}

/// The position of the sun at a moment at which it gives light.
fn sun(moment: &Moment) -> Result<[f64; 2]> {
    let sun = moment.sun();
    match (sun[1] >= *SUN.start(), moment.daylight()) {
        (true, _) => Ok(sun),
        (false, Some([rise, set])) => refuse(format!(
            "at {} on day {} at latitude {} the sun is {:.0} degrees below the horizon; it is up from {} to {}",
            hours(moment.hour),
            moment.day,
            moment.latitude,
            -sun[1],
            hours(rise),
            hours(set)
        )),
        (false, None) => refuse(format!("on day {} at latitude {} the sun never rises", moment.day, moment.latitude)),
    }
}

fn hours(hour: f64) -> String {
    let minutes = (hour * 60.0).round() as u32;
    format!("{:02}:{:02}", minutes / 60, minutes % 60)
}

fn refuse<T>(message: String) -> Result<T> {
    Err(Error::new(ErrorKind::Request, message))
}
