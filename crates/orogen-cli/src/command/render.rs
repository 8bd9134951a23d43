//! `orogen render`.

use std::path::{Path, PathBuf};

use clap::ValueEnum;
use orogen::analysis::sun::Moment;
use orogen::file;
use orogen::format::png::Animation;
use orogen::jobs::render::{EXAGGERATION, FOV, HAZE, MAX_SIDE, RenderJob, Rendering, SUN};
use orogen::render::camera::View as Shot;
use orogen::render::scene::{Colors, Edge};
use orogen::words::count;

use crate::bar::Bar;
use crate::device::DeviceOption;
use crate::failure::Failure;
use crate::moving::{AnimationTarget, Moving};
use crate::options::RunOptions;
use crate::sink::{Sink, is_stdout};
use crate::source::Source;
use crate::values::number::{Numbers, not_negative, positive};
use crate::values::size::Size;
use crate::values::time::clock;
use crate::view::View;
use crate::{interrupt, palette, say};

/// Arguments of the command.
#[derive(Debug, Clone, clap::Args)]
#[command(
    after_help = "Unless --device says otherwise, the processor draws, and the picture has the same bytes on every machine. Grain finer than the \
                        world's samples is made up by the picture; heights, shadows and outlines are the world's own."
)]
pub struct Args {
    /// A recipe file, the name of a preset, or a file of heights (GeoTIFF, .asc, .hgt, ...)
    recipe: PathBuf,
    /// Output picture (.png); with --turntable also a .gif, or a file for each frame such as view-%03d.png
    #[arg(short, long, value_name = "FILE", default_value = "view.png")]
    out: PathBuf,
    /// Size of the picture in pixels
    #[arg(long, value_name = "WxH", default_value = "1920x1080", allow_negative_numbers = true)]
    size: Size,
    /// Camera position: AZIMUTH,ELEVATION[,DISTANCE] around the centre of the land (degrees clockwise from north, degrees above the
    /// horizon, metres), or with --look X,Y,HEIGHT in the world's metres [default: 200,24 at the distance that shows everything]
    #[arg(long, value_name = "A,E[,D]|X,Y,H", allow_hyphen_values = true)]
    camera: Option<Numbers>,
    /// Point that the camera looks at, in metres east and south; --camera is then a position, too
    #[arg(long, value_name = "X,Y", requires = "camera", allow_hyphen_values = true)]
    look: Option<Numbers>,
    /// Field of view along the longer side of the picture, in degrees
    #[arg(long, value_name = "DEG", value_parser = positive, default_value = "40", allow_negative_numbers = true)]
    fov: f64,
    /// Position of the sun: AZIMUTH,ELEVATION, in degrees clockwise from north and above the horizon [default: 265,27]
    #[arg(long, value_name = "A,E", conflicts_with = "time", allow_hyphen_values = true)]
    sun: Option<Numbers>,
    /// Solar time (12:00 is noon) that determines the position of the sun, instead of --sun
    #[arg(long, value_name = "HH:MM", value_parser = clock)]
    time: Option<f64>,
    /// Latitude for --time, in degrees; negative in the south [default: 45]
    #[arg(long, value_name = "DEG", requires = "time", allow_negative_numbers = true)]
    latitude: Option<f64>,
    /// Day of the year for --time [default: 172, the June solstice]
    #[arg(long, value_name = "N", requires = "time", value_parser = clap::value_parser!(u16).range(1..=366),
          allow_negative_numbers = true)]
    day: Option<u16>,
    /// Density of the haze: 0 is none, 1 is a clear day, higher values are denser
    #[arg(long, value_name = "N", value_parser = not_negative, default_value = "1", allow_negative_numbers = true)]
    haze: f64,
    /// Vertical exaggeration
    #[arg(long, value_name = "N", value_parser = positive, default_value = "1", allow_negative_numbers = true)]
    exaggeration: f64,
    /// What is shown beyond the edge of the land [default: haze if most of the edge is sea, else cut]
    #[arg(long)]
    edge: Option<Ends>,
    /// Colours of the ground
    #[arg(long, aliases = ["colors", "colour", "colours"], value_enum, default_value_t = Dress::Natural)]
    color: Dress,
    /// Height of the snow line in metres [default: three fifths of the relief, no snow on low land]
    #[arg(long, value_name = "M", allow_negative_numbers = true)]
    snow_line: Option<f64>,
    /// Samples per pixel (antialiasing)
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=256), default_value = "5",
          allow_negative_numbers = true)]
    samples: u32,
    /// Orbit the camera around the land in N frames: an animated .png (APNG), a .gif, or a file for each frame
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(2..=3600), conflicts_with = "look",
          allow_negative_numbers = true)]
    turntable: Option<u32>,
    /// Duration of each frame, in milliseconds
    #[arg(long, value_name = "MS", default_value = "60", requires = "turntable")]
    delay: u16,
    /// Palette of --color map: a name or a file (.cpt, .gpl, .toml, gdaldem .txt) [default: that of the relief map]
    #[arg(long, value_name = "NAME|FILE")]
    palette: Option<PathBuf>,
    /// Give each value the color of the nearest stop of the palette, without mixing (as gdaldem's -nearest_color_entry)
    #[arg(long, requires = "palette")]
    nearest_color: bool,
    /// Heights at the ends of the palette of --color map, for example to use the same range for several pictures [default: the lowest and the
    /// highest]
    #[arg(long, value_name = "LOW,HIGH", allow_hyphen_values = true)]
    range: Option<Numbers>,
    /// Draw a colour bar with the heights of --color map in the lower left corner
    #[arg(long, aliases = ["colour-bar"])]
    color_bar: bool,
    #[command(flatten)]
    view: View,
    #[command(flatten)]
    device: DeviceOption,
    #[command(flatten)]
    run: RunOptions,
}

/// `--edge`.
#[derive(Debug, Clone, Copy, ValueEnum)]
enum Ends {
    /// A block cut out of the land, on a table
    Cut,
    /// Open sea, or the land mirrored repeatedly until haze hides it
    Haze,
}

/// `--color`.
#[derive(Debug, Clone, Copy, ValueEnum)]
enum Dress {
    /// Forest, meadow, scree, rock and snow
    Natural,
    /// Red and yellow rock layers, sand
    Desert,
    /// The recipe's surfaces, or the standard ones: grass, sand, scree, rock, snow, river beds
    Surfaces,
    /// The colours of the relief map
    Map,
    /// Uniform clay
    Clay,
}

/// Renders the picture.
pub fn run(args: &Args) -> Result<(), Failure> {
    args.view.each_output(&args.out, |view, out| render(&Args { view, out, ..args.clone() }))
}

fn render(args: &Args) -> Result<(), Failure> {
    let target = match args.turntable {
        Some(_) => AnimationTarget::of(&args.out).map_err(Failure::Usage)?,
        None if is_stdout(&args.out) => AnimationTarget::Apng,
        None if args.out.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("png")) => {
            AnimationTarget::Apng
        }
        None => {
            let message = format!("a view is written as PNG; use the extension .png instead of {}", args.out.display());
            return Err(Failure::Usage(message + ", or write frames with --turntable"));
        }
    };
    let mut job = job(args)?;
    let source = Source::find(&args.recipe)?;
    let budget = args.run.limits.budget();
    let mut recipe = args.view.recipe(&source, &budget)?;
    let policy = args.run.replace.policy(source.inputs(&recipe)).protecting(&args.palette);
    let outputs = target.outputs(&args.out, args.turntable.unwrap_or(1), &policy)?;
    job.prepare(&mut recipe)?;
    let (world, card) = args.device.open(&args.run.limits, recipe, &budget)?;
    job.device = card.render_device();
    job.window = Some(args.view.window(&world)?);
    let folder = args.out.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    file::check_folder(folder)?;
    let (bar, progress) = Bar::new(args.run.quiet);
    let pixels = (job.size[0] * job.size[1]) as u64;
    let made = job
        .scene(&world, pictures(args, &target), target.reserved(pixels), &progress)
        .map_err(Failure::from)
        .and_then(|rendering| {
            let words = write(args, &rendering, &target, &outputs)?;
            let card = card.used_with(rendering.refused());
            Ok(words + &card.map_or(String::new(), |card| format!(", on {card}")))
        });
    drop(bar);
    let words = made.map_err(|failure| interrupt::explain(failure, "nothing was written"))?;
    outputs[0].tell(args.run.quiet, &format!("{}: {words}\n", args.out.display()))
}

/// What the arguments ask for, without the window.
fn job(args: &Args) -> Result<RenderJob, Failure> {
    let usage = |message: String| Err(Failure::Usage(message));
    let mut job = RenderJob::default();
    job.size = match args.size {
        Size::Longer(n) => [n, (n * 9).div_ceil(16)],
        Size::Both(width, height) => [width, height],
    };
    let [width, height] = job.size;
    if width.max(height) > MAX_SIDE {
        return usage(format!(
            "a picture of {width} x {height} pixels is too large; a side may have at most {MAX_SIDE} pixels"
        ));
    }
    job.palette = palette::chosen(args.palette.as_deref(), args.nearest_color)?;
    if job.palette.is_some() && !matches!(args.color, Dress::Map) {
        return usage("--palette applies to --color map".into());
    }
    job.range = match args.range.as_ref().map(|range| range.0.as_slice()) {
        None => None,
        Some(_) if !matches!(args.color, Dress::Map) => return usage("--range applies to --color map".into()),
        Some(&[low, high]) if low < high => Some([low, high]),
        Some(_) => return usage("--range must be two heights, the lower first, such as 0,2500".into()),
    };
    if args.color_bar && !matches!(args.color, Dress::Map) {
        return usage("--color-bar applies to --color map".into());
    }
    job.color_bar = args.color_bar;
    if !FOV.contains(&args.fov) {
        return usage(format!("--fov must be from {} to {} degrees, not {}", FOV.start(), FOV.end(), args.fov));
    }
    if !EXAGGERATION.contains(&args.exaggeration) {
        let (from, to) = (EXAGGERATION.start(), EXAGGERATION.end());
        return usage(format!("--exaggeration must be from {from} to {to}, not {}", args.exaggeration));
    }
    if !HAZE.contains(&args.haze) {
        return usage(format!("--haze must be from {} to {}, not {}", HAZE.start(), HAZE.end(), args.haze));
    }
    if args.snow_line.is_some_and(|line| !line.is_finite()) {
        return usage("--snow-line must be a height in metres, such as 2400".into());
    }
    job.fov = args.fov;
    job.exaggeration = args.exaggeration;
    job.sun = sun(args)?;
    job.haze = args.haze;
    job.edge = args.edge.map(|edge| match edge {
        Ends::Cut => Edge::Cut,
        Ends::Haze => Edge::Haze,
    });
    job.colors = match args.color {
        Dress::Natural => Colors::Natural,
        Dress::Desert => Colors::Desert,
        Dress::Surfaces => Colors::Surfaces,
        Dress::Map => Colors::Map,
        Dress::Clay => Colors::Clay,
    };
    job.snow_line = args.snow_line;
    job.samples = args.samples;
    job.view = shot(args)?;
    Ok(job)
}

/// The position of the sun.
fn sun(args: &Args) -> Result<[f64; 2], Failure> {
    let usage = |message: String| Err(Failure::Usage(message));
    if let Some(hour) = args.time {
        let latitude = args.latitude.unwrap_or(45.0);
        if !(-90.0..=90.0).contains(&latitude) {
            return usage(format!("--latitude must be from -90 to 90 degrees, not {latitude}"));
        }
        let moment = Moment::new(latitude, args.day.unwrap_or(172), hour);
        let sun = moment.sun();
        return match (sun[1] >= *SUN.start(), moment.daylight()) {
            (true, _) => Ok(sun),
            (false, Some([rise, set])) => usage(format!(
                "at {} on day {} at latitude {latitude} the sun is {:.0} degrees below the horizon; it is up from {} to {}",
                hours(hour),
                moment.day,
                -sun[1],
                hours(rise),
                hours(set)
            )),
            (false, None) => usage(format!("on day {} at latitude {latitude} the sun never rises", moment.day)),
        };
    }
    match args.sun.as_ref().map(|sun| sun.0.as_slice()) {
        None => Ok(RenderJob::default().sun),
        Some([azimuth, elevation]) if SUN.contains(elevation) => Ok([*azimuth, *elevation]),
        Some([_, elevation]) => usage(format!(
            "--sun says that it stands at an elevation of {elevation} degrees; it goes from {}, when the last light \
             fades, to {}",
            SUN.start(),
            SUN.end()
        )),
        Some(_) => usage("--sun must be AZIMUTH,ELEVATION in degrees, such as 290,30".into()),
    }
}

fn hours(hour: f64) -> String {
    let minutes = (hour * 60.0).round() as u32;
    format!("{:02}:{:02}", minutes / 60, minutes % 60)
}

/// The view.
fn shot(args: &Args) -> Result<Shot, Failure> {
    let usage = |message: String| Err(Failure::Usage(message));
    let camera = args.camera.as_ref().map(|camera| camera.0.as_slice());
    if let Some(Numbers(look)) = &args.look {
        return match (camera, look.as_slice()) {
            (Some(&[x, y, height]), &[to_x, to_y]) if x == to_x && y == to_y => usage(format!(
                "the camera is directly above the point that it looks at ({x},{y}, from a height of {height} m); move one of them"
            )),
            (Some(&[x, y, height]), &[to_x, to_y]) => Ok(Shot::At { eye: [x, y, height], look: [to_x, to_y] }),
            (_, &[_, _]) => usage("with --look, --camera must be X,Y,HEIGHT in metres, such as 2000,9000,1500".into()),
            _ => usage("--look must be X,Y in metres, such as 5000,5000".into()),
        };
    }
    around(camera)
}

/// The view around the centre of the land.
pub(super) fn around(camera: Option<&[f64]>) -> Result<Shot, Failure> {
    let usage = |message: String| Err(Failure::Usage(message));
    let (azimuth, elevation, distance) = match camera {
        None => return Ok(RenderJob::default().view),
        Some(&[azimuth, elevation]) => (azimuth, elevation, None),
        Some(&[azimuth, elevation, distance]) => (azimuth, elevation, Some(distance)),
        Some(_) => return usage("--camera must be AZIMUTH,ELEVATION[,DISTANCE], such as 200,24".into()),
    };
    if !(-90.0..=90.0).contains(&elevation) {
        return usage(format!(
            "the elevation of --camera must be from -90 to 90 degrees, not {elevation} (with --look, \
             --camera is a position)"
        ));
    }
    if elevation < 0.0 {
        return usage(format!(
            "the elevation of --camera must be above the horizon, not {} degrees below it",
            -elevation
        ));
    }
    match distance.filter(|distance| *distance <= 0.0) {
        Some(distance) => usage(format!("the distance of --camera must be greater than 0 m, not {distance}")),
        None => Ok(Shot::Around { azimuth, elevation, distance }),
    }
}

/// The share of a frame's pixels from which a GIF's colours are taken.
const PREVIEW: f64 = 0.25;

/// How many pictures are painted: those of an animation, and the parts of some for the colours of a GIF.
fn pictures(args: &Args, target: &AnimationTarget) -> f64 {
    match args.turntable {
        None => 1.0,
        Some(frames) => f64::from(frames) + preview(target),
    }
}

fn preview(target: &AnimationTarget) -> f64 {
    if matches!(target, AnimationTarget::Gif) { PREVIEW } else { 0.0 }
}

/// Paints and writes the picture, or the frames of `--turntable`. Returns the end of the final message.
fn write(args: &Args, rendering: &Rendering, target: &AnimationTarget, outputs: &[Sink]) -> Result<String, Failure> {
    for warning in &rendering.warnings {
        say::error(&format!("warning: {warning}"));
    }
    if let (Some(frames), Shot::Around { azimuth, elevation, distance }) = (args.turntable, rendering.spec.view) {
        return turntable(args, rendering, frames, [azimuth, elevation], distance, target, outputs);
    }
    if let (Some(metres), false) = (rendering.lifted(), args.run.quiet) {
        say::error(&format!("note: the camera was below the ground and was raised by {metres:.0} m"));
    }
    outputs[0].write(|out| rendering.to_stream(out))?;
    Ok(rendering.words())
}

/// Writes the frames of an orbit around the land.
fn turntable(
    args: &Args,
    rendering: &Rendering,
    frames: u32,
    [azimuth, elevation]: [f64; 2],
    distance: Option<f64>,
    target: &AnimationTarget,
    outputs: &[Sink],
) -> Result<String, Failure> {
    let Rendering { scene, spec, .. } = rendering;
    let (size, [width, height]) = (spec.size, spec.size);
    let [previewing, painting] = rendering.painting.parts([preview(target), f64::from(frames)]);
    let turn = |frame: u32| azimuth + 360.0 * f64::from(frame) / f64::from(frames);
    let sides = (0..frames).map(|frame| [turn(frame), elevation]);
    // The closest distance at which all frames fit: a changing distance would make the land pulsate.
    let distance = distance.unwrap_or_else(|| scene.distance(sides, spec));
    let view = |frame: u32| Shot::Around { azimuth: turn(frame), elevation, distance: Some(distance) };
    let side = |frame: u32| scene.camera(&spec.with_view(view(frame)));
    // Four small views suffice for the colours.
    let sample = || {
        let small = size.map(|side| side.div_ceil(4));
        previewing.expect(4.0);
        let mut sample = Vec::new();
        for quarter in 0..4 {
            let mut bytes = vec![0; 3 * small[0] * small[1]];
            let part = previewing.part(1.0);
            rendering.paint(&side(quarter * frames / 4), small, 0..small[1], &mut bytes, &part)?;
            sample.append(&mut bytes);
        }
        Ok(sample)
    };
    let animation = Animation::new(frames, args.delay);
    let moving = Moving { outputs, target, picture: rendering.picture(), animation, sample: &sample };
    painting.expect(f64::from(frames));
    moving.write(|frame, bytes| Ok(rendering.paint(&side(frame), size, 0..height, bytes, &painting.part(1.0))?))?;
    let samples = rendering.samples();
    Ok(format!("{} of {width} x {height} pixels, of {samples}", count(frames as usize, "frame")))
}
