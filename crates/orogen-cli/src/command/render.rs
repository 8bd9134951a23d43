//! `orogen render`.

use std::path::{Path, PathBuf};

use orogen::grid::words::count;
use orogen::io::file;
use orogen::io::format::png::Animation;
use orogen::jobs::RenderJob;
use orogen::jobs::render::Rendering;
use orogen::output::render::View as Shot;

use crate::bar::Bar;
use crate::declared::OptionsOf;
use crate::device::DeviceOption;
use crate::failure::Failure;
use crate::moving::{AnimationTarget, Moving};
use crate::options::{Opened, RunOptions};
use crate::sink::{Sink, is_stdout};
use crate::view::View;
use crate::{interrupt, say};

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
    #[command(flatten)]
    options: OptionsOf<RenderJob>,
    /// Orbit the camera around the land in N frames: an animated .png (APNG), a .gif, or a file for each frame
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(2..=3600), conflicts_with = "look",
          allow_negative_numbers = true)]
    turntable: Option<u32>,
    /// Duration of each frame, in milliseconds
    #[arg(long, value_name = "MS", default_value = "60", requires = "turntable")]
    delay: u16,
    #[command(flatten)]
    view: View,
    #[command(flatten)]
    device: DeviceOption,
    #[command(flatten)]
    run: RunOptions,
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
    let options = args.options.read()?;
    let mut job = RenderJob::default().with_options(&options)?;
    let Opened { mut recipe, budget, policy, .. } = args.run.read(&args.recipe, &args.view)?;
    let policy = policy.protecting(options.files());
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

/// The share of a frame's pixels from which the colors of a GIF are chosen.
const PREVIEW: f64 = 0.25;

/// Number of pictures to paint: those of an animation, and parts of some for the colors of a GIF.
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
    // The shortest distance at which all frames fit. A changing distance would make the land pulsate.
    let distance = distance.unwrap_or_else(|| scene.distance(sides, spec));
    let view = |frame: u32| Shot::Around { azimuth: turn(frame), elevation, distance: Some(distance) };
    let side = |frame: u32| scene.camera(&spec.with_view(view(frame)));
    // Four small views suffice for choosing the colors.
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
