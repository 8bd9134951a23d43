//! The formats of what is drawn without the registry of exports, known by their extensions.

use std::path::Path;

use orogen::nearest;

/// What can be written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Format {
    /// NumPy array of f32
    Npy,
    /// A picture
    Png,
}

impl Format {
    /// All there are.
    pub const ALL: &[Format] = &[Format::Npy, Format::Png];

    /// Its name, which is also its extension.
    pub fn name(self) -> &'static str {
        match self {
            Format::Npy => "npy",
            Format::Png => "png",
        }
    }

    /// Whether files of this format have such an extension.
    fn has(self, extension: &str) -> bool {
        extension.eq_ignore_ascii_case(self.name())
    }

    /// The one of `formats` that the extension of `path` tells, or a message that says why it tells none.
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
