//! Failures of commands and exit codes.

use std::io;
use std::process::ExitCode;

use orogen::{Error, ErrorKind, file};

/// Exit code of an interrupted process: 128 plus the number of the signal, as in shells.
pub const INTERRUPTED: u8 = 130;

/// The failure of a command.
#[derive(Debug)]
pub enum Failure {
    /// The command line is not valid: exit code 2, like errors of clap.
    Usage(String),
    /// The command failed: exit code 1.
    Engine(Error),
    /// The command was interrupted: exit code [`INTERRUPTED`].
    Interrupted(String),
    /// Everything has been reported already: exit code 1.
    Told,
    /// The reader of our output has closed the pipe: no error, and nothing to report.
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

    /// The exit code of the process. A request that the world cannot satisfy counts as a usage error.
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
