//! `orogen completions`.

use clap_complete::Shell;

use crate::failure::Failure;
use crate::say;

/// Arguments of the command.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// The shell
    shell: Shell,
}

/// Prints the completion script of `command`.
pub fn run(args: &Args, mut command: clap::Command) -> Result<(), Failure> {
    let mut script = Vec::new();
    clap_complete::generate(args.shell, &mut command, "orogen", &mut script);
    say::out(&String::from_utf8_lossy(&script))
}
