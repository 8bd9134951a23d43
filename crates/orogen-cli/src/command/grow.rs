//! `orogen grow`.

use std::path::PathBuf;

use orogen::grid::words::count;
use orogen::io::format::png::{Animation, Picture, Pixel};
use orogen::jobs::GrowJob;
use orogen::output::map::Painter;
use orogen::{Budget, Grid, Progress, Recipe};

use crate::bar::Bar;
use crate::declared::OptionsOf;
use crate::device::DeviceOption;
use crate::failure::Failure;
use crate::moving::{AnimationTarget, Moving};
use crate::options::{Opened, RunOptions};
use crate::sink::Sink;
use crate::view::SizedView;
use crate::{interrupt, say};

/// Arguments of the command.
#[derive(Debug, Clone, clap::Args)]
pub struct Args {
    /// A recipe file or the name of a preset, with a node `stream-power`
    recipe: PathBuf,
    #[command(flatten)]
    samples: SizedView,
    /// Output: an animated .png (APNG), a .gif, or a file for each frame such as grow-%03d.png
    #[arg(short, long, value_name = "FILE", default_value = "grow.png")]
    out: PathBuf,
    #[command(flatten)]
    options: OptionsOf<GrowJob>,
    #[command(flatten)]
    device: DeviceOption,
    #[command(flatten)]
    run: RunOptions,
}

/// Makes the frames.
pub fn run(args: &Args) -> Result<(), Failure> {
    args.samples.each_output(&args.out, |samples, out| grow(&Args { samples, out, ..args.clone() }))
}

fn grow(args: &Args) -> Result<(), Failure> {
    let target = AnimationTarget::of(&args.out).map_err(Failure::Usage)?;
    let job = GrowJob::new(&args.options.read()?)?;
    let Opened { mut recipe, budget, policy, .. } = args.run.read(&args.recipe, &args.samples.view)?;
    job.prepare(&mut recipe, &args.recipe.display().to_string())?;
    let outputs = target.outputs(&args.out, job.frames, &policy)?;
    let (bar, progress) = Bar::new(args.run.quiet);
    let made = write(args, &job, recipe, &target, &outputs, &budget, &progress);
    drop(bar);
    let words = made.map_err(|failure| interrupt::explain(failure, "nothing was written"))?;
    outputs[0].tell(args.run.quiet, &words)
}

fn write(
    args: &Args,
    job: &GrowJob,
    recipe: Recipe,
    target: &AnimationTarget,
    outputs: &[Sink],
    budget: &Budget,
    progress: &Progress,
) -> Result<String, Failure> {
    let sea_level = recipe.world.sea_level;
    let (world, card) = args.device.open(&args.run.limits, recipe, budget)?;
    let window = args.samples.window(&world)?;
    let (width, height) = (window.width, window.height);
    let writing = target.reserved(window.len() as u64);
    let grown = job.run(&world, &window, (&args.out, writing), progress)?;
    let on = card.used().map_or(String::new(), |card| format!(", a preview on {card}"));
    for warning in &grown.warnings {
        say::error(&format!("warning: {warning}"));
    }
    let painter = Painter::fit(&grown.last, sea_level);
    let notes = [("Software", say::SOFTWARE)];
    let picture = Picture::new(width, height, Pixel::Rgb8).with_notes(&notes);
    let animation = Animation::new(grown.count(), job.delay);
    let painted = |ground: &Grid, bytes: &mut [u8]| painter.paint(ground, 0..height, bytes);
    // The start is smooth and the end is rough: colors and shades are fitted to both.
    let sample = || {
        let mut bytes = vec![0; width * height * 6];
        let (one, other) = bytes.split_at_mut(width * height * 3);
        painted(&grown.frame(0)?, one);
        painted(&grown.last, other);
        Ok(bytes)
    };
    let moving = Moving { outputs, target, picture, animation, sample: &sample };
    moving.write(|frame, bytes| {
        grown.painting.check()?;
        painted(&grown.frame(frame)?, bytes);
        grown.painting.advance(1.0);
        Ok(())
    })?;
    let frames = count(grown.count() as usize, "frame");
    Ok(format!("{}: {frames} of {width} x {height} pixels{on}\n", args.out.display()))
}
