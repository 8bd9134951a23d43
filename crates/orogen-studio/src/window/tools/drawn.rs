//! The question what a finished drawing does.

use eframe::egui::{Align, Area, Frame, Id, Key, Layout, Order, Pos2, Response, Ui};

use crate::catalogue::Language;
use crate::editing::drawing_use::{Land, Use};
use crate::studio::{self, Studio};
use crate::window::action::Action;

/// A finished drawing.
pub struct Drawn {
    op: &'static str,
    points: Vec<[f64; 2]>,
    /// The view in which it was drawn, and where the question is shown.
    view: Id,
    at: Pos2,
}

impl Drawn {
    /// A finished drawing by an op in a view.
    #[must_use]
    pub fn new(op: &'static str, points: Vec<[f64; 2]>, view: Id, at: Pos2) -> Drawn {
        Drawn { op, points, view, at }
    }

    /// Its op.
    #[must_use]
    pub fn op(&self) -> &'static str {
        self.op
    }

    /// Its points, in metres.
    #[must_use]
    pub fn points(&self) -> &[[f64; 2]] {
        &self.points
    }

    /// Shows the question in the view with the drawing. Returns whether it is answered. A click beside it keeps the
    /// drawing without a use, and Escape discards it.
    pub fn is_answered(
        &self,
        ui: &Ui,
        response: &Response,
        studio: &Studio,
        language: Language,
        actions: &mut Vec<Action>,
    ) -> bool {
        if response.id != self.view {
            return false;
        }
        let recipe = studio.document.recipe();
        let mut chosen = response.clicked().then_some(Use::Alone);
        let area =
            Area::new(Id::unique("use of a drawing")).order(Order::Foreground).fixed_pos(self.at).constrain(true);
        area.show(ui.ctx(), |ui| {
            Frame::popup(ui.style()).show(ui, |ui| {
                ui.with_layout(Layout::top_down_justified(Align::LEFT), |ui| {
                    ui.set_max_width(260.0);
                    ui.label(language.text("drawing.question"));
                    for other in Use::of(self.op, recipe, studio.selected.first().map(String::as_str)) {
                        let [name, help] = other.names(self.op);
                        let node = studio.selected.first().map_or("", String::as_str);
                        let choice = ui.button(language.fill(name, &[("node", node)]));
                        if choice.on_hover_text(language.text(help)).clicked() {
                            chosen = Some(other);
                        }
                    }
                });
            });
        });
        if ui.input(|input| input.key_pressed(Key::Escape)) {
            return true;
        }
        let Some(chosen) = chosen else { return false };
        let frame = studio.frame.as_deref();
        let land = Land {
            recipe,
            output: &studio::surface(recipe),
            range: frame.map(|frame| frame.range()),
            height: &|at| frame.and_then(|frame| frame.at(at)).map(|[_, height]| f64::from(height)),
        };
        actions.push(Action::Edit(land.edit(
            chosen,
            self.op,
            &self.points,
            studio.selected.first().map(String::as_str),
        )));
        true
    }
}
