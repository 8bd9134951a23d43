//! `orogen new`.

use std::path::PathBuf;

use orogen::io::file::{self, Existing, OutputPolicy};
use orogen::recipe::presets;
use orogen::{Error, ErrorKind};

use crate::failure::Failure;
use crate::sink::is_stdout;
use crate::{say, source};

/// Arguments of the command.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// Name of the new recipe: NAME.toml is written; - is standard output
    name: PathBuf,
    /// The preset to start from
    #[arg(long, value_name = "PRESET", default_value = presets::DEFAULT)]
    preset: String,
}

/// Writes the recipe, never over another file.
pub fn run(args: &Args) -> Result<(), Failure> {
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
