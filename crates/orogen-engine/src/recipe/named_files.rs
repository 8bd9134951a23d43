//! The files that the nodes of a recipe name.

use super::document::{NamedNode, Recipe};
use super::surface::document::{Expanded, RAMP, Surface};
use orogen_grid::error::{Diagnostic, Error, ErrorKind, Result};
use orogen_io::dem::dem_file::DemFile;
use orogen_io::dem::file_ref::{FileKind, FileRef};
use orogen_io::dem::open;
use orogen_io::dem::prepared::PreparedDem;
use orogen_io::format::dem::Request;
use orogen_io::format::drawing::Drawing;
use orogen_io::format::network::NetworkWeights;
use orogen_io::palette::histogram;
use orogen_ops::declare::Shape;
use orogen_ops::field::{Dem, Exemplar};
use orogen_ops::node::Node;
use orogen_ops::op::Op;
use std::collections::BTreeMap;
use std::path::PathBuf;
use std::sync::Arc;

impl Recipe {
    /// The files that its nodes and surfaces name, the parts of virtual rasters and tile folders, and the recipes that
    /// it uses.
    pub fn files(&self) -> Vec<PathBuf> {
        let mut nodes: Vec<Node> = self.nodes.iter().map(|named| named.node.clone()).collect();
        let files = nodes.iter_mut().flat_map(Node::files).filter(|file| !file.is_empty()).map(|file| file.path());
        let files: Vec<PathBuf> =
            files.chain(self.surfaces.iter().filter_map(Surface::picture).map(FileRef::path)).collect();
        files.iter().flat_map(|path| open::files(path)).chain(self.used.iter().cloned()).collect()
    }

    /// Whether nodes or surfaces name files: all that [`Recipe::load`] would read.
    pub(super) fn names_files(&mut self) -> bool {
        let mut files = self.nodes.iter_mut().flat_map(|named| named.node.files());
        files.any(|file| !file.is_empty()) || self.surfaces.iter().any(|surface| surface.picture().is_some())
    }

    /// Reads the files that its nodes name. Each is read only once; their heights together take at most `allowed`
    /// bytes. Of large files of heights, requests read the windows that they need, unless results are stored: then all
    /// heights are needed for the keys of the results. If a solver reads a file of more than half of `allowed` bytes,
    /// it reads windows, too, and keys contain the [identity of the file](DemFile::place).
    ///
    /// # Errors
    /// If one cannot be read: the message contains the node, and the location if the recipe was read from a text.
    pub fn load(&mut self, allowed: u64) -> Result<()> {
        let has = |class: fn(&Op) -> bool| self.nodes.iter().any(|named| class(&named.node.op()));
        let windows_above = match (has(|op| matches!(op, Op::Levelled(_))), has(|op| matches!(op, Op::Solver(_)))) {
            (true, _) => None,
            (false, true) => Some(allowed / 2),
            (false, false) => Some(0),
        };
        self.load_files(allowed, windows_above)
    }

    /// The recipe with all heights of its files, for work that checks them or is identified by them; `None` if it has
    /// them already.
    ///
    /// # Errors
    /// The errors of [`Recipe::load`].
    #[doc(hidden)]
    pub fn with_whole_files(&self, allowed: u64) -> Result<Option<Recipe>> {
        if self.dem_files().is_empty() {
            return Ok(None);
        }
        let mut recipe = self.clone();
        recipe.load_files(allowed, None)?;
        Ok(Some(recipe))
    }

    /// [`Recipe::load`], with windows of files of more than `windows_above` bytes.
    fn load_files(&mut self, allowed: u64, windows_above: Option<u64>) -> Result<()> {
        // One file may be heights for one node and a picture for another.
        let mut known: BTreeMap<(PathBuf, FileKind, Option<u32>), Arc<PreparedDem>> = BTreeMap::new();
        let mut drawings: BTreeMap<(PathBuf, Option<String>, FileKind), Arc<Drawing>> = BTreeMap::new();
        let mut files: BTreeMap<(PathBuf, Option<u32>), Option<Arc<DemFile>>> = BTreeMap::new();
        self.held = 0;
        for NamedNode { name, node, .. } in &mut self.nodes {
            let band = match node {
                Node::Dem(Dem { band, .. }) | Node::Exemplar(Exemplar { band, .. }) if *band > 0 => Some(*band),
                _ => None,
            };
            let is_drawn = node.spec().params.iter().any(|param| matches!(param.shape, Shape::Points(_)));
            // A drawing may be in the recipe instead of a file, and a network in the program.
            let is_needless = |file: &FileRef| file.is_empty() && (is_drawn || file.kind() == FileKind::Network);
            for file in node.files().into_iter().filter(|file| !is_needless(file)) {
                let left = allowed.saturating_sub(self.held);
                let location = file.location().cloned();
                let in_node = |error: Error| {
                    let message = format!("node `{name}`: {error}");
                    let diagnostic = Diagnostic::new(message).with_place(location.clone());
                    Error::from_diagnostics(ErrorKind::File, vec![diagnostic])
                };
                let path = (file.path(), file.content(), band);
                if let FileKind::Drawing(kind) = path.1 {
                    let key = (path.0, file.layer().map(str::to_owned), path.1);
                    let drawing = match file.drawing().or(drawings.get(&key)) {
                        Some(drawing) => Arc::clone(drawing),
                        None => Arc::new(Drawing::read(&key.0, file.layer(), kind, left).map_err(in_node)?),
                    };
                    if drawings.insert(key, Arc::clone(&drawing)).is_none() {
                        self.held = self.held.saturating_add(drawing.memory());
                    }
                    file.hold_drawing(drawing);
                    continue;
                }
                if path.1 == FileKind::Network {
                    if file.content_hash().is_none() {
                        let read = NetworkWeights::read(&path.0, left).map_err(in_node)?;
                        self.held = self.held.saturating_add(read.memory());
                        file.hold_network(Arc::new(read));
                    }
                    continue;
                }
                let is_read = file.ground().is_some() && file.dem_file().is_none();
                if let Some(above) = windows_above
                    && file.kind() == FileKind::Heights
                    && !is_read
                {
                    let key = (path.0.clone(), band);
                    let found = match (file.dem_file(), files.get(&key)) {
                        (Some(own), _) => Some(Arc::clone(own)),
                        (None, Some(known)) => known.clone(),
                        (None, None) => DemFile::open(&path.0, band, left).map_err(in_node)?.map(Arc::new),
                    };
                    files.insert(key, found.clone());
                    if let Some(found) = found.filter(|file| file.whole_memory() > above) {
                        file.hold_file(found);
                        continue;
                    }
                }
                if let Some(own) = file.dem_file().cloned() {
                    file.hold(own.read(None, left).map_err(in_node)?);
                }
                let read = || match path.1 {
                    FileKind::Picture => PreparedDem::picture(&path.0, left),
                    _ => PreparedDem::read(&path.0, None, Request::new(left).with_band(band)),
                };
                let ground = match file.ground().or(known.get(&path)) {
                    Some(ground) => Arc::clone(ground),
                    None => Arc::new(read().map_err(in_node)?),
                };
                if known.insert(path, Arc::clone(&ground)).is_none() {
                    self.held = self.held.saturating_add(ground.memory());
                }
                file.hold(ground);
            }
            if let Node::Exemplar(exemplar) = node {
                let left = allowed.saturating_sub(self.held);
                let memory = exemplar.check_file(left).map_err(|message| {
                    let diagnostic = Diagnostic::new(format!("node `{name}`: {message}"));
                    let diagnostic = diagnostic.with_place(exemplar.path.file().location().cloned());
                    Error::from_diagnostics(ErrorKind::File, vec![diagnostic])
                })?;
                self.held = self.held.saturating_add(memory);
            }
        }
        for Expanded { surface, colors, .. } in &mut self.expanded {
            if let Some(picture) = surface.picture().filter(|_| colors.is_empty()) {
                let in_surface =
                    |error: Error| Error::new(error.kind(), format!("surface `{}`: {error}", surface.name));
                *colors = histogram::read(&picture.path(), RAMP).map_err(in_surface)?;
            }
        }
        self.check_map()
    }

    /// Memory of its files after they are read, in bytes, without windows that requests hold.
    #[must_use]
    pub fn held(&self) -> u64 {
        let files = self.dem_files();
        files.iter().fold(self.held, |sum, file| sum.saturating_add(file.kept()))
    }

    /// The files from which windows are read when they are requested, each once.
    fn dem_files(&self) -> Vec<&Arc<DemFile>> {
        let mut files: Vec<&Arc<DemFile>> = Vec::new();
        for named in &self.nodes {
            if let Node::Dem(dem) = &named.node
                && let Some(file) = dem.path.dem_file()
                && !files.iter().any(|known| Arc::ptr_eq(known, file))
            {
                files.push(file);
            }
        }
        files
    }
}
