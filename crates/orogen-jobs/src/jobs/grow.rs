//! Frames of a terrain as it erodes.

use std::collections::BTreeSet;
use std::io;
use std::ops::RangeInclusive;
use std::path::Path;
use std::sync::{Mutex, PoisonError};

use super::finite;
use crate::options::{OptionSpec, Options, ValueKind};
use orogen_engine::budget::Reservation;
use orogen_engine::growth::{FrameSpool, Growth};
use orogen_engine::node::Node;
use orogen_engine::recipe::document::Recipe;
use orogen_engine::world::{HEIGHT, World};
use orogen_grid::error::{Error, ErrorKind, Result};
use orogen_grid::grid::{Grid, Window};
use orogen_grid::progress::Progress;
use orogen_grid::resample;
use orogen_io::spool::Spool;

/// Numbers of frames.
const FRAMES: RangeInclusive<u32> = 2..=1000;

/// Simulated years.
const YEARS: RangeInclusive<f64> = 0.0..=1e9;

/// The heights of a world while its nodes `stream-power` erode them, as the frames of an animation.
///
/// [`prepare`](GrowJob::prepare) a recipe, open its world, [`run`](GrowJob::run), then read each
/// [frame](GrownFrames::frame).
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct GrowJob {
    /// Number of frames from the initial to the final terrain, 2 to 1000.
    pub frames: u32,
    /// Simulated years of each node `stream-power`, 0 to 1e9; `None` for those of the recipe.
    pub years: Option<f64>,
    /// Whether every frame is computed from the whole recipe, in place of drafts at twice the cell.
    pub is_exact: bool,
    /// Duration of each frame, in milliseconds.
    pub delay: u16,
}

const OPTIONS: &[OptionSpec] = &[
    OptionSpec::new("frames", "N", ValueKind::Whole(*FRAMES.start() as u64, *FRAMES.end() as u64))
        .with_about(
            "Number of frames, from the initial to the final terrain. If a node has fewer steps than frames, heights \
             between steps are interpolated",
        )
        .with_default("25"),
    OptionSpec::new("years", "YR", ValueKind::Number(f64::NEG_INFINITY, f64::INFINITY))
        .with_about("Simulated years of each node `stream-power` [default: as in the recipe]"),
    OptionSpec::switch("exact").with_about(
        "Compute every frame from the whole recipe. By default, frames of a node `stream-power` that another one \
         follows are made at twice the cell size, and their finest detail comes from the frame at the end of that \
         node, which is several times faster",
    ),
    OptionSpec::new("delay", "MS", ValueKind::Whole(0, u16::MAX as u64))
        .with_about("Duration of each frame, in milliseconds")
        .with_default("120"),
];

/// Approximate time for painting and encoding a pixel, in nanoseconds.
const PAINTING: f64 = 150.0;

impl GrowJob {
    /// The options, for front ends.
    pub const OPTIONS: &[OptionSpec] = OPTIONS;

    /// The frames that are chosen by [`OPTIONS`](GrowJob::OPTIONS).
    ///
    /// # Errors
    /// If a number is out of its range.
    pub fn new(options: &Options) -> Result<GrowJob> {
        let job = GrowJob {
            frames: options.whole("frames").unwrap_or(25) as u32,
            years: options.number("years"),
            is_exact: options.has("exact"),
            delay: options.whole("delay").unwrap_or(120) as u16,
        };
        job.check()?;
        Ok(job)
    }

    /// Checks the number of frames and of years.
    fn check(&self) -> Result<()> {
        if !FRAMES.contains(&self.frames) {
            let (from, to) = (FRAMES.start(), FRAMES.end());
            return refuse(format!("--frames must be from {from} to {to}, not {}", self.frames));
        }
        match self.years.filter(|years| !YEARS.contains(years)) {
            Some(years) => refuse(format!("--years must be from 0 to 1e9, not {years}")),
            None => Ok(()),
        }
    }

    /// Sets the years of a recipe; call it before the world is opened. `name` is that of the recipe, for the message.
    ///
    /// # Errors
    /// If the recipe has no node `stream-power`.
    pub fn prepare(&self, recipe: &mut Recipe, name: &str) -> Result<()> {
        if let Some(years) = self.years {
            recipe.change(|node| {
                if let Node::StreamPower(rivers) = node {
                    rivers.years = years;
                }
            });
        }
        match recipe.nodes().iter().any(|named| matches!(named.node, Node::StreamPower(_))) {
            true => Ok(()),
            false => refuse(format!(
                "{name} has no node with op = \"stream-power\", whose steps `grow` draws; add one, or choose another \
                 recipe"
            )),
        }
    }

    /// Makes the heights of the frames over a window, of a world of a [prepared](GrowJob::prepare) recipe. Painting and
    /// writing them is the rest of `progress`. The memory of a picture of three bytes per sample, and of `writing`
    /// bytes for its encoder, is reserved with that of the heights. Frames that take more than 8 MiB together wait in a
    /// temporary file on the disk of `out`.
    ///
    /// # Errors
    /// If a field is out of its range, the heights read no node `stream-power`, or the world cannot make the window; if
    /// no height is finite, the disk fails, or memory does not suffice (then nothing was started); or the work was
    /// cancelled.
    pub fn run(
        &self,
        world: &World,
        window: &Window,
        (out, writing): (&Path, u64),
        progress: &Progress,
    ) -> Result<GrownFrames> {
        self.check()?;
        let pixels = window.len() as u64;
        // Memory of two frames' heights and their interpolation; of the picture; and of the encoder.
        let held = pixels.saturating_mul(3 + 12).saturating_add(writing);
        let (plan, reserved) = world.plan_beside(&[HEIGHT], window, held)?;
        let growth = Growth::new(world, HEIGHT, *window)?;
        let growth = if self.is_exact { growth.in_full() } else { growth };
        let shown = ShownSteps::new(self.frames, growth.steps());
        // Growing takes the time of the terrain, and for each frame the work after its step, about a twentieth of that.
        let growing = world.work(&plan)? * (1.0 + shown.steps.len() as f64 / 20.0);
        let [growing, painting] = progress.parts([growing, PAINTING * pixels as f64 * f64::from(self.frames)]);
        // All frames use the last frame's colors, so heights wait until it is made.
        let heights = Mutex::new(FrameSpool::new(Spool::beside(out), *window));
        growth.run(&shown.steps, &growing, &|step, grid| {
            let mut heights = heights.lock().unwrap_or_else(PoisonError::into_inner);
            heights.put(step, grid).map_err(|cause| Error::file("write", out, &cause))
        })?;
        painting.expect(f64::from(self.frames));
        let heights = Heights { shown, spool: heights };
        let last = heights.at(growth.steps());
        let last = last.map_err(|cause| Error::file("read back the spilled data of", out, &cause))?;
        let mut warnings = Vec::new();
        finite::check(HEIGHT, &last, &mut warnings)?;
        Ok(GrownFrames { last, warnings, painting, heights, _reserved: reserved })
    }
}

/// The heights of the frames of an animation.
pub struct GrownFrames {
    /// The heights of the last frame, in metres: those of the world itself.
    pub last: Grid,
    /// Messages about heights that are NaN or infinite.
    pub warnings: Vec<String>,
    /// Progress of painting and writing, a unit for each frame.
    pub painting: Progress,
    heights: Heights,
    _reserved: Reservation,
}

impl GrownFrames {
    /// Number of frames.
    #[must_use]
    pub fn count(&self) -> u32 {
        self.heights.shown.count
    }

    /// The heights of a frame, in metres; 0 is the initial terrain.
    ///
    /// # Errors
    /// If there is no such frame, or the disk fails.
    pub fn frame(&self, frame: u32) -> io::Result<Grid> {
        self.heights.between(self.heights.shown.at(frame))
    }
}

/// The steps of the terrain that frames show.
struct ShownSteps {
    /// Number of frames.
    count: u32,
    /// Number of steps of the terrain.
    all: u32,
    /// The steps that are made.
    steps: BTreeSet<u32>,
}

impl ShownSteps {
    fn new(count: u32, all: u32) -> ShownSteps {
        let mut shown = ShownSteps { count, all, steps: BTreeSet::new() };
        shown.steps =
            (0..count).map(|frame| shown.at(frame)).flat_map(|at| [at.floor() as u32, at.ceil() as u32]).collect();
        shown
    }

    /// The step of a frame: an integer if there are at least as many steps as frames, otherwise a fraction between two
    /// steps.
    fn at(&self, frame: u32) -> f64 {
        let at = f64::from(self.all) * f64::from(frame) / f64::from(self.count - 1);
        if self.all >= self.count - 1 { at.round() } else { at }
    }
}

/// The heights after steps.
struct Heights {
    shown: ShownSteps,
    spool: Mutex<FrameSpool>,
}

impl Heights {
    /// The heights after a step.
    fn at(&self, step: u32) -> io::Result<Grid> {
        self.spool.lock().unwrap_or_else(PoisonError::into_inner).get(step)
    }

    /// Heights interpolated between two steps.
    fn between(&self, step: f64) -> io::Result<Grid> {
        let mut grid = self.at(step.floor() as u32)?;
        let share = step.fract() as f32;
        if share > 0.0 {
            resample::blend(&mut grid, &self.at(step.ceil() as u32)?, share);
        }
        Ok(grid)
    }
}

fn refuse<T>(message: String) -> Result<T> {
    Err(Error::new(ErrorKind::Request, message))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A stage of four steps.
    const RIVERS: &str = "orogen = 1\n[world]\nsize = [3000, 2000]\ncell = 100\n[nodes.noise]\nop = \"fbm\"\n\
        [nodes.land]\nop = \"remap\"\nsource = \"noise\"\nto = [0, 400]\n[nodes.rivers]\nop = \"stream-power\"\n\
        source = \"land\"\nyears = 100000\nsteps = 4\n[outputs]\nheight = \"rivers\"\n";

    fn job(given: &[(&str, &str)]) -> std::result::Result<GrowJob, String> {
        let job = Options::of(OPTIONS, given.iter().copied()).and_then(|options| GrowJob::new(&options));
        job.map_err(|error| error.to_string())
    }

    fn grown(given: &[(&str, &str)]) -> (World, GrownFrames) {
        let (job, mut recipe) = (job(given).unwrap(), Recipe::parse(RIVERS, "rivers").unwrap());
        job.prepare(&mut recipe, "rivers").unwrap();
        let world = World::open(recipe).unwrap();
        let window = Window::new(30, 20, 100.0);
        let frames = job.run(&world, &window, (Path::new("grow.png"), 0), &Progress::none()).unwrap();
        (world, frames)
    }

    #[test]
    fn defaults_are_those_of_the_list() {
        let own = format!("{:?}", job(&[]).unwrap());
        assert_eq!(own, "GrowJob { frames: 25, years: None, is_exact: false, delay: 120 }");
        for spec in OPTIONS.iter().filter(|spec| !spec.default.is_empty()) {
            assert_eq!(format!("{:?}", job(&[(spec.name, spec.default)]).unwrap()), own, "{}", spec.name);
        }
        let all = job(&[("frames", "1000"), ("years", "1e9"), ("exact", ""), ("delay", "0")]).unwrap();
        assert!(all.frames == 1000 && all.years == Some(1e9) && all.is_exact && all.delay == 0);
    }

    #[test]
    fn what_is_out_of_range_is_a_sentence() {
        for (given, expect) in [
            (("frames", "1"), "it must be a whole number from 2 to 1000"),
            (("frames", "1001"), "it must be a whole number from 2 to 1000"),
            (("years", "-1"), "--years must be from 0 to 1e9, not -1"),
            (("years", "1.1e9"), "--years must be from 0 to 1e9, not 1100000000"),
            (("delay", "65536"), "it must be a whole number from 0 to 65535"),
        ] {
            let why = job(&[given]).unwrap_err();
            assert!(why.contains(expect), "{why}");
        }
        let none = GrowJob { frames: 0, ..job(&[]).unwrap() };
        assert_eq!(none.check().unwrap_err().to_string(), "--frames must be from 2 to 1000, not 0");
    }

    #[test]
    fn a_recipe_without_steps_is_refused() {
        let mut hills = orogen_engine::presets::find("hills").unwrap().recipe().unwrap();
        let why = job(&[]).unwrap().prepare(&mut hills, "hills").unwrap_err().to_string();
        assert_eq!(
            why,
            "hills has no node with op = \"stream-power\", whose steps `grow` draws; add one, or choose another recipe"
        );
    }

    #[test]
    fn years_are_those_of_each_stage() {
        let mut recipe = Recipe::parse(RIVERS, "rivers").unwrap();
        job(&[("years", "7")]).unwrap().prepare(&mut recipe, "rivers").unwrap();
        let years = |named: &orogen_engine::recipe::NamedNode| match &named.node {
            Node::StreamPower(law) => Some(law.years),
            _ => None,
        };
        assert_eq!(recipe.nodes().iter().find_map(years), Some(7.0));
    }

    #[test]
    fn frames_are_whole_steps_where_there_are_enough() {
        let shown = ShownSteps::new(5, 4);
        assert_eq!((0..5).map(|frame| shown.at(frame)).collect::<Vec<_>>(), [0.0, 1.0, 2.0, 3.0, 4.0]);
        let shown = ShownSteps::new(4, 70);
        assert_eq!(shown.steps.into_iter().collect::<Vec<_>>(), [0, 23, 47, 70]);
        let shown = ShownSteps::new(5, 2);
        assert_eq!((shown.at(1), shown.steps.len()), (0.5, 3));
    }

    #[test]
    fn the_last_frame_is_the_world_and_others_lie_between_steps() {
        let (world, frames) = grown(&[("frames", "9")]);
        let window = Window::new(30, 20, 100.0);
        assert_eq!((frames.count(), frames.warnings.len()), (9, 0));
        assert!(frames.last == world.window(HEIGHT, &window).unwrap() && frames.frame(8).unwrap() == frames.last);
        let [before, between, after] = [0, 1, 2].map(|frame| frames.frame(frame).unwrap());
        assert!(before != after);
        let mut middle = before;
        resample::blend(&mut middle, &after, 0.5);
        assert_eq!(between, middle);
        assert_eq!(frames.frame(9).unwrap_err().kind(), io::ErrorKind::NotFound);
    }
}
