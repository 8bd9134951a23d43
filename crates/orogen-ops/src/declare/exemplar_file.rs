//! A file of heights or a picture whose texture is spread.

use std::sync::Arc;

use super::memo::Memo;
use super::param::Param;
use super::spec::Shape;
use crate::value::Value;
use orogen_grid::exemplar::{Exemplar, Texture};
use orogen_io::dem::file_ref::{FileKind, FileRef};
use orogen_io::dem::prepared::PreparedDem;

/// A file of heights, or a grayscale picture (.png), with the texture that was made of it.
#[derive(Debug, Clone, PartialEq)]
pub struct ExemplarFile {
    file: FileRef,
    texture: Memo<Made>,
}

/// A texture, with the content and the options from which it was made.
struct Made {
    ground: Arc<PreparedDem>,
    options: Exemplar,
    texture: Option<Arc<Texture>>,
}

impl Default for ExemplarFile {
    fn default() -> ExemplarFile {
        ExemplarFile::from("")
    }
}

impl From<&str> for ExemplarFile {
    fn from(path: &str) -> ExemplarFile {
        ExemplarFile { file: FileRef::from(path).with_kind(FileKind::Exemplar), texture: Memo::default() }
    }
}

impl ExemplarFile {
    /// The file.
    #[must_use]
    pub fn file(&self) -> &FileRef {
        &self.file
    }

    /// The texture of the file. `None` if the file was not read, or is too small. It is made once, and again only for
    /// other options.
    #[must_use]
    pub fn texture(&self, options: Exemplar) -> Option<Arc<Texture>> {
        let ground = self.file.ground()?;
        let is_current = |made: &Made| Arc::ptr_eq(&made.ground, ground) && made.options == options;
        let make =
            || Made { ground: Arc::clone(ground), options, texture: options.prepare(&ground.grid).map(Arc::new) };
        self.texture.get_or_make(is_current, make).texture.clone()
    }
}

impl Param for ExemplarFile {
    const SHAPE: Shape = Shape::File;
    fn read(value: &Value) -> Option<ExemplarFile> {
        match value {
            Value::Text(path) => Some(ExemplarFile::from(path.as_str())),
            _ => None,
        }
    }
    fn write(&self) -> Value {
        self.file.write()
    }
    fn key(&self) -> Value {
        self.file.key()
    }
    fn file(&mut self) -> Option<&mut FileRef> {
        Some(&mut self.file)
    }
}
