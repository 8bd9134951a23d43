//! Failures of commands and exit codes.

use std::io;
use std::process::ExitCode;

use orogen::{Error, ErrorKind, io::file};

/// The failure of a command.
#[derive(Debug)]
pub enum Failure {
    /// The command line is not valid: exit code 2, like errors of clap.
    Usage(String),
    /// The command line could not be parsed: exit code 2.
    CommandLine(Box<clap::Error>),
    /// The command failed: exit code 1.
    Engine(Error),
    /// The command was interrupted by a signal, which determines the exit code.
    Interrupted { message: String, code: u8 },
    /// Everything has been reported already: exit code 1.
    Told,
    /// The reader of the output has closed the pipe; this is not an error and is not reported.
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
            Failure::Usage(_) | Failure::CommandLine(_) => ExitCode::from(2),
            Failure::Engine(error) if error.kind() == ErrorKind::Request => ExitCode::from(2),
            Failure::Engine(_) | Failure::Told => ExitCode::FAILURE,
            Failure::Interrupted { code, .. } => ExitCode::from(*code),
            Failure::BrokenPipe => ExitCode::SUCCESS,
        }
    }
}
