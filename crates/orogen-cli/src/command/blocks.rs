//! `orogen blocks`.

use std::path::PathBuf;

use orogen::Progress;
use orogen::jobs::blocks_folder::BlocksFolder;
use orogen::jobs::{BlockFormat, BlocksJob};
use orogen::world::HEIGHT;

use crate::bar::Bar;
use crate::declared::OptionsOf;
use crate::failure::Failure;
use crate::options::{Opened, RunOptions};
use crate::sink::{Sink, is_stdout, kind};
use crate::values::name_of;
use crate::view::SizedView;
use crate::{finite, interrupt, say};

/// Arguments of the command.
#[derive(Debug, Clone, clap::Args)]
pub struct Args {
    /// A recipe file, the name of a preset, or a file of heights (GeoTIFF, .asc, .hgt, ...)
    #[arg(default_value = orogen::recipe::presets::DEFAULT)]
    recipe: PathBuf,
    #[command(flatten)]
    samples: SizedView,
    #[command(flatten)]
    options: OptionsOf<BlocksJob>,
    /// Format [default: by the extension of the output; a Luanti world if it has none]
    #[arg(long, value_parser = name_of::blocks())]
    format: Option<BlockFormat>,
    /// Output: .vox, .schem, .glb, .png, or a folder for a Luanti world or a save of Minecraft; - for standard output
    #[arg(short, long, value_name = "FILE|DIR", default_value = "blocks.vox")]
    out: PathBuf,
    #[command(flatten)]
    run: RunOptions,
}

/// Makes the blocks.
pub fn run(args: &Args) -> Result<(), Failure> {
    args.samples.each_output(&args.out, |samples, out| blocks(&Args { samples, out, ..args.clone() }))
}

fn blocks(args: &Args) -> Result<(), Failure> {
    let format = format(args)?;
    if format.is_folder() && is_stdout(&args.out) {
        return Err(Failure::Usage("this world has several files: name a folder with -o".into()));
    }
    let (bar, progress) = Bar::new(args.run.quiet);
    let made = make(args, format, &progress);
    drop(bar);
    made.map_err(|failure| interrupt::explain(failure, "nothing was written"))
}

/// The format: by its name, otherwise by the extension.
fn format(args: &Args) -> Result<BlockFormat, Failure> {
    match args.out.extension() {
        None if !is_stdout(&args.out) => Ok(args.format.unwrap_or(BlockFormat::Luanti)),
        _ => {
            let files = BlockFormat::FILES.map(|format| (format, format.name()));
            kind(&args.out, args.format, &files, "blocks are a folder for a Luanti world or a save of Minecraft, or a")
        }
    }
}

fn make(args: &Args, format: BlockFormat, progress: &Progress) -> Result<(), Failure> {
    let job = BlocksJob::new(format).with_options(&args.options.read()?)?;
    let Opened { mut recipe, budget, policy, .. } = args.run.read(&args.recipe, &args.samples.view)?;
    let view = BlocksJob::view(&args.samples.view.samples(args.samples.size)?, &recipe.world);
    // The classes of a recipe without its own classes depend on the cell of the map.
    let window = view.window(&args.run.limits.open(recipe.clone(), &budget)?, |_| ())?;
    job.prepare(&mut recipe, window.cell)?;
    let world = args.run.limits.open(recipe, &budget)?;
    let make = || -> Result<_, Failure> {
        let made = job.make(&world, &window, progress)?;
        finite::tell(HEIGHT, made.finite)?;
        Ok(made)
    };
    // Whether the output may be written is checked before the blocks are made.
    let made = if format.is_folder() {
        let folder = BlocksFolder::new(format, &args.out, &window, &policy)?;
        let made = make()?;
        made.to_folder(folder)?;
        made
    } else {
        let sink = Sink::new(&args.out, &policy)?;
        let made = make()?;
        sink.write(|out| made.to_stream(out))?;
        made
    };
    match args.run.quiet || is_stdout(&args.out) {
        true => Ok(()),
        false => say::out(&format!("{}: {}\n", args.out.display(), made.words())),
    }
}
