//! How a command ends when it does not succeed.

use std::io;
use std::process::ExitCode;

use orogen::{Error, ErrorKind, file};

/// What a process ends with that was interrupted: 128 and the number of the signal, as shells count it.
pub const INTERRUPTED: u8 = 130;

/// Why a command did not do what it was asked to.
#[derive(Debug)]
pub enum Failure {
    /// The command line asks for something that cannot be: exit code 2, as for what clap refuses.
    Usage(String),
    /// It could be asked for, but did not succeed: exit code 1.
    Engine(Error),
    /// Somebody asked it to stop before it was done: exit code [`INTERRUPTED`].
    Interrupted(String),
    /// Everything has been told already: exit code 1.
    Told,
    /// Whoever read our output has had enough of it: no failure of ours, and nothing to tell.
    BrokenPipe,
}

impl From<Error> for Failure {
    fn from(error: Error) -> Failure {
        Failure::Engine(error)
    }
}

impl Failure {
    /// A failure to write to standard output.
    pub fn stdout(cause: &io::Error) -> Failure {
        match cause.kind() {
            io::ErrorKind::BrokenPipe => Failure::BrokenPipe,
            _ => Failure::Engine(file::explain("write to", std::path::Path::new("standard output"), cause)),
        }
    }

    /// What the process ends with. A request that the world cannot meet is a matter of usage.
    pub fn code(&self) -> ExitCode {
        match self {
            Failure::Usage(_) => ExitCode::from(2),
            Failure::Engine(error) if error.kind() == ErrorKind::Request => ExitCode::from(2),
            Failure::Engine(_) | Failure::Told => ExitCode::FAILURE,
            Failure::Interrupted(_) => ExitCode::from(INTERRUPTED),
            Failure::BrokenPipe => ExitCode::SUCCESS,
        }
    }
}
