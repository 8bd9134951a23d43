//! `orogen fit`.

use std::path::PathBuf;

use orogen::fit::FitJob;
use orogen::io::dem::PreparedDem;
use orogen::io::dem::prepared::DEFAULT_MEMORY;
use orogen::io::file::mark;

use crate::bar::Bar;
use crate::declared::OptionsOf;
use crate::failure::Failure;
use crate::options::RunOptions;
use crate::sink::{Sink, is_stdout};
use crate::{finite, interrupt, say};

/// Arguments of the command.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// A file of heights (GeoTIFF, .asc, .hgt, ...)
    place: PathBuf,
    /// Recipe to write (.toml), or - for standard output; files that were written or edited by hand are not replaced
    #[arg(short, long, value_name = "FILE")]
    out: PathBuf,
    #[command(flatten)]
    options: OptionsOf<FitJob>,
    #[command(flatten)]
    run: RunOptions,
    /// Print the report as JSON
    #[arg(long)]
    json: bool,
}

/// Finds a recipe, compares it with the default preset in worlds of other seeds, and writes it.
pub fn run(args: &Args) -> Result<(), Failure> {
    if !is_stdout(&args.out) && args.out.extension().is_none_or(|extension| extension != "toml") {
        return Err(Failure::Usage(format!(
            "{} is not a name for a recipe; use the extension .toml",
            args.out.display()
        )));
    }
    let job = FitJob::new(&args.options.read()?);
    let sink = Sink::new(&args.out, &args.run.replace.policy([&args.place]))?;
    let budget = args.run.limits.budget();
    let place = PreparedDem::read(&args.place, None, budget.left().unwrap_or(DEFAULT_MEMORY))?;
    budget.reserve(place.memory())?.keep();
    if !args.run.quiet {
        place.notes.iter().for_each(|note| say::error(&format!("note: {}: {note}", args.place.display())));
    }
    finite::check("place", &place.grid)?;
    let name = args.place.file_stem().unwrap_or_default().to_string_lossy();
    let limits = args.run.limits.options(&budget);
    let (bar, progress) = Bar::new(args.run.quiet);
    let fit = job
        .run(&place.grid, &name, &limits, &progress)
        .map_err(|error| interrupt::explain(error.into(), "no recipe was written"))?;
    drop(bar);
    sink.write(|out| out.write_all(mark::marked(&fit.recipe.to_toml()).as_bytes()))?;
    let text = match (args.json, args.run.quiet) {
        (true, _) => fit.report.to_json(),
        (false, true) => return Ok(()),
        (false, false) => {
            let (out, word) = (args.out.display(), say::word(&args.out));
            format!("{out}: {}\nmake it:  orogen generate {word}\n", fit.report.words())
        }
    };
    match sink {
        // The recipe occupies standard output.
        Sink::Stdout => say::error(text.trim_end()),
        Sink::File(_) => say::out(&text)?,
    }
    Ok(())
}
