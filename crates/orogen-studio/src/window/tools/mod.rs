//! The tools for the land, in 3D and on the map: a profile, drawn lines and areas, and a brush.

mod brush;
mod drawing;
mod drawn;
mod profile;
mod projection;

use eframe::egui::{self, Context, PointerButton, Response, ScrollArea, Ui, UiBuilder, Vec2};

use self::brush::BrushTool;
use self::drawing::Drawing;
use self::profile::Profile;
pub use self::projection::Projection;
use super::action::Action;
use crate::catalogue::Language;
use crate::editing::brush::Effect;
use crate::editing::drawing::OPS;
use crate::preview::frame::Frame;
use crate::studio::Studio;

/// What a drag or a click on the land does.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
enum Tool {
    /// Moves the view.
    #[default]
    Move,
    /// Draws the line of a profile.
    Profile,
    /// Draws a line or an area, by its op.
    Draw(&'static str),
    /// Paints with a brush.
    Brush(Effect),
}

impl Tool {
    /// The catalog keys of its name and its help.
    fn names(self) -> [&'static str; 2] {
        match self {
            Tool::Move => ["tool.move", "tool.move_help"],
            Tool::Profile => ["tool.profile", "tool.profile_help"],
            Tool::Draw(op) if op == OPS[0] => ["tool.path", "tool.draw_help"],
            Tool::Draw(_) => ["tool.polygon", "tool.draw_help"],
            Tool::Brush(effect) => brush::names(effect),
        }
    }
}

/// Height of the row with the settings of a tool, in points.
const ROW: f32 = 24.0;

/// The state of the tools. All views have the same tool.
#[derive(Default)]
pub struct Tools {
    tool: Tool,
    profile: Profile,
    drawing: Drawing,
    brush: BrushTool,
    /// Whether a menu or list was open in the previous frame.
    had_popup: bool,
    /// Whether a click is meant for the land.
    is_free: bool,
}

impl Tools {
    /// Starts drawing a line or an area.
    pub fn draw_op(&mut self, op: &'static str) {
        self.tool = Tool::Draw(op);
        self.drawing.clear();
    }

    /// Selects a brush.
    pub fn take_brush(&mut self, effect: Effect) {
        self.tool = Tool::Brush(effect);
    }

    /// Begins a frame.
    pub fn begin(&mut self, context: &Context) {
        // A click that closes a menu is not meant for the land.
        let is_popup = egui::Popup::is_any_open(context);
        self.is_free = !std::mem::replace(&mut self.had_popup, is_popup) && !is_popup;
    }

    /// Shows the choice of the tool.
    pub fn choice(&mut self, ui: &mut Ui, language: Language) {
        let drawn = OPS.map(Tool::Draw);
        let brushes = Effect::ALL.map(Tool::Brush);
        for tool in [Tool::Move, Tool::Profile].into_iter().chain(drawn).chain(brushes) {
            let [name, help] = tool.names();
            let choice = ui.selectable_label(self.tool == tool, language.text(name));
            if choice.on_hover_text(language.text(help)).clicked() {
                self.tool = tool;
                self.drawing.clear();
            }
        }
        if self.profile.is_there() && ui.button(language.text("tool.clear")).clicked() {
            self.profile = Profile::default();
        }
    }

    /// Shows the settings of the tool, or its help. The row is always there, so that the view below stays where it is
    /// when the tool changes.
    pub fn settings(&mut self, ui: &mut Ui, studio: &Studio, language: Language) {
        let (row, _) = ui.allocate_exact_size(Vec2::new(ui.available_width(), ROW), egui::Sense::hover());
        ui.scope_builder(UiBuilder::new().max_rect(row), |ui| {
            ScrollArea::horizontal().id_salt("tool").auto_shrink(false).show(ui, |ui| {
                match (self.tool, &studio.frame) {
                    (Tool::Brush(effect), Some(frame)) => self.brush.settings(ui, effect, frame, language),
                    (tool, _) => drop(ui.weak(language.text(tool.names()[1]))),
                }
            });
        });
    }

    /// Whether the tool only moves the view.
    #[must_use]
    pub fn moves(&self) -> bool {
        self.tool == Tool::Move
    }

    /// Whether the tool is a brush, which uses Ctrl with the wheel.
    #[must_use]
    pub fn is_brush(&self) -> bool {
        matches!(self.tool, Tool::Brush(_))
    }

    /// Whether the tool uses drags with a button.
    #[must_use]
    pub fn takes_drags(&self, button: PointerButton) -> bool {
        button == PointerButton::Primary && (self.is_brush() || self.tool == Tool::Profile)
    }

    /// Uses the tool on a view. Returns whether a point of a drawing is being dragged; the view must not move then.
    pub fn use_on(
        &mut self,
        ui: &Ui,
        response: &Response,
        projection: &Projection,
        (studio, language): (&Studio, Language),
        actions: &mut Vec<Action>,
    ) -> bool {
        // With a brush, the points of a drawing cannot be dragged.
        let is_dragging = !self.is_brush() && drawing::handles(ui, projection, (studio, language), actions);
        match self.tool {
            Tool::Move => {}
            Tool::Profile => self.profile.drag(response, projection),
            Tool::Draw(op) => {
                if self.is_free && self.drawing.click(ui, response, projection, op) {
                    self.tool = Tool::Move;
                }
            }
            Tool::Brush(_) => self.brush.paint(ui, response, projection, (studio, self.is_free), actions),
        }
        self.drawing.ask(ui, response, (studio, language), actions);
        is_dragging
    }

    /// Draws the tool on a view.
    pub fn draw(
        &self,
        ui: &Ui,
        response: &Response,
        projection: &Projection,
        (studio, frame): (&Studio, &Frame),
        language: Language,
    ) {
        let painter = ui.painter_at(projection.rect);
        self.drawing.draw(&painter, projection, studio);
        self.profile.draw(ui, &painter, projection, frame);
        if self.is_brush() {
            self.brush.draw(&painter, response.hover_pos(), projection, studio, language);
        }
    }
}
