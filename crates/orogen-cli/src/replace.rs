//! `--force` and `--no-clobber`, common to all commands that write files.

use std::path::Path;

use orogen::io::file::{Existing, OutputPolicy};

/// The options `--force` and `--no-clobber`.
#[derive(Debug, Clone, Copy, clap::Args)]
#[command(next_help_heading = "Output")]
pub struct Replace {
    /// Replace existing files of any kind, not only files of the kind that is written
    #[arg(long)]
    pub force: bool,
    /// Do not replace existing files: fail if a file exists
    #[arg(short = 'n', long, conflicts_with = "force")]
    pub no_clobber: bool,
}

impl Replace {
    /// The policy of a command that reads `inputs`.
    pub fn policy<P: AsRef<Path>>(self, inputs: impl IntoIterator<Item = P>) -> OutputPolicy {
        let existing = match (self.no_clobber, self.force) {
            (true, _) => Existing::Keep,
            (_, true) => Existing::Replace,
            _ => Existing::SameKind,
        };
        OutputPolicy::new(existing).protecting(inputs)
    }

    /// The policy of a command that reads no files.
    pub fn anywhere(self) -> OutputPolicy {
        self.policy::<&Path>([])
    }
}
