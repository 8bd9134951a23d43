//! `orogen new`.

use std::io;
use std::path::{Path, PathBuf};

use orogen::author_map::{self, AuthorMapJob};
use orogen::io::file::{self, Existing, OutputPolicy};
use orogen::io::format::fmg::FmgMap;
use orogen::recipe::presets;
use orogen::{Error, ErrorKind, Options};

use crate::bar::Bar;
use crate::failure::Failure;
use crate::sink::{DASH, is_stdout};
use crate::values::bytes::Bytes;
use crate::values::number::{kilometres, seed};
use crate::{interrupt, memory, say, source};

/// Arguments of the command.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// Name of the new recipe: NAME.toml is written; - is standard output
    name: PathBuf,
    /// The preset to start from
    #[arg(long, value_name = "PRESET", default_value = presets::DEFAULT, conflicts_with = "map")]
    preset: String,
    /// Make the world of a map that Azgaar's Fantasy Map Generator has exported to JSON (`full`): its coast, heights,
    /// rain, rivers, lakes and names are written to the folder NAME; - is standard input
    #[arg(long, value_name = "FILE")]
    map: Option<PathBuf>,
    /// Width of the map in kilometres [default: by the scale of the map]
    #[arg(long, value_name = "KM", requires = "map", value_parser = kilometres, allow_negative_numbers = true)]
    width: Option<f64>,
    /// Seed of the world of a map [default: the seed of the map]
    #[arg(long, value_name = "N", requires = "map", value_parser = seed, allow_negative_numbers = true)]
    seed: Option<u64>,
    /// Memory limit of the program, such as 512MiB or 2GiB [default: half of the free memory]
    #[arg(long, value_name = "BYTES", requires = "map")]
    memory: Option<Bytes>,
}

/// Writes the recipe, never over another file.
pub fn run(args: &Args) -> Result<(), Failure> {
    if let Some(map) = &args.map {
        return author_map(args, map);
    }
    let preset = source::preset(&args.preset)?;
    if is_stdout(&args.name) {
        return say::out(preset.text);
    }
    let path = path(args)?;
    if path.symlink_metadata().is_ok() {
        let message = format!("{} already exists and is left unchanged; choose another name", path.display());
        return Err(Error::new(ErrorKind::File, message).into());
    }
    let output = OutputPolicy::new(Existing::Keep).output(&path)?;
    file::write_whole(&output, |out| out.write_all(preset.text.as_bytes()))?;
    say::out(&format!(
        "wrote {}, a copy of the preset {}\nmake it:             orogen generate {}\n\
         help in an editor:   orogen schema > orogen.schema.json\n",
        path.display(),
        preset.name,
        say::word(&path)
    ))
}

/// Makes a world of a map, and writes its recipe and the files that it reads.
fn author_map(args: &Args, map: &Path) -> Result<(), Failure> {
    if is_stdout(&args.name) {
        let why = "the world of a map has several files; give a name in place of `-`";
        return Err(Failure::Usage(why.into()));
    }
    let path = path(args)?;
    let folder = path.with_extension("");
    author_map::check_new(&path, &folder)?;
    let budget = memory::budget(args.memory, memory::cores());
    let limits = Options { threads: Some(memory::cores()), memory: budget, ..Options::default() };
    let job = AuthorMapJob::new().with_width(args.width).with_seed(args.seed);
    let name = folder.file_name().unwrap_or_default().to_string_lossy();
    let (bar, progress) = Bar::new(false);
    let is_stdin = map == Path::new(DASH);
    let shown = if is_stdin { source::STDIN.into() } else { map.display().to_string() };
    let read = match is_stdin {
        true => FmgMap::read_from(&mut io::stdin().lock(), &shown, args.width),
        false => FmgMap::read(map, args.width),
    };
    let world = read
        .and_then(|map| job.run_on(map, &name, &limits, &progress))
        .map_err(|error| interrupt::explain(error.into(), "no files were written"))?;
    drop(bar);
    world.write(&path, &folder, &OutputPolicy::new(Existing::Keep))?;
    world.map.notes.iter().for_each(|note| say::error(&format!("note: {shown}: {note}")));
    let (word, places) = (say::word(&path), say::word(&folder.join("places.csv")));
    say::out(&format!(
        "wrote {} and the files in {}\n{}\nmake it:             orogen generate {word}\n\
         draw a map:          orogen map {word} --names {places} -o map.png\n",
        path.display(),
        folder.display(),
        world.words(),
    ))
}

/// The path NAME.toml, in the folder that is part of the name.
fn path(args: &Args) -> Result<PathBuf, Failure> {
    let Some(name) = args.name.file_name() else {
        return Err(Failure::Usage(format!("`{}` is not a file name", args.name.display())));
    };
    if args.name.extension().is_some_and(|extension| extension == "toml") {
        return Ok(args.name.clone());
    }
    let mut name = name.to_os_string();
    name.push(".toml");
    Ok(args.name.with_file_name(name))
}
