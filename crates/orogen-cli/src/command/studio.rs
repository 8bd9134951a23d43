//! `orogen studio`.

use std::ffi::OsString;
use std::io;
use std::path::PathBuf;
use std::process::Command;

use orogen::device_choice::DeviceChoice;
use orogen::{Error, ErrorKind};

use crate::failure::Failure;
use crate::source::Source;

/// Arguments of the command.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// A recipe file, the name of a preset, or a file of heights (GeoTIFF, .asc, .hgt, ...) [default: a page of
    /// presets]
    recipe: Option<PathBuf>,
    /// Where previews are computed: cpu, gpu, gpu:NAME or auto; exports are always computed by the processor
    #[arg(long, value_name = "DEVICE", default_value_t)]
    device: DeviceChoice,
}

/// The name of the studio's program.
const PROGRAM: &str = "orogen-studio";

/// Starts the studio, and waits until its window is closed.
pub fn run(args: &Args) -> Result<(), Failure> {
    // A name that is neither a file nor a preset is reported here, where it was typed.
    if let Some(Source::Stdin) = args.recipe.as_deref().map(Source::find).transpose()? {
        return Err(Failure::Usage("the studio opens files and presets, not standard input; name a file".into()));
    }
    match Command::new(program()).arg("--device").arg(args.device.to_string()).args(&args.recipe).status() {
        Ok(status) if status.success() => Ok(()),
        // The studio has already reported its error.
        Ok(_) => Err(Failure::Told),
        Err(cause) if cause.kind() == io::ErrorKind::NotFound => Err(Error::new(
            ErrorKind::File,
            format!(
                "the program {PROGRAM} is not beside `orogen` or on the path; build it with `cargo build --release -p {PROGRAM}`, or install it with \
                 `cargo install --path crates/{PROGRAM}`"
            ),
        )
        .into()),
        Err(cause) => Err(Error::new(ErrorKind::File, format!("cannot start {PROGRAM}: {cause}")).with_source(&cause).into()),
    }
}

/// The studio's program in the folder of this program, otherwise on the search path.
fn program() -> OsString {
    let name = format!("{PROGRAM}{}", std::env::consts::EXE_SUFFIX);
    let beside = std::env::current_exe().ok().map(|own| own.with_file_name(&name)).filter(|path| path.is_file());
    beside.map_or_else(|| name.into(), PathBuf::into_os_string)
}
