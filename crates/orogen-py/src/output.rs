//! Files that are written.

use std::path::Path;

use orogen::io::file::{Existing, OutputPolicy};
use orogen::{Error, ErrorKind, Result};

/// The files that may be replaced: by default those of the same kind, otherwise any or none.
pub fn policy(overwrite: Option<bool>) -> OutputPolicy {
    OutputPolicy::new(match overwrite {
        None => Existing::SameKind,
        Some(true) => Existing::Replace,
        Some(false) => Existing::Keep,
    })
}

/// The choice whose name is the extension of a file.
pub fn by_extension<T: Copy>(path: &Path, choices: &[(T, &str)], what: &str) -> Result<T> {
    let extension = path.extension().map(|extension| extension.to_string_lossy().to_lowercase()).unwrap_or_default();
    let found = choices.iter().find(|(_, name)| *name == extension).map(|(choice, _)| *choice);
    found.ok_or_else(|| {
        let names: Vec<String> = choices.iter().map(|(_, name)| format!(".{name}")).collect();
        let message = format!("{what} has one of the extensions {}; not `{}`", names.join(", "), path.display());
        Error::new(ErrorKind::Request, message)
    })
}
