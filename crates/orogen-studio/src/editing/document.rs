//! A document: the text of a recipe with its history, the parsed recipe, and the file it belongs to.

use std::path::{Path, PathBuf};

use orogen::grid::error::Diagnostic;
use orogen::recipe::{Preset, Recipe, RecipeSource, presets};
use orogen::{Error, ErrorKind, Registry, Result};

use super::edit::{self, Edit};
use super::history::History;
use super::kept::Kept;

/// The text of an empty recipe.
const EMPTY: &str =
    "orogen = 1\n\n[world]\nseed = 1\nsize = [10240, 10240]\ncell = 10\n\n[nodes]\n\n[outputs]\nheight = 0\n";

/// A recipe that is being edited.
#[derive(Debug, Clone)]
pub struct Document {
    /// The title: the name of its file, or of its origin.
    title: String,
    path: Option<PathBuf>,
    /// The folder that paths are relative to while the document has no file.
    folder: Option<PathBuf>,
    /// The origin of the document while it has no file.
    origin: Option<RecipeSource>,
    history: History,
    /// The text in the file; `None` if there is no file.
    saved: Option<String>,
    recipe: Recipe,
    /// What the studio keeps in the text.
    kept: Kept,
    diagnostics: Vec<Diagnostic>,
    revision: u64,
    recipe_revision: u64,
}

impl Document {
    /// A document with a text that has no file yet.
    ///
    /// # Errors
    /// If the text is not a valid recipe.
    pub fn new(title: &str, text: String) -> Result<Document> {
        let recipe = Registry::new().parse(&text, title)?;
        Ok(Document {
            title: title.to_string(),
            path: None,
            folder: None,
            origin: None,
            kept: Kept::of(&text),
            history: History::new(text),
            saved: None,
            recipe,
            diagnostics: Vec::new(),
            revision: 0,
            recipe_revision: 0,
        })
    }

    /// A level world, to begin with.
    ///
    /// # Errors
    /// None: a test opens it.
    pub fn empty(title: &str) -> Result<Document> {
        Document::new(title, EMPTY.into())
    }

    /// A copy of a preset.
    ///
    /// # Errors
    /// None in practice: a test opens every preset.
    pub fn of_preset(preset: &Preset) -> Result<Document> {
        // The path of the schema is only valid in the repository.
        let text = preset.text.trim_start_matches("#:schema orogen.schema.json").trim_start().to_string();
        let origin = presets::find(preset.name).map(RecipeSource::Preset);
        Ok(Document { origin, ..Document::new(preset.name, text)? })
    }

    /// A recipe that consists of a file of heights.
    ///
    /// # Errors
    /// If the path is not UTF-8.
    pub fn of_dem(path: &Path, recipe: &Recipe) -> Result<Document> {
        let title = path.file_stem().unwrap_or(path.as_os_str()).to_string_lossy();
        let text = recipe.to_toml();
        let origin = Some(RecipeSource::Dem(path.to_path_buf()));
        let mut document = Document { folder: Some(PathBuf::new()), origin, ..Document::new(&title, text)? };
        document.read();
        Ok(document)
    }

    /// The document of a file with this text. An invalid recipe can be opened too: its errors are shown, and its recipe
    /// is empty until they are fixed.
    #[must_use]
    pub fn of_file(path: &Path, text: String) -> Document {
        let title = path.file_stem().unwrap_or(path.as_os_str()).to_string_lossy().into_owned();
        let mut document = Document {
            title,
            path: Some(path.to_path_buf()),
            folder: None,
            origin: None,
            history: History::new(text.clone()),
            saved: Some(text),
            kept: Kept::default(),
            recipe: Recipe::new(orogen::WorldSpec::default()),
            diagnostics: Vec::new(),
            revision: 0,
            recipe_revision: 0,
        };
        document.read();
        document
    }

    /// A recipe that was written as JSON, converted to TOML. It has no file yet, and relative paths start in the folder
    /// of the JSON file.
    ///
    /// # Errors
    /// If it is not a valid recipe.
    pub fn of_json(path: &Path, text: &str) -> Result<Document> {
        let recipe = Registry::new().parse_as(text, path)?;
        let title = path.file_stem().unwrap_or(path.as_os_str()).to_string_lossy();
        let folder = path.parent().map(Path::to_path_buf).unwrap_or_default();
        let origin = Some(RecipeSource::File(path.to_path_buf()));
        let mut document = Document { folder: Some(folder), origin, ..Document::new(&title, recipe.to_toml())? };
        document.read();
        Ok(document)
    }

    /// A text that was not saved: it has no file, and counts as changed. Relative paths start in `folder`.
    #[must_use]
    pub fn unsaved(title: &str, text: String, folder: Option<&Path>) -> Document {
        let mut document = Document::of_file(Path::new("unsaved.toml"), text);
        document.title = title.to_owned();
        (document.path, document.folder) = (None, folder.map(Path::to_path_buf));
        document.saved = Some(String::new());
        document.read();
        document
    }

    /// The document with a text that was not saved, as one step after the text of the file.
    #[must_use]
    pub fn with_unsaved(mut self, text: String) -> Document {
        self.set(text, "edit.recovered", None);
        self
    }

    /// The title.
    #[must_use]
    pub fn title(&self) -> &str {
        &self.title
    }

    /// The file.
    #[must_use]
    pub fn path(&self) -> Option<&Path> {
        self.path.as_deref()
    }

    /// The folder that relative paths start in, if the document has no file.
    #[must_use]
    pub fn folder(&self) -> Option<&Path> {
        self.folder.as_deref()
    }

    /// The argument for command lines that refers to the document; `None` if its text is in no file.
    #[must_use]
    pub fn argument(&self) -> Option<String> {
        let path = |path: &Path| path.to_string_lossy().into_owned();
        match (self.is_changed(), &self.path, &self.origin) {
            (true, ..) => None,
            (false, Some(own), _) => Some(path(own)),
            (false, None, Some(RecipeSource::Preset(preset))) => Some(preset.name.to_owned()),
            (false, None, Some(RecipeSource::File(own) | RecipeSource::Dem(own))) => Some(path(own)),
            (false, None, None) => None,
        }
    }

    /// Whether the document is only a file of heights.
    #[must_use]
    pub fn is_place(&self) -> bool {
        self.path.is_none() && !self.is_changed() && matches!(self.origin, Some(RecipeSource::Dem(_)))
    }

    /// The text.
    #[must_use]
    pub fn text(&self) -> &str {
        self.history.text()
    }

    /// The recipe of the text, or of the last valid text.
    #[must_use]
    pub fn recipe(&self) -> &Recipe {
        &self.recipe
    }

    /// What the studio keeps in the text.
    #[must_use]
    pub fn kept(&self) -> &Kept {
        &self.kept
    }

    /// The errors of the text; empty if it is valid.
    #[must_use]
    pub fn diagnostics(&self) -> &[Diagnostic] {
        &self.diagnostics
    }

    /// Whether the text is a valid recipe.
    #[must_use]
    pub fn is_valid(&self) -> bool {
        self.diagnostics.is_empty()
    }

    /// A number that increases with each change of the text.
    #[must_use]
    pub fn revision(&self) -> u64 {
        self.revision
    }

    /// A number that increases with each change of the recipe, which comments and what the studio keeps are no part of.
    #[must_use]
    pub fn recipe_revision(&self) -> u64 {
        self.recipe_revision
    }

    fn use_recipe(&mut self, recipe: Recipe) {
        if recipe != self.recipe {
            self.recipe_revision += 1;
            self.recipe = recipe;
        }
    }

    /// Whether the text differs from the text in the file.
    #[must_use]
    pub fn is_changed(&self) -> bool {
        match &self.saved {
            Some(saved) => saved != self.text(),
            None => self.history.undo_label().is_some(),
        }
    }

    /// The history for undo and redo, for labels.
    #[must_use]
    pub fn history(&self) -> &History {
        &self.history
    }

    /// Sets the text, as typed. Continued typing is one step.
    pub fn type_text(&mut self, text: String) {
        self.set(text, "edit.text", Some("text"));
    }

    /// Applies an edit.
    ///
    /// # Errors
    /// If the text is not valid, or the edit does not give a valid recipe; then nothing changes.
    pub fn apply(&mut self, edit: &Edit) -> Result<()> {
        let (text, recipe) = self.edited(edit)?;
        let gesture = edit.gesture();
        let before = self.text().len();
        let unchanged = before == text.len() && self.text() == text;
        self.history.push(text, edit.label(), gesture.as_deref());
        if !unchanged {
            self.revision += 1;
            self.use_recipe(recipe);
            self.kept = Kept::of(self.text());
        }
        Ok(())
    }

    /// Checks whether an edit could be applied.
    ///
    /// # Errors
    /// The errors of [`Document::apply`].
    pub fn check(&self, edit: &Edit) -> Result<()> {
        self.edited(edit).map(|_| ())
    }

    /// The text after an edit, and its recipe.
    fn edited(&self, edit: &Edit) -> Result<(String, Recipe)> {
        let fault = |message: String| Error::new(ErrorKind::Recipe, message);
        if !self.is_valid() {
            return Err(fault("the recipe's text has errors; mend them first".into()));
        }
        if let Some(name) = edit.changed().into_iter().find(|name| self.kept.locked.iter().any(|locked| locked == name))
        {
            return Err(fault(format!("`{name}` is locked; unlock it in the menu of its box first")));
        }
        let (mut text, mut recipe) = (self.text().to_owned(), self.recipe.clone());
        for step in edit.steps() {
            let renames = edit::renames(&recipe, step);
            text = edit::apply(&text, &recipe, step).map_err(fault)?;
            recipe = self.parse(&text)?;
            let kept = Kept::of(&text);
            let followed = kept.after(&renames, &recipe);
            if followed != kept {
                text = edit::apply(&text, &recipe, &Edit::Keep(followed)).map_err(fault)?;
            }
        }
        Ok((text, recipe))
    }

    /// Ends the current gesture, such as the drag of a slider.
    pub fn end_gesture(&mut self) {
        self.history.end_gesture();
    }

    /// Goes back by one step; false if there is none.
    pub fn undo(&mut self) -> bool {
        let went = self.history.undo();
        self.went(went)
    }

    /// Goes forward by one step; false if there is none.
    pub fn redo(&mut self) -> bool {
        let went = self.history.redo();
        self.went(went)
    }

    /// Goes to a step of the history; false if there is none or it is the current one.
    pub fn go_to(&mut self, step: usize) -> bool {
        let went = self.history.go_to(step);
        self.went(went)
    }

    fn went(&mut self, went: bool) -> bool {
        if went {
            self.revision += 1;
            self.read();
        }
        went
    }

    /// Records that the text is now in this file.
    pub fn saved_to(&mut self, path: &Path) {
        self.title = path.file_stem().unwrap_or(path.as_os_str()).to_string_lossy().into_owned();
        let moved = self.path.as_deref() != Some(path);
        self.path = Some(path.to_path_buf());
        self.saved = Some(self.text().to_string());
        if moved {
            // Relative paths now start in another folder.
            self.read();
        }
    }

    /// Takes over a text that another program wrote to the file. This can be undone.
    pub fn reload(&mut self, text: String) {
        self.set(text.clone(), "edit.reload", None);
        self.saved = Some(text);
    }

    /// The text of the file when it was last read or written.
    #[must_use]
    pub fn saved(&self) -> Option<&str> {
        self.saved.as_deref()
    }

    fn set(&mut self, text: String, label: &'static str, gesture: Option<&str>) {
        if text == self.text() {
            return;
        }
        self.history.push(text, label, gesture);
        self.revision += 1;
        self.read();
    }

    /// Parses the text.
    fn read(&mut self) {
        self.kept = Kept::of(self.text());
        match self.parse(self.text()) {
            Ok(recipe) => {
                self.use_recipe(recipe);
                self.diagnostics.clear();
            }
            Err(error) => self.diagnostics = error.diagnostics().to_vec(),
        }
    }

    fn parse(&self, text: &str) -> Result<Recipe> {
        let registry = Registry::new();
        match (&self.path, &self.folder) {
            (Some(path), _) => registry.parse_as(text, path),
            (None, Some(folder)) => {
                let mut recipe = registry.parse(text, &self.title)?;
                recipe.set_base_dir(folder);
                Ok(recipe)
            }
            (None, None) => registry.parse(text, &self.title),
        }
    }
}
