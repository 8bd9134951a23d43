//! A file named by a recipe, and its content.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use super::dem_file::DemFile;
use super::prepared::PreparedDem;
use crate::format::drawing::{Drawing, file_and_layer, named};
use crate::format::network::NetworkWeights;
use crate::format::outlines::DrawingKind;
use crate::fs;
use orogen_grid::error::{Location, Result};
use orogen_grid::learned::Network;

/// A file of heights, or of another kind, named by a recipe. Its content is read once, when the world is opened; from a
/// large file of heights, windows are read when they are requested.
#[derive(Debug, Clone, Default)]
pub struct FileRef {
    path: String,
    folder: Option<PathBuf>,
    ground: Option<Arc<PreparedDem>>,
    /// The file from which windows are read; then `ground` has no heights.
    dem_file: Option<Arc<DemFile>>,
    drawing: Option<Arc<Drawing>>,
    network: Option<Arc<NetworkWeights>>,
    kind: FileKind,
    /// The location in the recipe's text where the file is named.
    location: Option<Box<Location>>,
}

/// What a file is read as.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, PartialOrd, Ord)]
pub enum FileKind {
    /// Heights.
    #[default]
    Heights,
    /// A grayscale picture.
    Picture,
    /// A grayscale picture if it is a .png, otherwise heights, of which no part is enough.
    Exemplar,
    /// Lines or areas.
    Drawing(DrawingKind),
    /// A network for learned detail.
    Network,
}

/// A grayscale picture named by a recipe. Its content is numbers from 0 (black) to 1 (white), one metre apart.
#[derive(Debug, Clone, PartialEq)]
pub struct Picture(pub FileRef);

impl Default for Picture {
    fn default() -> Picture {
        Picture::from("")
    }
}

impl From<&str> for Picture {
    fn from(path: &str) -> Picture {
        Picture(FileRef { kind: FileKind::Picture, ..FileRef::from(path) })
    }
}

/// A file of lines named by a recipe.
#[derive(Debug, Clone, PartialEq)]
pub struct LineFile(pub FileRef);

impl Default for LineFile {
    fn default() -> LineFile {
        LineFile::from("")
    }
}

impl From<&str> for LineFile {
    fn from(path: &str) -> LineFile {
        LineFile(FileRef { kind: FileKind::Drawing(DrawingKind::Lines), ..FileRef::from(path) })
    }
}

/// A file of ridges and summits named by a recipe.
#[derive(Debug, Clone, PartialEq)]
#[doc(hidden)]
pub struct RidgeFile(pub Box<FileRef>);

impl Default for RidgeFile {
    fn default() -> RidgeFile {
        RidgeFile::from("")
    }
}

impl From<&str> for RidgeFile {
    fn from(path: &str) -> RidgeFile {
        RidgeFile(Box::new(FileRef { kind: FileKind::Drawing(DrawingKind::Ridges), ..FileRef::from(path) }))
    }
}

/// A file of areas named by a recipe.
#[derive(Debug, Clone, PartialEq)]
pub struct AreaFile(pub FileRef);

impl Default for AreaFile {
    fn default() -> AreaFile {
        AreaFile::from("")
    }
}

impl From<&str> for AreaFile {
    fn from(path: &str) -> AreaFile {
        AreaFile(FileRef { kind: FileKind::Drawing(DrawingKind::Areas), ..FileRef::from(path) })
    }
}

/// A file with a network, named by a recipe. Without a file it is the network that is part of the program.
#[derive(Debug, Clone, PartialEq)]
pub struct NetworkFile(pub FileRef);

impl Default for NetworkFile {
    fn default() -> NetworkFile {
        NetworkFile::from("")
    }
}

impl From<&str> for NetworkFile {
    fn from(path: &str) -> NetworkFile {
        NetworkFile(FileRef { kind: FileKind::Network, ..FileRef::from(path) })
    }
}

impl NetworkFile {
    /// The network. Before the file was read, it is the one that is part of the program.
    ///
    /// # Errors
    /// If the program was built with a broken file of weights.
    pub fn network(&self) -> Result<&Network> {
        match &self.0.network {
            Some(read) => Ok(&read.network),
            None => Network::built_in(),
        }
    }

    /// The network of `hillslopes`. Before the file was read, it is the one that is part of the program.
    ///
    /// # Errors
    /// If the program was built with a broken file of weights.
    pub fn network_of_rivers(&self) -> Result<&Network> {
        match &self.0.network {
            Some(read) => Ok(&read.network),
            None => Network::built_in_of_rivers(),
        }
    }
}

/// Equality compares the names of files and layers, not their content.
impl PartialEq for FileRef {
    fn eq(&self, other: &FileRef) -> bool {
        self.path() == other.path() && self.layer() == other.layer()
    }
}

impl From<&str> for FileRef {
    fn from(path: &str) -> FileRef {
        FileRef { path: path.to_string(), ..FileRef::default() }
    }
}

impl FileRef {
    /// Whether no file is named.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.path.is_empty()
    }

    /// A file of this kind.
    #[doc(hidden)]
    #[must_use]
    pub fn with_kind(self, kind: FileKind) -> FileRef {
        FileRef { kind, ..self }
    }

    /// What the file is read as.
    #[must_use]
    pub fn kind(&self) -> FileKind {
        self.kind
    }

    /// What the content of the file is: heights, a picture or a drawing.
    #[doc(hidden)]
    #[must_use]
    pub fn content(&self) -> FileKind {
        let is_png = Path::new(&self.path).extension().is_some_and(|extension| extension.eq_ignore_ascii_case("png"));
        match self.kind {
            FileKind::Exemplar if is_png => FileKind::Picture,
            FileKind::Exemplar => FileKind::Heights,
            kind => kind,
        }
    }

    /// The path: a relative one is relative to the folder of the recipe or, if the recipe is not a file, to the working
    /// folder.
    #[must_use]
    pub fn path(&self) -> PathBuf {
        let (file, _) = self.parts();
        match &self.folder {
            Some(folder) => fs::joined(folder, file),
            None => PathBuf::from(file),
        }
    }

    /// The layer of a GeoPackage, if one is named after the file.
    #[must_use]
    pub fn layer(&self) -> Option<&str> {
        self.parts().1
    }

    fn parts(&self) -> (&str, Option<&str>) {
        match self.kind {
            FileKind::Drawing(_) => file_and_layer(&self.path),
            FileKind::Heights | FileKind::Picture | FileKind::Exemplar | FileKind::Network => (&self.path, None),
        }
    }

    /// The file name for a recipe that may be stored in any folder.
    #[must_use]
    pub fn text(&self) -> String {
        match &self.folder {
            // No file.
            _ if self.path.is_empty() => String::new(),
            Some(_) => {
                let path = match self.path() {
                    path if fs::is_remote(&path) => path,
                    path => std::path::absolute(&path).unwrap_or(path),
                };
                named(&path.display().to_string(), self.layer())
            }
            None => self.path.clone(),
        }
    }

    /// Sets the folder of the recipe.
    pub fn set_base_dir(&mut self, folder: &Path) {
        self.folder = Some(folder.to_path_buf());
    }

    /// The location in the recipe's text where the file is named, if there is one.
    #[must_use]
    pub fn location(&self) -> Option<&Location> {
        self.location.as_deref()
    }

    /// Sets the location in the recipe's text.
    pub fn set_location(&mut self, location: Location) {
        self.location = Some(Box::new(location));
    }

    /// The heights or the picture, if they were read.
    #[must_use]
    pub fn ground(&self) -> Option<&Arc<PreparedDem>> {
        self.ground.as_ref()
    }

    /// Sets the heights or the picture.
    pub fn hold(&mut self, ground: Arc<PreparedDem>) {
        self.ground = Some(ground);
        self.dem_file = None;
    }

    /// The file from which windows are read, if its heights were not read.
    #[doc(hidden)]
    #[must_use]
    pub fn dem_file(&self) -> Option<&Arc<DemFile>> {
        self.dem_file.as_ref()
    }

    /// Sets the file from which windows are read.
    #[doc(hidden)]
    pub fn hold_file(&mut self, file: Arc<DemFile>) {
        self.ground = Some(Arc::clone(file.place()));
        self.dem_file = Some(file);
    }

    /// The lines or areas, if they were read.
    #[must_use]
    pub fn drawing(&self) -> Option<&Arc<Drawing>> {
        self.drawing.as_ref()
    }

    /// Sets the lines or areas.
    pub fn hold_drawing(&mut self, drawing: Arc<Drawing>) {
        self.drawing = Some(drawing);
    }

    /// Sets the network.
    pub fn hold_network(&mut self, network: Arc<NetworkWeights>) {
        self.network = Some(network);
    }

    /// The hash of the content, if it was read.
    #[must_use]
    pub fn content_hash(&self) -> Option<&[u8; 32]> {
        let of_ground = self.ground.as_ref().map(|ground| &ground.hash);
        let of_drawing = || self.drawing.as_ref().map(|drawing| &drawing.hash);
        of_ground.or_else(of_drawing).or_else(|| self.network.as_ref().map(|network| &network.hash))
    }
}
