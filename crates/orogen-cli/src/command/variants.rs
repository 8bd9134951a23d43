//! `orogen variants`.

use std::path::PathBuf;

use orogen::budget::Reservation;
use orogen::io::format::png::{Animation, Picture, Pixel};
use orogen::jobs::RenderJob;
use orogen::jobs::variants::VariantsJob;
use orogen::options::{Options, quoted};
use orogen::output::map::contact::Drawn;
use orogen::output::map::{Sheet, Variant, contact};
use orogen::output::render::scene::Colors;
use orogen::world::HEIGHT;
use orogen::{Budget, Grid, Progress, Recipe, Window, World};

use crate::bar::Bar;
use crate::declared::OptionsOf;
use crate::failure::Failure;
use crate::moving::{AnimationTarget, Moving};
use crate::options::RunOptions;
use crate::sink::{Sink, check_png};
use crate::source::{Source, title};
use crate::values::arguments::Arguments;
use crate::values::sweep::Sweep;
use crate::{finite, interrupt, say};

/// Arguments of the command.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// A recipe file, or the name of a preset
    #[arg(default_value = orogen::recipe::presets::DEFAULT)]
    recipe: PathBuf,
    /// Show values of a parameter: N, evenly spaced from A to B, such as relief=200..2000:9, or a list, such as
    /// relief=200,500,2000
    #[arg(long, value_name = "NAME=A..B:N|A,B,...", allow_hyphen_values = true)]
    sweep: Option<Sweep>,
    #[command(flatten)]
    arguments: Arguments,
    #[command(flatten)]
    options: OptionsOf<VariantsJob>,
    /// Show the pictures of --sweep one after the other, forward and back, so that they loop: an animated .png, a .gif,
    /// or a file for each frame such as land-%03d.png
    #[arg(long, requires = "sweep", conflicts_with = "columns")]
    animate: bool,
    /// Duration of each frame, in milliseconds
    #[arg(long, value_name = "MS", default_value = "60", requires = "animate")]
    delay: u16,
    /// Picture to write (.png); with --animate also a .gif, or a file for each frame such as land-%03d.png
    #[arg(short, long, value_name = "FILE", default_value = "variants.png")]
    out: PathBuf,
    #[command(flatten)]
    run: RunOptions,
}

/// Number of samples along a side of an unbounded world, at its own cell.
const UNBOUNDED: f64 = 1024.0;

/// A picture to make.
#[derive(Clone)]
struct Asked {
    label: String,
    seed: Option<u64>,
    set: Option<(String, f64)>,
}

/// Draws the sheet.
pub fn run(args: &Args) -> Result<(), Failure> {
    let target = match args.animate {
        true => AnimationTarget::of(&args.out).map_err(Failure::Usage)?,
        false => check_png(&args.out, "the sheet").map(|()| AnimationTarget::Apng)?,
    };
    let source = Source::find(&args.recipe)?;
    if let Some(path) = source.dem() {
        return Err(Failure::Usage(format!(
            "{} is a file of heights, which has no variants; name a recipe",
            path.display()
        )));
    }
    let budget = args.run.limits.budget();
    let recipe = source.read(&budget, &args.arguments)?;
    let options = args.options.read()?;
    let job = VariantsJob::new(&options)?;
    let policy = args.run.replace.policy(source.inputs(&recipe)).protecting(options.files());
    let asked = asked(args, &job, &recipe);
    let outputs = target.outputs(&args.out, if args.animate { frames(asked.len()) } else { 1 }, &policy)?;
    let (bar, progress) = Bar::new(args.run.quiet);
    let stopped = |failure: Failure| interrupt::explain(failure, "nothing was written");
    let shares = [19.0, if job.render.is_some() { 60.0 } else { 0.0 }, if args.animate { 10.0 } else { 1.0 }];
    let [making, rendering, writing] = progress.parts(shares);
    making.expect(asked.len() as f64);
    rendering.expect(asked.len() as f64);
    let (mut variants, mut held) = (Vec::with_capacity(asked.len()), Vec::with_capacity(asked.len()));
    for one in &asked {
        let (variant, memory) = make(args, &source, one, job.size, &budget, &making.part(1.0)).map_err(stopped)?;
        variants.push(variant);
        held.push(memory);
    }
    if let Some(mut render) = job.render.clone() {
        // The same palette range for the heights of all pictures.
        render.range = contact::range(&variants).filter(|_| render.colors == Colors::Map);
        for (variant, one) in variants.iter_mut().zip(&asked) {
            let made = picture(args, &render, job.size, &source, one, &budget, &rendering.part(1.0));
            variant.picture = Some(made.map_err(stopped)?);
            held.push(budget.charge(3 * (render.size[0] * render.size[1]) as u64));
        }
    }
    let sheet = Sheet {
        title: title(&args.recipe),
        about: recipe.about.clone(),
        footer: words(args, &options, &recipe),
        sea_level: recipe.world.sea_level,
        palette: job.palette,
    };
    let words = match args.animate {
        true => animate(args, &sheet, &variants, &target, &outputs, &budget, &writing).map_err(stopped)?,
        false => {
            let [width, height] = contact::size(&variants, job.columns);
            let _page = budget.reserve((3 * width * height) as u64 + contact::fitting(&variants))?;
            outputs[0].picture(&contact::draw(&sheet, &variants, job.columns)?)?;
            format!("{} pictures, {width} x {height} pixels", variants.len())
        }
    };
    writing.finish();
    drop((bar, held));
    outputs[0].tell(args.run.quiet, &format!("{}: {words}\n", args.out.display()))
}

/// Number of frames for showing this many pictures forward and back.
fn frames(pictures: usize) -> u32 {
    (2 * pictures.saturating_sub(1)).max(1) as u32
}

/// Writes the animation, and returns its description.
fn animate(
    args: &Args,
    sheet: &Sheet,
    variants: &[Variant],
    target: &AnimationTarget,
    outputs: &[Sink],
    budget: &Budget,
    progress: &Progress,
) -> Result<String, Failure> {
    let [width, height] = variants[0].size();
    if let Some(other) = variants.iter().find(|variant| variant.size() != [width, height]) {
        let [across, down] = other.size();
        return Err(Failure::Usage(format!(
            "`{}` is a picture of {width} x {height} pixels and `{}` one of {across} x {down}; the frames of an animation are of one size: sweep \
             a parameter that leaves the size of the world, or leave out --animate",
            variants[0].label, other.label
        )));
    }
    let pixels = (width * height) as u64;
    // The painted frame, and its writer.
    let _room = budget.reserve(3 * pixels + target.reserved(pixels))?;
    let painter = {
        let _fitting = budget.reserve(contact::fitting(variants))?;
        sheet.painter(variants)
    };
    let frames = frames(variants.len());
    let frame = |k: u32| {
        let k = k as usize;
        variants[k.min(frames as usize - k)].pixels(&painter)
    };
    // Colors of a GIF: from both ends of the animation.
    let sample = || Ok([frame(0), frame(frames / 2)].concat());
    let notes = [("Software", say::SOFTWARE)];
    let picture = Picture::new(width, height, Pixel::Rgb8).with_notes(&notes);
    let animation = Animation::new(frames, args.delay);
    let moving = Moving { outputs, target, picture, animation, sample: &sample };
    progress.expect(f64::from(frames));
    moving.write(|k, bytes| {
        progress.check()?;
        bytes.copy_from_slice(&frame(k));
        progress.advance(1.0);
        Ok(())
    })?;
    Ok(format!("{frames} frames of {width} x {height} pixels"))
}

/// The pictures to make.
fn asked(args: &Args, job: &VariantsJob, recipe: &Recipe) -> Vec<Asked> {
    let Some(sweep) = &args.sweep else {
        let first = job.seed.unwrap_or(recipe.world.seed);
        let seeds = (0..job.seeds).map(|k| first.wrapping_add(k) & i64::MAX as u64);
        return seeds.map(|seed| Asked { label: format!("seed {seed}"), seed: Some(seed), set: None }).collect();
    };
    let unit = recipe
        .parameters()
        .iter()
        .find(|parameter| parameter.name == sweep.name)
        .map(|parameter| parameter.unit.clone());
    let unit = unit.unwrap_or_default();
    let asked = sweep.values.iter().map(|&value| Asked {
        label: format!("{} {} {unit}", sweep.name, orogen::grid::words::number(value)).trim_end().to_string(),
        seed: job.seed,
        set: Some((sweep.name.clone(), value)),
    });
    asked.collect()
}

/// The recipe of one picture.
fn recipe(args: &Args, source: &Source, asked: &Asked, budget: &Budget) -> Result<Recipe, Failure> {
    let mut recipe = source.read(budget, &args.arguments.with(asked.set.clone()))?;
    recipe.world.seed = asked.seed.unwrap_or(recipe.world.seed);
    Ok(recipe)
}

/// Renders one picture.
fn picture(
    args: &Args,
    job: &RenderJob,
    samples: usize,
    source: &Source,
    asked: &Asked,
    budget: &Budget,
    progress: &Progress,
) -> Result<Drawn, Failure> {
    let mut recipe = recipe(args, source, asked, budget)?;
    job.prepare(&mut recipe)?;
    let world = args.run.limits.open(recipe, budget)?;
    let job = job.clone().with_window(window(&world, samples)?);
    Ok(Drawn { size: job.size, bytes: job.scene(&world, 1.0, 0, progress)?.to_bytes()? })
}

/// Computes the heights of one picture.
fn make(
    args: &Args,
    source: &Source,
    asked: &Asked,
    samples: usize,
    budget: &Budget,
    progress: &Progress,
) -> Result<(Variant, Reservation), Failure> {
    let world = args.run.limits.open(recipe(args, source, asked, budget)?, budget)?;
    let window = window(&world, samples)?;
    let plan = world.plan(&[HEIGHT], &window)?;
    let grid = world.run(&plan, progress)?.pop().unwrap_or_else(|| Grid::filled(window, 0.0));
    finite::check(HEIGHT, &grid)?;
    let held = budget.charge(4 * grid.data().len() as u64);
    Ok((Variant { label: asked.label.clone(), grid, picture: None }, held))
}

/// The window of the whole world; for an unbounded world, the part that other commands show by default.
fn window(world: &World, samples: usize) -> Result<Window, Failure> {
    match world.recipe().world.size {
        Some(_) => Ok(world.window_fitting(samples)?),
        None => Ok(Window::new(samples, samples, world.recipe().world.cell * UNBOUNDED / samples as f64)),
    }
}

/// The command line that reproduces the sheet.
fn words(args: &Args, options: &Options, recipe: &Recipe) -> String {
    let what = match &args.sweep {
        Some(Sweep { name, text, .. }) => format!(" --sweep {}", quoted(&format!("{name}={text}"))),
        // Other recipes with this name may have another seed.
        None if options.has("seed") => String::new(),
        None => format!(" --seed {}", recipe.world.seed),
    };
    let set = |(name, value): &(String, f64)| format!(" --set {name}={value}");
    let set: String = args.arguments.values().iter().map(set).collect();
    let (version, name, given) = (env!("CARGO_PKG_VERSION"), say::word(&args.recipe), args.options.words());
    format!("Orogen {version}: orogen variants {name}{what}{set}{given}")
}
