//! `orogen grow`.

use std::cell::RefCell;
use std::collections::BTreeSet;
use std::io;
use std::path::PathBuf;
use std::sync::{Mutex, PoisonError};

use orogen::grid::words::count;
use orogen::growth::{FrameSpool, Growth};
use orogen::io::format::png::{Animation, Picture, Pixel};
use orogen::io::spool::Spool;
use orogen::node::Node;
use orogen::output::map::Painter;
use orogen::world::HEIGHT;
use orogen::{Budget, Error, Grid, Progress, Recipe};

use crate::bar::Bar;
use crate::device::DeviceOption;
use crate::failure::Failure;
use crate::moving::{AnimationTarget, Moving};
use crate::options::{Opened, RunOptions};
use crate::sink::Sink;
use crate::view::SizedView;
use crate::{finite, interrupt, say};

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
    /// Number of frames, from the initial to the final terrain. If a node has fewer steps than frames, heights between
    /// steps are interpolated
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(2..=1000), default_value = "25",
          allow_negative_numbers = true)]
    frames: u16,
    /// Simulated years of each node `stream-power` [default: as in the recipe]
    #[arg(long, value_name = "YR", allow_negative_numbers = true)]
    years: Option<f64>,
    /// Compute every frame from the whole recipe. By default, frames of a node `stream-power` that another one follows
    /// are made at twice the cell size, and their finest detail comes from the frame at the end of that node, which is
    /// several times faster
    #[arg(long)]
    exact: bool,
    /// Duration of each frame, in milliseconds
    #[arg(long, value_name = "MS", default_value = "120")]
    delay: u16,
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
    if let Some(years) = args.years.filter(|years| !(0.0..=1e9).contains(years)) {
        return Err(Failure::Usage(format!("--years must be from 0 to 1e9, not {years}")));
    }
    let Opened { mut recipe, budget, policy, .. } = args.run.read(&args.recipe, &args.samples.view)?;
    if let Some(years) = args.years {
        recipe.change(|node| {
            if let Node::StreamPower(rivers) = node {
                rivers.years = years;
            }
        });
    }
    if !recipe.nodes().iter().any(|named| matches!(named.node, Node::StreamPower(_))) {
        return Err(Failure::Usage(format!(
            "{} has no node with op = \"stream-power\", whose steps `grow` draws; add one, or choose another recipe",
            args.recipe.display()
        )));
    }
    let outputs = target.outputs(&args.out, u32::from(args.frames), &policy)?;
    let (bar, progress) = Bar::new(args.run.quiet);
    let made = write(recipe, args, &target, &outputs, &budget, &progress);
    drop(bar);
    let words = made.map_err(|failure| interrupt::explain(failure, "nothing was written"))?;
    outputs[0].tell(args.run.quiet, &words)
}

fn write(
    recipe: Recipe,
    args: &Args,
    target: &AnimationTarget,
    outputs: &[Sink],
    budget: &Budget,
    progress: &Progress,
) -> Result<String, Failure> {
    let sea_level = recipe.world.sea_level;
    let (world, card) = args.device.open(&args.run.limits, recipe, budget)?;
    let window = args.samples.window(&world)?;
    let (width, height) = (window.width, window.height);
    let pixels = (width * height) as u64;
    // Memory of two frames' heights and their interpolation; of the picture; and of the encoder.
    let held = pixels.saturating_mul(3 + 12).saturating_add(target.reserved(pixels));
    let (plan, _frames) = world.plan_beside(&[HEIGHT], &window, held)?;
    let growth = Growth::new(&world, HEIGHT, window)?;
    let growth = if args.exact { growth.in_full() } else { growth };
    let frames = Frames::new(args.frames, growth.steps());
    // Growing takes the time of the terrain, and for each frame the work after its step, about a twentieth of that.
    let growing = world.work(&plan)? * (1.0 + frames.steps.len() as f64 / 20.0);
    let [growing, painting] = progress.parts([growing, PAINTING * pixels as f64 * f64::from(args.frames)]);
    // All frames use the last frame's colors, so heights wait until it is made.
    let heights = Mutex::new(FrameSpool::new(Spool::beside(&args.out), window));
    growth.run(&frames.steps, &growing, &|step, grid| {
        let mut heights = heights.lock().unwrap_or_else(PoisonError::into_inner);
        heights.put(step, grid).map_err(|cause| Error::file("write", &args.out, &cause))
    })?;
    let on = card.used().map_or(String::new(), |card| format!(", a preview on {card}"));
    let land = Land { heights: RefCell::new(heights.into_inner().unwrap_or_else(PoisonError::into_inner)) };
    let last =
        land.at(growth.steps()).map_err(|cause| Error::file("read back the spilled data of", &args.out, &cause))?;
    finite::check(HEIGHT, &last)?;
    let painter = Painter::fit(&last, sea_level);
    let notes = [("Software", say::SOFTWARE)];
    let picture = Picture::new(width, height, Pixel::Rgb8).with_notes(&notes);
    let animation = Animation::new(u32::from(args.frames), args.delay);
    let painted = |ground: &Grid, bytes: &mut [u8]| painter.paint(ground, 0..height, bytes);
    // The start is smooth and the end is rough: colors and shades are fitted to both.
    let sample = || {
        let mut bytes = vec![0; width * height * 6];
        let (one, other) = bytes.split_at_mut(width * height * 3);
        painted(&land.at(0)?, one);
        painted(&last, other);
        Ok(bytes)
    };
    let moving = Moving { outputs, target, picture, animation, sample: &sample };
    painting.expect(f64::from(args.frames));
    moving.write(|k, bytes| {
        painting.check()?;
        painted(&land.between(frames.at(k))?, bytes);
        painting.advance(1.0);
        Ok(())
    })?;
    let frames = count(usize::from(args.frames), "frame");
    Ok(format!("{}: {frames} of {width} x {height} pixels{on}\n", args.out.display()))
}

/// Approximate time for painting and encoding a pixel, in nanoseconds.
const PAINTING: f64 = 150.0;

/// The steps that frames show.
struct Frames {
    count: u32,
    /// Number of steps of the terrain.
    all: u32,
    /// The steps that are made.
    steps: BTreeSet<u32>,
}

impl Frames {
    fn new(count: u16, all: u32) -> Frames {
        let mut frames = Frames { count: u32::from(count), all, steps: BTreeSet::new() };
        let shown = (0..frames.count).map(|k| frames.at(k));
        frames.steps = shown.flat_map(|at| [at.floor() as u32, at.ceil() as u32]).collect();
        frames
    }

    /// The step of frame `k`: an integer if there are at least as many steps as frames, otherwise a fraction between
    /// two steps.
    fn at(&self, k: u32) -> f64 {
        let at = f64::from(self.all) * f64::from(k) / f64::from(self.count - 1);
        if self.all >= self.count - 1 { at.round() } else { at }
    }
}

/// The heights after steps.
struct Land {
    heights: RefCell<FrameSpool>,
}

impl Land {
    /// The heights after a step.
    fn at(&self, step: u32) -> io::Result<Grid> {
        self.heights.borrow_mut().get(step)
    }

    /// Heights interpolated between two steps.
    fn between(&self, step: f64) -> io::Result<Grid> {
        let mut grid = self.at(step.floor() as u32)?;
        let share = step.fract() as f32;
        if share > 0.0 {
            let next = self.at(step.ceil() as u32)?;
            let pairs = grid.data_mut().iter_mut().zip(next.data());
            pairs.for_each(|(height, next)| *height += share * (next - *height));
        }
        Ok(grid)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn frames_are_whole_steps_where_there_are_enough() {
        let frames = Frames::new(5, 4);
        assert_eq!((0..5).map(|k| frames.at(k)).collect::<Vec<_>>(), [0.0, 1.0, 2.0, 3.0, 4.0]);
        let frames = Frames::new(4, 70);
        assert_eq!(frames.steps.into_iter().collect::<Vec<_>>(), [0, 23, 47, 70]);
        let frames = Frames::new(5, 2);
        assert_eq!((frames.at(1), frames.steps.len()), (0.5, 3));
    }
}
