//! The registry of formats.

use std::path::Path;

use super::format::Format;
use super::formats;
use crate::options::{OptionSpec, Options, by_name};
use orogen_grid::error::{Error, ErrorKind, Result};
use orogen_grid::words::nearest;

static ALL: &[&Format] = include!("format_list.rs");

/// All formats, by name.
#[must_use]
pub fn all() -> &'static [&'static Format] {
    ALL
}

/// The format with this name or extension, ignoring case.
#[must_use]
pub fn named(name: &str) -> Option<&'static Format> {
    ALL.iter().copied().find(|format| format.extensions().any(|extension| extension.eq_ignore_ascii_case(name)))
}

/// The format for a path's extension.
///
/// # Errors
/// If the extension is missing or unknown: the message suggests the closest one, or lists all.
pub fn of_path(path: &Path) -> Result<&'static Format> {
    let refuse = |message: String| Err(Error::new(ErrorKind::Request, message));
    let Some(extension) = path.extension() else {
        return refuse(format!(
            "{} has no file extension that determines its format; known extensions: {}",
            path.display(),
            known(ALL)
        ));
    };
    let extension = extension.to_string_lossy();
    match named(&extension) {
        Some(format) => Ok(format),
        None => {
            let hint = match nearest(&extension, ALL.iter().flat_map(|format| format.extensions())) {
                Some(near) => format!("did you mean .{near}?"),
                None => format!("known extensions: {}", known(ALL)),
            };
            refuse(format!("unknown format .{extension}; {hint}"))
        }
    }
}

/// All options of all formats, by name, each with the formats that have it.
#[must_use]
pub fn options() -> Vec<(&'static OptionSpec, Vec<&'static Format>)> {
    by_name(ALL.iter().map(|format| (*format, format.options)))
}

/// Checks that a format has all given options.
///
/// # Errors
/// If it does not have one of them: the message names the formats that do.
pub fn check(format: &Format, given: &Options) -> Result<()> {
    let Some(name) = given.names().find(|name| !format.knows(name)) else { return Ok(()) };
    let who: Vec<&Format> = ALL.iter().copied().filter(|format| format.knows(name)).collect();
    let message = format!("--{name} does not apply to the format {}; it applies to: {}", format.name, known(&who));
    Err(Error::new(ErrorKind::Request, message))
}

/// A list such as ".npy, .png and .tif".
fn known(formats: &[&Format]) -> String {
    let names: Vec<String> = formats.iter().map(|format| format!(".{}", format.name)).collect();
    match names.as_slice() {
        [init @ .., last] if !init.is_empty() => format!("{} and {last}", init.join(", ")),
        names => names.concat(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_two_formats_share_an_extension() {
        let mut extensions: Vec<&str> = ALL.iter().flat_map(|format| format.extensions()).collect();
        let count = extensions.len();
        extensions.sort_unstable();
        extensions.dedup();
        assert_eq!(extensions.len(), count);
        assert!(extensions.iter().all(|extension| *extension == extension.to_ascii_lowercase()));
    }

    #[test]
    fn an_option_is_the_same_wherever_it_is_known() {
        for (spec, formats) in options() {
            for format in formats {
                let own = format.options.iter().find(|own| own.name == spec.name).unwrap();
                assert_eq!(own, spec, "{} of {}", spec.name, format.name);
            }
        }
    }

    #[test]
    fn extensions_tell_formats() {
        assert_eq!(of_path(Path::new("a/b.PNG")).unwrap().name, "png");
        assert_eq!(of_path(Path::new("b.tiff")).unwrap().name, "tif");
        for (path, expect) in
            [("a.npz", "did you mean .npy?"), ("a.qqqqqq", "known extensions: ."), ("a", "no file extension")]
        {
            let Err(error) = of_path(Path::new(path)) else { panic!("{path}") };
            assert!(error.to_string().contains(expect), "{error}");
        }
    }
}
