//! The state of the studio without its window: the document, what is shown of it, and the pictures.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use orogen::dem::prepared::{DEFAULT_MEMORY, PreparedDem};
use orogen::recipe::document::Recipe;
use orogen::recipe::source::RecipeSource;
use orogen::world::HEIGHT;
use orogen::{Error, ErrorKind, Result, Session};

use crate::editing::document::Document;
use crate::editing::edit::Edit;
use crate::files;
use crate::preview::frame::{Frame, Quality};
use crate::preview::region::Region;
use crate::preview::request::Request;
use crate::preview::worker::{Event, Wake, Worker};

/// What is shown, and in which light.
#[derive(Debug, Clone, PartialEq)]
pub struct Look {
    /// The layer that is coloured: an output, a node, or a layer derived from the heights.
    pub layer: String,
    /// A palette by name; that of the layer if `None`.
    pub palette: Option<String>,
    /// Azimuth and altitude of the sun, in degrees.
    pub sun: [f64; 2],
    /// Samples along the longer side of the finest picture.
    pub finest: usize,
    /// The part of the world.
    pub region: Region,
}

/// The state of the studio.
pub struct Studio {
    /// The recipe that is edited.
    pub document: Document,
    /// What is shown.
    pub look: Look,
    /// The selected nodes.
    pub selected: Vec<String>,
    /// The latest picture.
    pub frame: Option<Arc<Frame>>,
    /// Why there is no newer picture.
    pub failure: Option<Error>,
    worker: Worker,
    /// What the current pictures were asked for: the revision of the text, and the look.
    asked: Option<(u64, Look)>,
    /// When its file was changed last, as far as it is known.
    file_time: Option<std::time::SystemTime>,
}

impl Studio {
    /// The state with a document. `wake` is called when there is something new to show.
    #[must_use]
    pub fn new(session: Session, wake: Wake, document: Document) -> Studio {
        let look = Look::of(document.recipe());
        Studio {
            document,
            look,
            selected: Vec::new(),
            frame: None,
            failure: None,
            worker: Worker::new(session, wake),
            asked: None,
            file_time: None,
        }
    }

    /// Another document in place of this one.
    pub fn open(&mut self, document: Document) {
        self.look = Look { palette: None, sun: self.look.sun, finest: self.look.finest, ..Look::of(document.recipe()) };
        self.file_time = document.path().and_then(files::changed);
        self.document = document;
        self.selected.clear();
        self.frame = None;
        self.failure = None;
        self.asked = None;
    }

    /// Applies an edit.
    ///
    /// # Errors
    /// If it cannot be applied; then nothing changes.
    pub fn edit(&mut self, edit: &Edit) -> Result<()> {
        self.document.apply(edit)?;
        match edit {
            Edit::Delete(names) => self.selected.retain(|name| !names.contains(name)),
            Edit::Rename { from, to } => {
                self.selected.iter_mut().filter(|name| *name == from).for_each(|name| name.clone_from(to));
            }
            Edit::Add { name, .. } => self.selected = vec![name.clone()],
            _ => {}
        }
        Ok(())
    }

    /// Asks for pictures if the recipe or the look has changed since the last time.
    pub fn refresh(&mut self) {
        let recipe = self.document.recipe();
        if !recipe.outputs().any(|_| true) {
            return;
        }
        // A layer that is gone is not shown any more.
        if !has_layer(recipe, &self.look.layer) {
            self.look.layer = surface(recipe);
        }
        let now = (self.document.revision(), self.look.clone());
        if self.asked.as_ref() == Some(&now) {
            return;
        }
        self.asked = Some(now);
        if !self.document.is_valid() {
            return;
        }
        self.worker.ask(Request {
            recipe: recipe.clone(),
            layer: self.look.layer.clone(),
            surface: surface(recipe),
            region: self.look.region,
            palette: self.look.palette.clone(),
            sun: self.look.sun,
            finest: self.look.finest,
        });
    }

    /// Takes what the work has told. Returns whether there is a new picture.
    pub fn poll(&mut self) -> bool {
        let mut is_new = false;
        for event in self.worker.events() {
            match event {
                Event::Frame(frame) => {
                    self.frame = Some(Arc::from(frame));
                    self.failure = None;
                    is_new = true;
                }
                Event::Failed(error) => self.failure = Some(error),
                Event::Done => self.failure = None,
            }
        }
        is_new
    }

    /// Whether finer pictures are on their way.
    #[must_use]
    pub fn is_busy(&self) -> bool {
        self.worker.is_busy()
    }

    /// The share of the pictures that are asked for that is done, 0 to 1.
    #[must_use]
    pub fn share(&self) -> f32 {
        self.worker.share()
    }

    /// The session.
    #[must_use]
    pub fn session(&self) -> &Session {
        self.worker.session()
    }

    /// Whether the picture is the finest of the current text and look.
    #[must_use]
    pub fn is_done(&self) -> bool {
        !self.is_busy() && self.frame.as_ref().is_some_and(|frame| frame.quality == Quality::Fine)
    }

    /// Writes the document to a file, which it belongs to from then on.
    ///
    /// # Errors
    /// If the file cannot be written, or it was changed since it was read.
    pub fn save(&mut self, path: &Path) -> Result<()> {
        let is_own = self.document.path() == Some(path);
        if is_own && self.is_changed_elsewhere() {
            let message =
                format!("{} was changed by another program; reload it, or save under another name", path.display());
            return Err(Error::new(ErrorKind::File, message));
        }
        files::write(path, self.document.text())?;
        self.document.saved_to(path);
        self.file_time = files::changed(path);
        Ok(())
    }

    /// Whether another program has changed the file of the document.
    fn is_changed_elsewhere(&self) -> bool {
        let Some(path) = self.document.path() else { return false };
        files::changed(path) != self.file_time && files::read(path).ok().as_deref() != self.document.saved()
    }

    /// Looks whether another program has changed the file of the document, and reads it then. Own changes that are not saved stay; the next [`save`](Studio::save) tells of the
    /// conflict. Returns whether it was read.
    pub fn watch(&mut self) -> bool {
        let Some(path) = self.document.path().map(Path::to_path_buf) else { return false };
        if files::changed(&path) == self.file_time || self.document.is_changed() {
            return false;
        }
        let Ok(text) = files::read(&path) else { return false };
        self.file_time = files::changed(&path);
        let is_new = text != self.document.text();
        if is_new {
            self.document.reload(text);
        }
        is_new
    }

    /// The names of the layers that can be shown: outputs, layers derived from the heights.
    #[must_use]
    pub fn layers(&self) -> Vec<String> {
        let recipe = self.document.recipe();
        let derived = orogen::export::derived::list::all().iter().map(|derived| derived.name.to_owned());
        let outputs: Vec<String> = recipe.outputs().map(str::to_owned).collect();
        let derived =
            derived.filter(|name| !outputs.contains(name) && !matches!(name.as_str(), "normal" | "splat" | "albedo"));
        outputs.iter().cloned().chain(derived.collect::<Vec<_>>()).collect()
    }
}

impl Look {
    /// What is shown of a recipe at first.
    #[must_use]
    pub fn of(recipe: &Recipe) -> Look {
        Look {
            layer: surface(recipe),
            palette: None,
            sun: [315.0, 40.0],
            finest: 1024,
            region: Region::of(recipe.world.size, recipe.world.cell),
        }
    }
}

/// The output whose values are the heights of the surface: `height`, or the first one.
#[must_use]
pub fn surface(recipe: &Recipe) -> String {
    let mut outputs = recipe.outputs();
    let first = outputs.clone().next().unwrap_or(HEIGHT);
    outputs.find(|name| *name == HEIGHT).unwrap_or(first).to_owned()
}

/// Whether a recipe has a layer: an output, a node, or one derived from the heights.
fn has_layer(recipe: &Recipe, layer: &str) -> bool {
    let node = layer.split_once('.').map_or(layer, |(node, _)| node);
    recipe.outputs().any(|name| name == layer)
        || recipe.nodes().iter().any(|named| named.name == node)
        || orogen::export::derived::list::named(layer).is_some()
}

/// Opens a recipe, a preset by its name, or a file of heights.
///
/// # Errors
/// If there is nothing of that name, or it cannot be read. A recipe that is not valid is no error: its document has the diagnostics.
pub fn open(argument: &Path) -> Result<Document> {
    let path = match RecipeSource::find(argument)? {
        RecipeSource::Preset(preset) => return Document::of_preset(preset),
        RecipeSource::Dem(path) => {
            let path = absolute(&path);
            let ground = PreparedDem::read(&path, None, DEFAULT_MEMORY)?;
            return Document::of_dem(&path, &Recipe::from_dem(&path, &Arc::new(ground)));
        }
        RecipeSource::File(path) => absolute(&path),
    };
    let text = files::read(&path)?;
    if text.trim_start_matches('\u{feff}').trim_start().starts_with('{') {
        return Document::of_json(&path, &text);
    }
    Ok(Document::of_file(&path, text))
}

/// The path from the root, so that it still leads there if the working folder changes.
fn absolute(path: &Path) -> PathBuf {
    std::path::absolute(path).unwrap_or_else(|_| path.to_path_buf())
}

#[cfg(test)]
mod tests;
