//! Definition of formats.

use std::io;

use super::files::Files;
use super::layer_source::LayerSource;
use crate::options::{OptionSpec, Options};
use orogen_grid::error::{Error, ErrorKind};
use orogen_grid::grid::Window;

/// Writes a source with the options of a format, and returns the end of the final message.
pub type Writer = fn(&mut LayerSource, &Options, &mut Files) -> io::Result<String>;

/// A file format. Each format is declared in its own file in `formats/`.
#[derive(Debug)]
pub struct Format {
    /// The name, which is also the first extension.
    pub name: &'static str,
    /// Other extensions.
    pub aliases: &'static [&'static str],
    /// A one-line description.
    pub about: &'static str,
    /// The options of the format.
    pub options: &'static [OptionSpec],
    /// Maximum number of channels: 1 for formats of plain numbers, more for formats that also hold normals or weights.
    pub channels: usize,
    /// Whether it holds vector features.
    pub features: bool,
    /// Memory for writing a window in addition to the current rows, in bytes. A format that uses [`LayerSource::whole`]
    /// includes it here.
    pub memory: fn(&Window, &Options) -> u64,
    /// Writes the file, and returns a description of the samples or of their number: the end of the message "height, 64
    /// x 48 samples of 10 m, ...".
    ///
    /// Fails if the source or the files fail.
    pub write: Writer,
}

impl Format {
    /// The extensions, the name first.
    pub fn extensions(&self) -> impl Iterator<Item = &'static str> + use<> {
        std::iter::once(self.name).chain(self.aliases.iter().copied())
    }

    /// Whether the format has an option with this name.
    #[must_use]
    pub fn knows(&self, option: &str) -> bool {
        self.options.iter().any(|spec| spec.name == option)
    }
}

/// An error for a request that the format does not support.
pub fn refuse<T>(message: String) -> io::Result<T> {
    Err(Error::new(ErrorKind::Request, message).into())
}
