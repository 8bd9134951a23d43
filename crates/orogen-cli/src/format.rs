//! The formats of files that hold one layer, known by their extensions.

use std::path::Path;

use clap::ValueEnum;
use orogen::nearest;

/// What can be written.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum Format {
    /// NumPy array of f32, the layer's own unit (metres for heights)
    Npy,
    /// 16-bit grey picture, black the lowest and white the highest of the window
    Png,
}

impl Format {
    const ALL: [Format; 2] = [Format::Npy, Format::Png];

    /// Its name, which is also its extension.
    pub fn name(self) -> &'static str {
        match self {
            Format::Npy => "npy",
            Format::Png => "png",
        }
    }

    /// The format that the extension of `path` tells, or a sentence that says why it tells none.
    pub fn of(path: &Path) -> Result<Format, String> {
        let Some(extension) = path.extension() else {
            return Err(format!("{} has no extension to tell its format; known are {}", path.display(), list()));
        };
        let extension = extension.to_string_lossy();
        let known = Format::ALL.into_iter().find(|format| extension.eq_ignore_ascii_case(format.name()));
        known.ok_or_else(|| {
            let hint = match nearest(&extension, Format::ALL.map(Format::name)) {
                Some(near) => format!("did you mean .{near}?"),
                None => format!("known are {}", list()),
            };
            format!("the format .{extension} is not known; {hint}")
        })
    }
}

fn list() -> String {
    Format::ALL.map(|format| format!(".{}", format.name())).join(" and ")
}
