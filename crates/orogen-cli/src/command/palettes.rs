//! `orogen palettes`.

use std::path::PathBuf;

use orogen::io::palette::{named, read};
use orogen::output::map::swatches::{self, Swatch};

use crate::failure::Failure;
use crate::replace::Replace;
use crate::say;
use crate::sink::{Sink, check_png};

/// Arguments of the command.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// Palette files to show as well: .cpt, .gpl, .toml, or gdaldem color files
    files: Vec<PathBuf>,
    /// Picture of all palettes to write (.png)
    #[arg(short, long, value_name = "FILE")]
    out: Option<PathBuf>,
    #[command(flatten)]
    replace: Replace,
    /// Do not print the list
    #[arg(short, long, help_heading = "Output")]
    quiet: bool,
}

/// Lists the palettes, and draws them.
pub fn run(args: &Args) -> Result<(), Failure> {
    args.out.as_ref().map_or(Ok(()), |out| check_png(out, "the page"))?;
    let policy = args.replace.policy(&args.files);
    let sink = args.out.as_ref().map(|out| Sink::new(out, &policy)).transpose()?;
    let mut shown: Vec<Swatch> = named::all()
        .iter()
        .map(|named| Swatch { palette: named.palette(), about: named.about.into(), safe: named.safe })
        .collect();
    for path in &args.files {
        let palette = read(path)?;
        shown.push(Swatch { about: path.display().to_string(), palette, safe: false });
    }
    if let Some(sink) = &sink {
        sink.picture(&swatches::draw(&shown)?)?;
    }
    if args.quiet || matches!(sink, Some(Sink::Stdout)) {
        return Ok(());
    }
    let longest = shown.iter().map(|swatch| swatch.palette.name.chars().count()).max().unwrap_or(0);
    let mut text = String::new();
    for Swatch { palette, about, safe } in &shown {
        let mark = if *safe { "*" } else { " " };
        text.push_str(&format!("{:longest$} {mark} {about}\n", palette.name));
    }
    text.push_str("\n* distinguishable by color-blind readers\n");
    say::out(&text)
}
