//! The state of the studio without its window: the document, its view, and the pictures.

use std::collections::HashSet;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Duration;

use orogen::declare::Input;
use orogen::io::dem::prepared::DEFAULT_MEMORY;
use orogen::recipe::{NamedNode, Recipe, RecipeSource};
use orogen::world::HEIGHT;
use orogen::{Error, ErrorKind, Result, Session, Window};

use crate::editing::document::Document;
use crate::editing::edit::{Edit, renames};
use crate::editing::{groups, strokes};
use crate::files;
use crate::preview::coloring::Coloring;
use crate::preview::detail::Detail;
use crate::preview::frame::{Frame, Quality};
use crate::preview::region::Region;
use crate::preview::request::Request;
use crate::preview::ring::Ring;
use crate::preview::thumbnails::Thumbnails;
use crate::preview::worker::{Event, Wake, Worker};

/// What is shown, and in which light.
#[derive(Debug, Clone, PartialEq)]
pub struct Look {
    /// The colored layer: an output, a node, or a layer derived from the heights.
    pub layer: String,
    /// What the colors show.
    pub coloring: Coloring,
    /// Azimuth and altitude of the sun, in degrees.
    pub sun: [f64; 2],
    /// The interval of contours in metres; 0 chooses a round one that suits the land. No contours if `None`.
    pub contours: Option<f64>,
    /// Whether rivers and lakes are shown.
    pub rivers: bool,
    /// Number of samples along the longer side of the finest picture.
    pub finest: usize,
    /// The part of the world.
    pub region: Region,
}

/// Maximum time for which the window waits for the picture of a change. Less than a frame takes where a CPU draws: the
/// change is seen one frame earlier.
const WAIT: Duration = Duration::from_millis(40);

/// The state of the studio.
pub struct Studio {
    /// The edited recipe.
    pub document: Document,
    /// What is shown.
    pub look: Look,
    /// The selected nodes.
    pub selected: Vec<String>,
    /// The latest picture.
    pub frame: Option<Arc<Frame>>,
    /// The reason why there is no newer picture.
    pub failure: Option<Error>,
    /// Small pictures of the nodes.
    pub thumbnails: Thumbnails,
    /// Whether small pictures of the nodes are made.
    pub has_thumbnails: bool,
    worker: Worker,
    /// Whether the first picture of the latest request took so little time that the window can wait for the next one.
    is_quick: bool,
    /// Rings of detail in the 3D view.
    detail: Detail,
    /// The revision and region for which the current small pictures were requested.
    asked_small: Option<(u64, Region)>,
    /// The revision of the recipe and the look for which the current pictures were requested.
    asked: Option<(u64, Look)>,
    /// The finest picture, with the revision and look for which it was requested.
    land: Option<(u64, Look, Arc<Frame>)>,
    /// The time of the last known change of the document's file.
    file_time: Option<std::time::SystemTime>,
}

impl Studio {
    /// Creates the state for a document. `wake` is called when there is something new to show.
    #[must_use]
    pub fn new(session: Session, wake: Wake, document: Document) -> Studio {
        let look = Look::of(document.recipe());
        Studio {
            document,
            look,
            selected: Vec::new(),
            frame: None,
            failure: None,
            thumbnails: Thumbnails::new(Arc::clone(&wake)),
            has_thumbnails: true,
            detail: Detail::new(Arc::clone(&wake)),
            worker: Worker::new(session, wake),
            is_quick: true,
            asked_small: None,
            asked: None,
            land: None,
            file_time: None,
        }
    }

    /// Replaces the document.
    pub fn open(&mut self, document: Document) {
        self.look = Look {
            sun: self.look.sun,
            contours: self.look.contours,
            rivers: self.look.rivers,
            finest: self.look.finest,
            ..Look::of(document.recipe())
        };
        self.file_time = document.path().and_then(files::changed);
        self.document = document;
        self.selected.clear();
        self.frame = None;
        self.failure = None;
        self.asked = None;
        self.land = None;
        self.asked_small = None;
        self.worker.cancel();
        self.thumbnails.cancel();
        self.detail.clear();
    }

    /// Applies an edit.
    ///
    /// # Errors
    /// If it cannot be applied; then nothing changes.
    pub fn edit(&mut self, edit: &Edit) -> Result<()> {
        let renames = renames(self.document.recipe(), edit);
        self.document.apply(edit)?;
        for name in self.selected.iter_mut().chain([&mut self.look.layer]) {
            if let Some((_, to)) = renames.iter().find(|(from, _)| from == name) {
                name.clone_from(to);
            }
        }
        match edit.steps().first().unwrap_or(edit) {
            Edit::Delete(names) => self.selected.retain(|name| !names.contains(name)),
            Edit::Add { name, .. } => self.selected = vec![name.clone()],
            Edit::Stroke { node, .. } => {
                self.selected = vec![node.clone()];
                self.look.layer = layer_of_stroke(self.document.recipe(), node, &self.look.layer);
            }
            _ => {}
        }
        Ok(())
    }

    /// Goes back by one step of the history; false if there is none.
    pub fn undo(&mut self) -> bool {
        let went = self.document.undo();
        self.keep_selection();
        went
    }

    /// Goes forward by one step of the history; false if there is none.
    pub fn redo(&mut self) -> bool {
        let went = self.document.redo();
        self.keep_selection();
        went
    }

    /// Goes to a step of the history; false if there is none or it is the current one.
    pub fn go_to(&mut self, step: usize) -> bool {
        let went = self.document.go_to(step);
        self.keep_selection();
        went
    }

    /// Sets the text of the recipe, as typed.
    pub fn type_text(&mut self, text: String) {
        self.document.type_text(text);
        self.keep_selection();
    }

    /// Deselects nodes that no longer exist: a new node would read them, and one of the same name would read itself.
    fn keep_selection(&mut self) {
        let names: HashSet<&str> = self.document.recipe().nodes().iter().map(|named| named.name.as_str()).collect();
        self.selected.retain(|name| names.contains(name.as_str()));
    }

    /// Requests pictures if the recipe or the look has changed since the last time. Returns whether it did.
    pub fn refresh(&mut self) -> bool {
        let recipe = self.document.recipe();
        if !recipe.outputs().any(|_| true) {
            return false;
        }
        // A layer that no longer exists is not shown any more.
        if !has_layer(recipe, &self.look.layer) {
            self.look.layer = surface(recipe);
        }
        if !self.look.coloring.suits(recipe) {
            self.look.coloring = Coloring::Own;
        }
        self.refresh_thumbnails();
        let now = (self.document.recipe_revision(), self.look.clone());
        if self.asked.as_ref() == Some(&now) {
            return false;
        }
        self.detail.cancel();
        if !self.document.is_valid() || self.worker.should_wait() {
            return false;
        }
        self.asked = Some(now);
        // With other colors or another sun, the samples can be reused.
        let is_same = |(revision, look, _): &&(u64, Look, Arc<Frame>)| {
            *revision == self.document.recipe_revision() && look.has_land_of(&self.look)
        };
        let land = self.land.as_ref().filter(is_same).map(|(.., frame)| Arc::clone(frame));
        self.worker.ask(Request { land, ..self.request() });
        true
    }

    /// Waits for the first of the requested pictures if it is expected at once. Returns whether it is there.
    pub fn wait_for_picture(&mut self) -> bool {
        // An unexpectedly slow one is not waited for again.
        self.is_quick = self.is_quick && self.worker.wait(WAIT);
        self.is_quick && self.poll()
    }

    /// The request for pictures of the current text and look.
    fn request(&self) -> Request {
        let recipe = self.document.recipe();
        Request {
            land: None,
            recipe: recipe.clone(),
            layer: self.look.layer.clone(),
            surface: surface(recipe),
            region: self.look.region,
            coloring: self.look.coloring.clone(),
            sun: self.look.sun,
            contours: self.look.contours,
            rivers: self.look.rivers,
            finest: self.look.finest,
        }
    }

    /// Requests rings of detail with these windows, from coarse to fine, for the finest picture. `None` cancels the
    /// work for rings, because the camera moves.
    pub fn refine(&mut self, windows: Option<Vec<Window>>) {
        match (windows, &self.frame) {
            (Some(windows), Some(frame)) if self.is_current() => {
                self.detail.ask(self.worker.session(), self.request(), frame, windows);
            }
            _ => self.detail.cancel(),
        }
    }

    /// The requested windows of rings; `None` if the work was cancelled, or there is none.
    #[must_use]
    pub fn refining(&self) -> Option<&[Window]> {
        self.detail.asked()
    }

    /// Whether rings of detail are being made.
    #[must_use]
    pub fn is_refining(&self) -> bool {
        self.detail.is_busy()
    }

    /// The rings of detail of the picture, from coarse to fine.
    #[must_use]
    pub fn rings(&self) -> Vec<Arc<Ring>> {
        self.frame.as_ref().map_or_else(Vec::new, |frame| self.detail.rings(frame))
    }

    /// Whether the picture is the finest one of the current text and look.
    fn is_current(&self) -> bool {
        let is_asked = self
            .asked
            .as_ref()
            .is_some_and(|(revision, look)| *revision == self.document.recipe_revision() && *look == self.look);
        is_asked && self.is_done() && self.document.is_valid()
    }

    /// Requests small pictures of the nodes when the picture of the land is done; a change cancels them.
    fn refresh_thumbnails(&mut self) {
        let now = (self.document.recipe_revision(), self.look.region);
        if self.asked_small.is_some_and(|asked| asked != now) || !self.has_thumbnails {
            self.thumbnails.cancel();
            self.asked_small = None;
        }
        let is_current = self.asked.as_ref().is_some_and(|(revision, look)| *revision == now.0 && *look == self.look);
        let is_time = self.has_thumbnails && is_current && !self.worker.is_busy() && self.document.is_valid();
        if is_time && self.asked_small.is_none() {
            self.asked_small = Some(now);
            let recipe = self.document.recipe().clone();
            // Errors are ignored: if no thread can be started, the picture of the land reports it.
            let _ = self.thumbnails.ask(self.worker.session(), recipe, self.look.region);
        }
    }

    /// Takes the events of the work. Returns whether there is a new picture.
    pub fn poll(&mut self) -> bool {
        let mut is_new = false;
        self.thumbnails.poll();
        self.detail.poll();
        for event in self.worker.events() {
            match event {
                Event::Frame(frame) => {
                    let frame: Arc<Frame> = Arc::from(frame);
                    if self.frame.as_ref().is_none_or(|shown| shown.request != frame.request) {
                        self.is_quick = frame.seconds < WAIT.as_secs_f64();
                    }
                    if let Some((revision, look)) = self.asked.as_ref().filter(|_| frame.quality == Quality::Fine) {
                        self.land = Some((*revision, look.clone(), Arc::clone(&frame)));
                    }
                    self.frame = Some(frame);
                    self.failure = None;
                    is_new = true;
                }
                Event::Next(_) => {}
                Event::Failed(error) => self.failure = Some(error),
                Event::Done => self.failure = None,
            }
        }
        is_new
    }

    /// Whether finer pictures are being made.
    #[must_use]
    pub fn is_busy(&self) -> bool {
        self.worker.is_busy()
    }

    /// The completed share of the requested pictures, 0 to 1.
    #[must_use]
    pub fn share(&self) -> f32 {
        self.worker.share()
    }

    /// The session for files: without a graphics card, which only makes previews.
    #[must_use]
    pub fn session(&self) -> Session {
        self.worker.session().without_device()
    }

    /// Whether the picture is the finest of the current text and look.
    #[must_use]
    pub fn is_done(&self) -> bool {
        !self.is_busy() && self.frame.as_ref().is_some_and(|frame| frame.quality == Quality::Fine)
    }

    /// Writes the document to a file, to which it then belongs.
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

    /// Checks whether another program has changed the file of the document, and if so, reads it. Unsaved changes are
    /// kept; the next [`save`](Studio::save) reports the conflict. Returns whether the file was read.
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
            self.keep_selection();
        }
        is_new
    }

    /// The group that is selected as a whole, or else the group of the first selected node.
    #[must_use]
    pub fn selected_group(&self) -> Option<String> {
        let around = || self.selected.first().map(|name| groups::group_of(name)).filter(|group| !group.is_empty());
        groups::of_selection(self.document.recipe(), &self.selected).or_else(|| around().map(str::to_owned))
    }

    /// The names of the layers that can be shown: outputs and layers derived from the heights.
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
    /// The initial look for a recipe.
    #[must_use]
    pub fn of(recipe: &Recipe) -> Look {
        Look {
            layer: surface(recipe),
            coloring: Coloring::Own,
            sun: [315.0, 40.0],
            contours: None,
            rivers: true,
            finest: 1024,
            region: Region::of(recipe.world.size, recipe.world.cell),
        }
    }
}

impl Look {
    /// Whether another look has the same samples: everything except colors and light.
    fn has_land_of(&self, other: &Look) -> bool {
        self.layer == other.layer && self.region == other.region && self.finest == other.finest
    }
}

/// The output whose values are the heights of the surface: `height`, or the first one.
#[must_use]
pub fn surface(recipe: &Recipe) -> String {
    let mut outputs = recipe.outputs();
    let first = outputs.clone().next().unwrap_or(HEIGHT);
    outputs.find(|name| *name == HEIGHT).unwrap_or(first).to_owned()
}

/// Whether a recipe has a layer: an output, a node, or a layer derived from the heights.
fn has_layer(recipe: &Recipe, layer: &str) -> bool {
    let node = layer.split_once('.').map_or(layer, |(node, _)| node);
    recipe.outputs().any(|name| name == layer)
        || recipe.nodes().iter().any(|named| named.name == node)
        || orogen::export::derived::list::named(layer).is_some()
}

/// The layer for showing a stroke of a node: the node itself if nothing reads it; otherwise the layer that is already
/// shown, unless that is a painted mask.
fn layer_of_stroke(recipe: &Recipe, node: &str, shown: &str) -> String {
    let is_it = |input: &Input| matches!(input, Input::Node(name) if name == node);
    let reads =
        |named: &NamedNode| is_it(&named.mask) || (0..named.node.inputs().len()).any(|i| is_it(named.node.input(i)));
    let is_read = recipe.nodes().iter().any(reads) || recipe.output_inputs().iter().any(|(_, input)| is_it(input));
    let paints =
        |name: &str| recipe.nodes().iter().any(|named| named.name == name && named.node.spec().op == strokes::OP);
    match is_read {
        false => node.to_owned(),
        true if shown != node && paints(shown) => surface(recipe),
        true => shown.to_owned(),
    }
}

/// Opens a recipe, a preset by its name, or a file of heights.
///
/// # Errors
/// If there is nothing with that name, or it cannot be read. An invalid recipe is not an error: its document contains
/// the diagnostics.
pub fn open(argument: &Path) -> Result<Document> {
    let path = match RecipeSource::find(argument)? {
        RecipeSource::Preset(preset) => return Document::of_preset(preset),
        RecipeSource::Dem(path) => {
            let path = absolute(&path);
            let source = RecipeSource::Dem(path.clone());
            return Document::of_dem(&path, &source.read(&[], DEFAULT_MEMORY, |_| {})?);
        }
        RecipeSource::File(path) => absolute(&path),
    };
    let text = files::read(&path)?;
    if text.trim_start_matches('\u{feff}').trim_start().starts_with('{') {
        return Document::of_json(&path, &text);
    }
    Ok(Document::of_file(&path, text))
}

/// The absolute path, which stays valid if the working folder changes.
fn absolute(path: &Path) -> PathBuf {
    std::path::absolute(path).unwrap_or_else(|_| path.to_path_buf())
}

#[cfg(test)]
mod tests;
