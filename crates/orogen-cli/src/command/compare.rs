//! `orogen compare`.

use std::path::PathBuf;

use orogen::output::noise_pictures::{page, row};

use crate::bar::Bar;
use crate::failure::Failure;
use crate::interrupt;
use crate::options::DrawOptions;
use crate::sink::{Sink, check_png};
use crate::values::number::seed;

/// Arguments of the command.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// Picture to write (.png)
    #[arg(short, long, value_name = "FILE", default_value = "compare.png")]
    out: PathBuf,
    /// Seed of all noises
    #[arg(long, value_name = "N", value_parser = seed, default_value = "4", allow_negative_numbers = true)]
    seed: u64,
    /// Samples along each side of each picture on the page; it sets the size of the page
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(120..=4000), default_value = "200",
          allow_negative_numbers = true)]
    size: u16,
    #[command(flatten)]
    options: DrawOptions,
    /// Print no summary
    #[arg(short, long, help_heading = "Output")]
    quiet: bool,
}

/// Draws the page.
pub fn run(args: &Args) -> Result<(), Failure> {
    check_png(&args.out, "the page")?;
    let sink = Sink::new(&args.out, &args.options.replace.anywhere())?;
    let (rows, side) = (row::rows(args.seed), usize::from(args.size));
    let [width, height] = page::size(rows.len(), side);
    // The page, and for each noise its pictures, its heights twice and their inputs.
    let noises: usize = rows.iter().map(|row| row.noises.len()).sum();
    args.options.budget().afford((3 * width * height + noises * side * side * 24) as u64)?;
    let (bar, progress) = Bar::new(args.quiet);
    let stopped = |error: orogen::Error| interrupt::explain(error.into(), "nothing was written");
    let [drawing, writing] = progress.parts([4.0, 1.0]);
    let page = page::draw(&rows, side, args.seed, &drawing).map_err(stopped)?;
    sink.picture(&page)?;
    writing.finish();
    drop(bar);
    let words = format!(
        "{}: {noises} noises and aggregates of seed {}, each as heights and as hillshade; {width} x {height} pixels\n",
        args.out.display(),
        args.seed
    );
    sink.tell(args.quiet, &words)
}
