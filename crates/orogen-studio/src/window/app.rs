//! The application: lays out the panels, and carries out their actions.

mod actions;
mod commands;

use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Duration;

use eframe::egui::{self, Context, Panel, Ui};
use orogen::{Budget, Options, Result, Session};

use super::action::Action;
use super::command;
use super::device::DeviceWatch;
use super::dialogs::{self, Decision, FileDialog};
use super::export_dialog::ExportDialog;
use super::open_dialogs::OpenDialogs;
use super::panels::{Panels, Shown};
use super::purpose::Purpose;
use super::ramp_editor::RampEditor;
use super::recovery_dialog::{self, RecoveryDialog};
use super::relief_drawing::Ability;
use super::relief_panel::ShownView;
use super::system_dialog::SystemDialog;
use super::{fonts, menu, theme};
use crate::catalogue::Language;
use crate::editing::document::Document;
use crate::file_watch::FileWatch;
use crate::platform::{self, Gpu};
use crate::preview::coloring::Coloring;
use crate::preview::colors::palette;
use crate::preview::worker::Wake;
use crate::recovery::{Recovery, Unsaved};
use crate::settings::Settings;
use crate::settings::layout::Below;
use crate::studio::{self, Studio};

/// An action that waits until the user has decided about unsaved changes.
#[derive(Debug, Clone)]
enum Pending {
    Open(PathBuf),
    Preset(&'static str),
    Empty,
    Unsaved(Unsaved),
    StartPage,
    Quit,
}

/// The application.
pub struct App {
    session: Session,
    /// The graphics card that computes previews.
    gpu: Option<Gpu>,
    wake: Wake,
    settings: Settings,
    /// The settings folder.
    folder: Option<PathBuf>,
    language: Language,
    ability: Option<Ability>,
    watch: DeviceWatch,
    /// The time at which the device is lost, for tests.
    lose_device: Option<f64>,
    studio: Option<Studio>,
    panels: Panels,
    dialogs: OpenDialogs,
    pending: Option<Pending>,
    /// The action that follows once the document is saved under a name that is being chosen.
    after_save: Option<Pending>,
    recovery: Recovery,
    file_watch: FileWatch,
    /// The title of the window.
    title: String,
    may_close: bool,
    /// Whether unsaved changes are kept for the next start.
    keeps_recovered: bool,
}

/// The initial state of an application.
#[derive(Default)]
pub struct Start {
    /// Settings that are remembered between runs.
    pub settings: Settings,
    /// The settings folder.
    pub folder: Option<PathBuf>,
    /// The document that is opened instead of the start page.
    pub document: Option<Document>,
    /// The graphics card that makes previews.
    pub gpu: Option<Gpu>,
    /// The watch on the graphics device.
    pub watch: DeviceWatch,
    /// Whether the previous run ended because its device was lost.
    pub is_after_loss: bool,
    /// Seconds after which the device is lost, for tests.
    pub lose_device: Option<f64>,
    /// What is said at the start, for example that a file could not be opened.
    pub message: Option<String>,
}

impl App {
    /// Creates the application with a document, or with the start page.
    ///
    /// # Errors
    /// If no threads can be started.
    pub fn new(context: &eframe::CreationContext<'_>, start: Start) -> Result<App> {
        let Start { settings, folder, document, gpu, watch, is_after_loss, lose_device, message } = start;
        let session = Session::new(Options { memory: Budget::of(settings.memory), ..Options::default() })?;
        let session = match &gpu {
            Some(gpu) => platform::with_gpu(&session, gpu),
            None => session,
        };
        let repaint = context.egui_ctx.clone();
        let wake: Wake = Arc::new(move || repaint.request_repaint());
        let language = settings.language();
        theme::set(&context.egui_ctx, settings.theme);
        context.egui_ctx.set_zoom_factor(settings.scale);
        let ability = context.wgpu_render_state.as_ref().map(Ability::of);
        if let Some(state) = &context.wgpu_render_state {
            watch.start(state);
        }
        let recovery = Recovery::new(folder.as_deref());
        let left = recovery.left();
        let mut panels = Panels::new(&wake);
        panels.relief.views.clone_from(&settings.views);
        let file_watch = FileWatch::new(Arc::clone(&wake))?;
        let mut app = App {
            session,
            gpu,
            wake,
            settings,
            folder,
            language,
            ability,
            watch,
            lose_device,
            studio: None,
            panels,
            dialogs: OpenDialogs { recovery: Some(RecoveryDialog::new(left)), ..OpenDialogs::default() },
            pending: None,
            after_save: None,
            recovery,
            file_watch,
            title: String::new(),
            may_close: false,
            keeps_recovered: false,
        };
        app.use_language(&context.egui_ctx);
        if let Some(document) = document {
            app.open(document);
        }
        if let Some(message) = message {
            app.say(&message);
        }
        if is_after_loss {
            app.dialogs.message = Some((app.text("device.title").into(), app.text("device.lost").into()));
            let latest = app.dialogs.recovery.as_ref().and_then(|dialog| dialog.latest().cloned());
            if let Some(unsaved) = latest {
                app.open_unsaved(&unsaved);
            }
        }
        Ok(app)
    }

    /// The state of the document; `None` on the start page.
    #[must_use]
    pub fn studio(&self) -> Option<&Studio> {
        self.studio.as_ref()
    }

    /// Whether the window is about to close.
    #[must_use]
    pub fn is_closing(&self) -> bool {
        self.may_close
    }

    /// The settings of the 3D view; `None` on the start page.
    #[must_use]
    pub fn shown_view(&self) -> Option<ShownView> {
        self.studio.as_ref().map(|studio| self.panels.relief.shown(studio))
    }

    /// The export dialog, while it is open.
    #[must_use]
    pub fn export_dialog(&self) -> Option<&ExportDialog> {
        self.dialogs.export.as_ref()
    }

    fn use_language(&mut self, context: &Context) {
        if platform::IS_PAGE {
            platform::describe(&self.title, self.language.code());
            context.request_repaint();
            return;
        }
        if self.language != Language::Chinese {
            // Without a thread, Chinese names are shown as boxes.
            let _ = fonts::add_chinese_later(context);
        } else if !fonts::add_chinese(context) {
            // Without the font, all characters would be shown as boxes.
            self.language = Language::English;
            self.dialogs.message = Some((self.text("font.title").into(), self.text("font.missing").into()));
        }
    }

    fn remember(&self) {
        self.settings.write(self.folder.as_deref());
    }

    fn text(&self, key: &'static str) -> &'static str {
        self.language.text(key)
    }

    fn open(&mut self, document: Document) {
        if let Some(path) = document.path() {
            self.settings.opened(path);
            self.remember();
        }
        if !document.is_valid() {
            // This panel shows the errors of the text.
            self.show_below(Below::Text);
        }
        match &mut self.studio {
            Some(studio) => studio.open(document),
            None => self.studio = Some(Studio::new(self.session.clone(), Arc::clone(&self.wake), document)),
        }
        if let Some(studio) = &mut self.studio {
            studio.has_thumbnails = self.settings.thumbnails;
        }
        self.panels.reset();
        self.dialogs.export = None;
        self.note_document();
    }

    /// Records which document is open, in case the graphics device is lost, and watches its file.
    fn note_document(&self) {
        let document = self.studio.as_ref().map(|studio| &studio.document);
        self.file_watch.watch(document.and_then(Document::path));
        self.watch.set_document(document.map(|document| match document.path() {
            Some(path) => path.to_path_buf(),
            None => PathBuf::from(document.title()),
        }));
    }

    fn open_made(&mut self, made: Result<Document>) {
        match made {
            Ok(document) => self.open(document),
            Err(error) => self.say(&error.to_string()),
        }
    }

    fn say(&mut self, text: &str) {
        self.dialogs.message = Some((self.text("message.title").into(), self.language.message(text).into_owned()));
    }

    fn say_failure(&mut self, result: Result<()>) {
        if let Err(error) = result {
            self.say(&error.to_string());
        }
    }

    /// Carries out a pending action, or asks first if there are unsaved changes.
    fn leave(&mut self, pending: Pending, context: &Context) {
        match self.studio.as_ref().is_some_and(|studio| studio.document.is_changed()) {
            true => self.pending = Some(pending),
            false => self.go(pending, context),
        }
    }

    fn go(&mut self, pending: Pending, context: &Context) {
        self.recovery.forget();
        match pending {
            Pending::Open(path) => self.open_made(studio::open(&path)),
            Pending::Preset(name) => {
                if let Some(preset) = orogen::presets::find(name) {
                    self.open_made(Document::of_preset(preset));
                }
            }
            Pending::Empty => self.open_made(Document::empty(self.text("title.untitled"))),
            Pending::Unsaved(unsaved) => self.open_unsaved(&unsaved),
            Pending::StartPage => {
                self.studio = None;
                self.note_document();
            }
            Pending::Quit => {
                self.may_close = true;
                context.send_viewport_cmd(egui::ViewportCommand::Close);
            }
        }
    }

    /// Opens a dialog for choosing a file that starts at a path: that of the system, or else an own one.
    fn choose_file(&mut self, purpose: Purpose, at: Option<&Path>) {
        if self.dialogs.is_choosing() {
            return;
        }
        let system = || SystemDialog::open(purpose, at, self.language, &self.wake);
        self.dialogs.system = self.settings.has_system_dialogs.then(system).flatten();
        if self.dialogs.system.is_none() {
            self.dialogs.files = Some(FileDialog::new(purpose, at));
        }
    }

    fn show_kept_views(&mut self) {
        self.panels.relief.views.clone_from(&self.settings.views);
        self.remember();
    }

    /// Opens the color dialog with the colors of the view.
    fn edit_colors(&mut self) {
        let Some(studio) = &self.studio else { return };
        let is_edited = matches!(studio.look.coloring, Coloring::Edited(_));
        if let Some(palette) = palette(&studio.look.layer, &studio.look.coloring) {
            self.use_palette(RampEditor::new(&palette, is_edited));
        }
    }

    fn use_palette(&mut self, made: Result<RampEditor>) {
        match (made, &mut self.studio) {
            (Ok(ramp), Some(studio)) => {
                studio.look.coloring = ramp.coloring();
                self.dialogs.ramp = Some(ramp);
            }
            (Err(error), _) => self.say(&error.to_string()),
            _ => {}
        }
    }

    /// Saves the document to a file. Returns whether it was saved.
    fn save(&mut self, path: &Path) -> bool {
        let Some(studio) = &mut self.studio else { return false };
        match studio.save(path) {
            Ok(()) => {
                self.recovery.forget();
                self.settings.opened(path);
                self.remember();
                self.note_document();
                true
            }
            Err(error) => {
                self.say(&error.to_string());
                false
            }
        }
    }

    /// Opens files that are dropped onto the window.
    fn dropped(&mut self, context: &Context, actions: &mut Vec<Action>) {
        let Some(file) = context.input(|input| input.raw.dropped_files.first().cloned()) else { return };
        let wake = Arc::clone(&self.wake);
        match platform::receive(&file, move || wake()) {
            Some(chosen) => self.dialogs.upload = Some((Purpose::Open, chosen)),
            None => actions.push(Action::Open(file.path().to_path_buf())),
        }
    }

    /// Opens a text that was not saved.
    fn open_unsaved(&mut self, unsaved: &Unsaved) {
        match self.recovery.take(unsaved) {
            Some(document) => self.open(document),
            None => self.say(&self.language.fill("recovery.gone", &[("name", &unsaved.title)])),
        }
        self.no_longer_offer(unsaved);
    }

    fn no_longer_offer(&mut self, unsaved: &Unsaved) {
        if let Some(dialog) = &mut self.dialogs.recovery {
            dialog.remove(unsaved);
        }
    }

    /// Closes the window, or ends the page, if its graphics device is lost, and reports errors of the device.
    fn look_at_device(&mut self, context: &Context, frame: &eframe::Frame) {
        if let Some(after) = self.lose_device {
            let left = after - context.input(|input| input.time);
            match frame.wgpu_render_state() {
                Some(state) if left < 0.0 => {
                    state.device.destroy();
                    self.lose_device = None;
                }
                // An idle window is not drawn.
                _ => context.request_repaint_after(Duration::from_millis(100)),
            }
        }
        if self.watch.lost().is_some() {
            platform::end_page();
            self.may_close = true;
            self.keeps_recovered = true;
            context.send_viewport_cmd(egui::ViewportCommand::Close);
        } else if let Some(error) = self.watch.error() {
            self.dialogs.message = Some((self.text("device.title").into(), error));
        }
    }

    fn show_panels(&mut self, ui: &mut Ui, actions: &mut Vec<Action>) {
        Panel::top("menu")
            .frame(theme::side(ui))
            .show(ui, |ui| menu::show(ui, self.studio.as_ref(), &self.settings, self.language, actions));
        let shown = Shown {
            studio: self.studio.as_ref(),
            settings: &self.settings,
            gpu: self.gpu.as_ref(),
            ability: self.ability,
            language: self.language,
        };
        self.panels.show(ui, &shown, actions);
    }

    /// Asks what to do with unsaved changes.
    fn ask(&mut self, context: &Context) {
        let (Some(pending), Some(studio)) = (self.pending.clone(), &self.studio) else { return };
        match dialogs::unsaved(context, studio.document.title(), self.language) {
            Some(Decision::Save) => {
                self.pending = None;
                match studio.document.path().map(Path::to_path_buf) {
                    Some(path) => {
                        if self.save(&path) {
                            self.go(pending, context);
                        }
                    }
                    None => {
                        self.save_as();
                        self.after_save = Some(pending);
                    }
                }
            }
            Some(Decision::Drop) => {
                self.pending = None;
                self.go(pending, context);
            }
            Some(Decision::Cancel) => self.pending = None,
            None => {}
        }
    }
}

impl eframe::App for App {
    /// The color of the panels, which have no fill of their own: where a CPU draws, a fill takes as much time as a
    /// picture.
    fn clear_color(&self, visuals: &egui::Visuals) -> [f32; 4] {
        visuals.panel_fill.to_normalized_gamma_f32()
    }

    fn ui(&mut self, ui: &mut Ui, frame: &mut eframe::Frame) {
        let context = ui.ctx().clone();
        self.look_at_device(&context, frame);
        let mut actions = Vec::new();
        if let Some(studio) = &mut self.studio {
            studio.poll();
            studio.watch();
        }
        actions.extend(command::pressed(&context).into_iter().map(Action::Command));
        self.dropped(&context, &mut actions);
        theme::on_cleared(ui, |ui| self.show_panels(ui, &mut actions));
        let view = self.shown_view();
        self.dialogs.show(&context, self.studio.as_ref().zip(view.as_ref()), &self.wake, self.language, &mut actions);
        self.ask(&context);
        for action in actions {
            self.act(action, &context);
        }
        if !self.dialogs.is_choosing() {
            // The dialog was closed without a name.
            self.after_save = None;
        }
        if let Some(studio) = &mut self.studio {
            if studio.refresh() && studio.wait_for_picture() {
                // The panels are laid out again with the picture of the change, and drawn once.
                context.request_discard("a new picture");
            }
            self.recovery.keep(&studio.document);
            if let Some(frame) = studio.frame.as_ref().filter(|_| studio.is_done()) {
                self.recovery.picture(&studio.document, || recovery_dialog::picture(frame));
            }
            let mark = if studio.document.is_changed() { "*" } else { "" };
            let title = format!("{mark}{} – Orogen", studio.document.title());
            // Screen readers do not take it from the window.
            context.accesskit_node_builder(egui::accesskit_root_id(), |root| root.set_label(title.as_str()));
            if self.title != title {
                // Each command makes the window draw again, and some systems do not tell its title.
                self.title.clone_from(&title);
                platform::describe(&title, self.language.code());
                context.send_viewport_cmd(egui::ViewportCommand::Title(title));
            }
        }
        if context.input(|input| input.viewport().close_requested()) {
            if !self.may_close && self.studio.as_ref().is_some_and(|studio| studio.document.is_changed()) {
                context.send_viewport_cmd(egui::ViewportCommand::CancelClose);
                self.pending = Some(Pending::Quit);
            } else {
                if !self.keeps_recovered {
                    self.recovery.forget();
                }
                self.settings.window =
                    context.input(|input| input.viewport().inner_rect).map(|rect| [rect.width(), rect.height()]);
                self.remember();
            }
        }
        platform::end_frame();
    }
}
