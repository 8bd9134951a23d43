//! Formats of commands that do not use the export registry, known by their extensions.

use std::path::Path;

use orogen::grid::words::nearest;

/// A format.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Format {
    /// NumPy array of f32
    Npy,
    /// A picture
    Png,
}

impl Format {
    /// All formats.
    pub const ALL: &[Format] = &[Format::Npy, Format::Png];

    /// The name, which is also the extension.
    pub fn name(self) -> &'static str {
        match self {
            Format::Npy => "npy",
            Format::Png => "png",
        }
    }

    /// Whether the format has this extension.
    fn has(self, extension: &str) -> bool {
        extension.eq_ignore_ascii_case(self.name())
    }

    /// The format among `formats` for the extension of `path`, or an error message.
    pub fn of(path: &Path, formats: &[Format]) -> Result<Format, String> {
        let Some(extension) = path.extension() else {
            return Err(format!(
                "{} has no file extension that determines its format; known extensions: {}",
                path.display(),
                list(formats)
            ));
        };
        let extension = extension.to_string_lossy();
        formats.iter().copied().find(|format| format.has(&extension)).ok_or_else(|| {
            let hint = match nearest(&extension, formats.iter().map(|format| format.name())) {
                Some(near) => format!("did you mean .{near}?"),
                None => format!("known extensions: {}", list(formats)),
            };
            format!("unknown format .{extension}; {hint}")
        })
    }
}

fn list(formats: &[Format]) -> String {
    let names: Vec<String> = formats.iter().map(|format| format!(".{}", format.name())).collect();
    match names.as_slice() {
        [init @ .., last] if !init.is_empty() => format!("{} and {last}", init.join(", ")),
        names => names.concat(),
    }
}
