//! `orogen build`.

use std::path::{Path, PathBuf};
use std::time::Instant;

use orogen::Window;
use orogen::builder::run::Start;
use orogen::builder::{Build, BuildSpec, Form, Report};
use orogen::grid::words::{self, bytes, count, number};
use orogen::io::dem::prepared::DEFAULT_MEMORY;

use crate::bar::Bar;
use crate::declared::OptionsOf;
use crate::failure::Failure;
use crate::options::{Opened, RunOptions};
use crate::sink::is_stdout;
use crate::view::SizedView;
use crate::{disk, finite, interrupt, say};

/// Arguments of the command.
#[derive(Debug, Clone, clap::Args)]
pub struct Args {
    /// A recipe file, the name of a preset, or a file of heights (GeoTIFF, .asc, .hgt, ...)
    recipe: PathBuf,
    /// Output: NAME.tif is a Cloud-Optimized GeoTIFF, NAME.zarr a Zarr v3 group, NAME.pmtiles tiles of
    /// web maps, NAME a folder of --tiles
    #[arg(short, long, value_name = "OUT")]
    out: PathBuf,
    #[command(flatten)]
    options: OptionsOf<BuildSpec>,
    #[command(flatten)]
    samples: SizedView,
    /// Resume an interrupted build, and repair damaged parts of a finished one; with --force, also over an existing
    /// file of another kind
    #[arg(long, conflicts_with = "no_clobber")]
    resume: bool,
    #[command(flatten)]
    run: RunOptions,
}

/// Runs the build.
pub fn run(args: &Args) -> Result<(), Failure> {
    args.samples.each_output(&args.out, |mut samples, out| {
        // A build is resumed by the content of its input files, and is too large to read only parts of them.
        samples.view.reads_part = false;
        build(&Args { samples, out, ..args.clone() })
    })
}

fn build(args: &Args) -> Result<(), Failure> {
    if is_stdout(&args.out) {
        let message = "a build cannot be written to standard output, because it could not be resumed; name a file, or use `orogen export`";
        return Err(Failure::Usage(message.into()));
    }
    let begun = Instant::now();
    let options = args.options.read()?;
    let form = Form::chosen(&args.out, &options)?;
    let Opened { recipe, budget, policy, .. } = args.run.read(&args.recipe, &args.samples.view)?;
    let output = policy.output(&args.out)?;
    let mut world = args.run.limits.open(recipe, &budget)?;
    if let Some(recipe) = world.recipe().with_whole_files(budget.left().unwrap_or(DEFAULT_MEMORY))? {
        world = args.run.limits.open(recipe, &budget)?;
    }
    let view = args.samples.view.samples(args.samples.size)?;
    let spec = BuildSpec::new(form, form.window(&world, &view, &options)?).with_options(&options);
    let build = Build::new(&world, &spec, &output)?;
    if spec.part.is_some() && args.run.replace.no_clobber {
        let message = "--part continues what other parts have begun; leave out --no-clobber";
        return Err(Failure::Usage(message.into()));
    }
    let start = match (args.resume, args.run.replace.force) {
        (true, _) => Start::Resume,
        (_, true) => Start::Force,
        _ => Start::Fresh,
    };
    needs(args, &build, &spec, start)?;
    let (bar, progress) = Bar::new(args.run.quiet);
    let report = build.run(start, &progress);
    drop(bar);
    let then = match spec.part {
        Some(_) => "run the same command to continue",
        None => "run the same command with --resume to continue",
    };
    let report = report.map_err(|error| interrupt::explain(error.into(), then))?;
    finite::tell(&spec.layers.join("`, `"), report.samples)?;
    if !report.foreign.is_empty() {
        let names: Vec<String> = report.foreign.iter().map(|path| path.display().to_string()).collect();
        let list = words::list(names.iter().map(String::as_str));
        say::error(&format!(
            "note: {} also holds {list}, which were not made by a build and are left unchanged",
            args.out.display()
        ));
    }
    if args.run.quiet { Ok(()) } else { say::out(&closing(args, &spec, &report, begun.elapsed().as_secs_f64())) }
}

/// Prints the required memory and disk space, and fails if they are not available.
fn needs(args: &Args, build: &Build, spec: &BuildSpec, start: Start) -> Result<(), Failure> {
    let (disk, there) = build.disk();
    let free = disk::free_at(&args.out);
    let there = if start == Start::Resume || spec.part.is_some() { there } else { 0 };
    if !args.run.quiet {
        let (tiles, samples) = build.tiles();
        let way = match disk.scratch {
            0 => String::new(),
            scratch => format!(", and temporarily {} in {}", bytes(scratch), build.beside().display()),
        };
        let free = free.map_or(String::new(), |free| format!("; {} are free", bytes(free)));
        let part = spec.part.map_or(String::new(), |[number, count]| format!("part {number} of {count}: "));
        say::error(&format!(
            "{part}{} of {:.1} million samples; up to {} of memory; up to {} of disk{way}{free}",
            count(tiles, "tile"),
            samples as f64 / 1e6,
            bytes(build.memory()),
            bytes(disk.result)
        ));
    }
    disk::afford(&args.out, (disk.result + disk.scratch).saturating_sub(there), free)?;
    Ok(())
}

/// The final message.
fn closing(args: &Args, spec: &BuildSpec, report: &Report, seconds: f64) -> String {
    let Window { width, height, cell, .. } = spec.window;
    let made = match report {
        Report { made: 0, .. } if spec.part.is_some() => "nothing was left to make".to_string(),
        Report { made: 0, .. } => "all parts were complete and valid".to_string(),
        Report { made, kept: 0, .. } => format!("{} made", count(*made, "tile")),
        Report { made, kept, again: 0, .. } => format!("{} made, {kept} kept", count(*made, "tile")),
        Report { made, kept, again, .. } => {
            format!("{} made, {kept} kept ({again} of them computed again as input)", count(*made, "tile"))
        }
    };
    let parts = spec.part.map_or(String::new(), |part| state_of_parts(part, &report.left));
    format!(
        "{}: {}, {width} x {height} samples of {} m, {}\n{made} in {seconds:.1} s\n{parts}",
        Path::new(&args.out).display(),
        spec.layers.join(", "),
        number(cell),
        bytes(report.bytes),
    )
}

/// Parts that are named in messages; of more parts, only their number is given.
const NAMED: usize = 8;

/// Of more parts than this, a report does not list all that are missing.
const LISTED: usize = 1000;

/// The line about the other parts of a build.
fn state_of_parts([number, count]: [usize; 2], left: &[usize]) -> String {
    if left.contains(&number) {
        return format!("files of part {number} of {count} were removed; run it again\n");
    }
    let numbers: Vec<String> = left.iter().map(usize::to_string).collect();
    let left = match numbers.as_slice() {
        [] => return "the result is complete\n".to_string(),
        [one] if count <= LISTED => format!("part {one} is not"),
        [init @ .., last] if init.len() < NAMED && count <= LISTED => {
            format!("parts {} and {last} are not", init.join(", "))
        }
        some if count > LISTED => format!("{} or more parts are not", some.len()),
        all => format!("{} parts are not", all.len()),
    };
    format!("part {number} of {count} is complete; {left}, and the last part finishes the result\n")
}
