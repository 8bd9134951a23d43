//! What a format is.

use std::io;

use super::files::Files;
use super::layer_source::LayerSource;
use super::options::{OptionSpec, Options};
use orogen_grid::error::{Error, ErrorKind};
use orogen_grid::grid::Window;

/// A format of files, declared in a file of its own in `formats/`.
pub struct Format {
    /// Its name, which is also its first extension.
    pub name: &'static str,
    /// Other extensions that its files have.
    pub aliases: &'static [&'static str],
    /// One line for a list of formats.
    pub about: &'static str,
    /// The options it knows.
    pub options: &'static [OptionSpec],
    /// The most channels that it holds: 1 where it is a layer of plain numbers, more where normals or weights go in, too.
    pub channels: usize,
    /// Whether it holds vector features.
    pub features: bool,
    /// Bytes that writing such a window holds beside the rows at hand. A format that asks for the [whole](LayerSource::whole) counts it
    /// here.
    pub memory: fn(&Window, &Options) -> u64,
    /// Writes it, and says what its samples stand for, or how much there is of what it makes of them: the end of the message
    /// "height, 64 x 48 samples of 10 m, ...".
    ///
    /// Fails as the subject and the files do.
    pub write: fn(&mut LayerSource, &Options, &mut Files) -> io::Result<String>,
}

impl Format {
    /// Its extensions, its name first.
    pub fn extensions(&self) -> impl Iterator<Item = &'static str> + use<> {
        std::iter::once(self.name).chain(self.aliases.iter().copied())
    }

    /// Whether it has an option of that name.
    pub fn knows(&self, option: &str) -> bool {
        self.options.iter().any(|spec| spec.name == option)
    }
}

/// A request that a format cannot meet, in a message.
pub fn refuse<T>(message: String) -> io::Result<T> {
    Err(Error::new(ErrorKind::Request, message).into())
}
