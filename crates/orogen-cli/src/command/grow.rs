//! `orogen grow`.

use std::io;
use std::path::PathBuf;

use orogen::format::png::{Animation, Picture, Pixel};
use orogen::map::paint::Painter;
use orogen::node::Node;
use orogen::words::count;
use orogen::{Budget, Grid, Progress, Recipe};

use crate::bar::Bar;
use crate::failure::Failure;
use crate::moving::{Moving, Target};
use crate::options::Limits;
use crate::replace::Replace;
use crate::seeds::Seeds;
use crate::sink::Sink;
use crate::source::Source;
use crate::view::{SizedView, View};
use crate::{finite, interrupt};

/// What it takes.
#[derive(Debug, Clone, clap::Args)]
pub struct Args {
    /// A recipe's file or the name of a preset, with a node `stream-power`
    recipe: PathBuf,
    #[command(flatten)]
    samples: SizedView,
    /// Picture to write: a .png that moves (APNG), a .gif, or a file for each frame such as grow-%03d.png
    #[arg(short, long, value_name = "FILE", default_value = "grow.png")]
    out: PathBuf,
    /// How many frames: the beginning, and after each step
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(2..=1000), default_value = "25",
          allow_negative_numbers = true)]
    frames: u16,
    /// Years from the first frame to the last [default: those of the recipe's node]
    #[arg(long, value_name = "YR", allow_negative_numbers = true)]
    years: Option<f64>,
    /// How long each frame is shown, in milliseconds
    #[arg(long, value_name = "MS", default_value = "120")]
    delay: u16,
    #[command(flatten)]
    replace: Replace,
    #[command(flatten)]
    limits: Limits,
    /// Show neither progress nor the closing words
    #[arg(short, long)]
    quiet: bool,
}

/// Makes the frames.
pub fn run(args: &Args) -> Result<(), Failure> {
    Seeds::each(args.samples.view.seed.as_ref(), Some(&args.out), |seed, out| {
        let view = View { seed, ..args.samples.view.clone() };
        let out = out.unwrap_or_default();
        grow(&Args { samples: SizedView { view, ..args.samples }, out, ..args.clone() })
    })
}

fn grow(args: &Args) -> Result<(), Failure> {
    let target = Target::of(&args.out).map_err(Failure::Usage)?;
    if let Some(years) = args.years.filter(|years| !(0.0..=1e9).contains(years)) {
        return Err(Failure::Usage(format!("--years is {years}; it goes from 0 to 1e9")));
    }
    let source = Source::find(&args.recipe)?;
    let budget = args.limits.budget();
    let mut recipe = source.read(&budget)?;
    args.samples.view.apply(&mut recipe);
    if !recipe.nodes().iter().any(|named| matches!(named.node, Node::StreamPower(_))) {
        return Err(Failure::Usage(format!(
            "nothing grows in {}: it has no node with op = \"stream-power\", which lifts land and cuts rivers into it",
            args.recipe.display()
        )));
    }
    let policy = args.replace.policy(source.inputs(&recipe));
    let outputs = target.outputs(&args.out, u32::from(args.frames), &policy)?;
    let (bar, progress) = Bar::new(args.quiet);
    let made = write(&recipe, args, &target, &outputs, &budget, &progress);
    drop(bar);
    let words = made.map_err(|failure| interrupt::explain(failure, "nothing was written"))?;
    outputs[0].tell(args.quiet, &words)
}

fn write(
    recipe: &Recipe,
    args: &Args,
    target: &Target,
    outputs: &[Sink],
    budget: &Budget,
    progress: &Progress,
) -> Result<String, Failure> {
    let frame = |steps: u16| frame(recipe, args, steps, budget, progress);
    // The last frame first: it tells how large the picture is, and its colours are those of all.
    let last = frame(args.frames - 1)?;
    finite::check(orogen::world::HEIGHT, &last)?;
    let (width, height) = (last.width(), last.height());
    let pixels = (width * height) as u64;
    // The last frame, the picture of one, and what is made of it.
    let _frames = budget.reserve(pixels.saturating_mul(7).saturating_add(target.beside(pixels)))?;
    let painter = Painter::fit(&last, recipe.world.sea_level);
    let software = format!("Orogen {}", env!("CARGO_PKG_VERSION"));
    let picture = Picture { width, height, pixel: Pixel::Rgb8, notes: &[("Software", &software)] };
    let animation = Animation { frames: u32::from(args.frames), delay: args.delay };
    let painted = |ground: &Grid, bytes: &mut [u8]| painter.paint(ground, 0..height, bytes);
    // The beginning is smooth and the end is rough: colours and shades of both.
    let sample = || {
        let first = frame(0).map_err(carried)?;
        let mut bytes = vec![0; width * height * 6];
        let (one, other) = bytes.split_at_mut(width * height * 3);
        painted(&first, one);
        painted(&last, other);
        Ok(bytes)
    };
    let moving = Moving { outputs, target, picture, animation, sample: &sample };
    moving.write(|k, bytes| {
        match k + 1 < u32::from(args.frames) {
            true => painted(&frame(k as u16).map_err(carried)?, bytes),
            false => painted(&last, bytes),
        }
        Ok(())
    })?;
    Ok(format!("{}: {} of {width} x {height} pixels\n", args.out.display(), count(usize::from(args.frames), "frame")))
}

/// A failure on its way through code that writes.
fn carried(failure: Failure) -> io::Error {
    match failure {
        Failure::Engine(error) => error.into(),
        other => io::Error::other(format!("a frame could not be made: {other:?}")),
    }
}

/// The ground after so many steps.
fn frame(recipe: &Recipe, args: &Args, steps: u16, budget: &Budget, progress: &Progress) -> Result<Grid, Failure> {
    let mut recipe = recipe.clone();
    recipe.change(|node| {
        if let Node::StreamPower(rivers) = node {
            let years = args.years.unwrap_or(rivers.years);
            // Each frame is a run of its own through the same steps: what comes after changes nothing about it.
            rivers.years = years / f64::from(args.frames - 1) * f64::from(steps);
            rivers.steps = u32::from(steps.max(1));
        }
    });
    let world = args.limits.open(recipe, budget)?;
    let window = args.samples.window(&world)?;
    let plan = world.plan(&[orogen::world::HEIGHT], &window)?;
    let grid = world.run(&plan, progress)?.pop();
    Ok(grid.unwrap_or_else(|| Grid::filled(window, 0.0)))
}
