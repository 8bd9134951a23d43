//! The tour: five steps from an empty project to an eroded mountain and its export. Each is done by hand or by a
//! button, and the next one begins when the recipe has what the step adds.

use eframe::egui::{self, Align2, Context, vec2};
use orogen::value::{Spanned, Value};

use super::action::Action;
use super::command::Command;
use crate::catalogue::Language;
use crate::editing::adding::{self, After};
use crate::editing::edit::Edit;
use crate::editing::names;
use crate::studio::Studio;

/// A step.
struct Step {
    /// The catalog key of what to do, and why.
    text: &'static str,
    what: What,
}

/// What a step does.
enum What {
    /// Opens an empty project.
    Empty,
    /// Adds an op after the last node, with parameters.
    Add(&'static str, fn() -> Vec<(&'static str, Value)>),
    /// Opens the export.
    Export,
}

static STEPS: [Step; 5] = [
    Step { text: "tour.empty", what: What::Empty },
    Step { text: "tour.noise", what: What::Add("ridged", || vec![("wavelength", Value::Number(6000.0))]) },
    Step {
        text: "tour.heights",
        what: What::Add("remap", || vec![("from", pair([-0.5, 1.0])), ("to", pair([-200.0, 1800.0]))]),
    },
    Step {
        text: "tour.erosion",
        what: What::Add("stream-power", || vec![("cell", Value::Number(40.0)), ("uplift", Value::Number(0.5))]),
    },
    Step { text: "tour.export", what: What::Export },
];

fn pair(ends: [f64; 2]) -> Value {
    Value::List(ends.map(|end| Spanned::unplaced(Value::Number(end))).into())
}

/// State of the tour.
#[derive(Debug, Default)]
pub struct Tour {
    step: usize,
}

impl Tour {
    /// Shows the current step; false once the tour is closed.
    pub fn show(
        &mut self,
        context: &Context,
        studio: Option<&Studio>,
        language: Language,
        actions: &mut Vec<Action>,
    ) -> bool {
        if STEPS.get(self.step).is_some_and(|step| step.is_done(studio)) {
            self.step += 1;
        }
        let Some(step) = STEPS.get(self.step) else { return false };
        let number = (self.step + 1).to_string();
        let title = language.fill("tour.title", &[("step", &number), ("steps", &STEPS.len().to_string())]);
        let (mut is_open, mut stays) = (true, true);
        egui::Window::new(title)
            .id(egui::Id::unique("tour"))
            .open(&mut is_open)
            .collapsible(false)
            .resizable(false)
            .anchor(Align2::RIGHT_BOTTOM, vec2(-16.0, -48.0))
            .default_width(WIDTH)
            .show(context, |ui| {
                ui.set_width(WIDTH);
                ui.label(language.text(step.text));
                ui.add_space(6.0);
                ui.horizontal(|ui| {
                    if ui.button(language.text("tour.do_it")).clicked() {
                        actions.extend(step.action(studio));
                        // There is no more to wait for.
                        stays = !matches!(step.what, What::Export);
                    }
                    if ui.button(language.text("tour.end")).clicked() {
                        stays = false;
                    }
                });
            });
        is_open && stays
    }
}

/// The width of the window, in points.
const WIDTH: f32 = 320.0;

impl Step {
    /// Whether the recipe has what the step adds.
    fn is_done(&self, studio: Option<&Studio>) -> bool {
        let Some(studio) = studio else { return false };
        let nodes = studio.document.recipe().nodes();
        match self.what {
            What::Empty => studio.document.is_valid() && nodes.is_empty(),
            What::Add(op, _) => nodes.iter().any(|named| named.node.spec().op == op),
            What::Export => false,
        }
    }

    /// The action that does the step.
    fn action(&self, studio: Option<&Studio>) -> Option<Action> {
        match self.what {
            What::Empty => Some(Action::Command(Command::Empty)),
            What::Export => Some(Action::Command(Command::Export)),
            What::Add(op, params) => {
                let recipe = studio?.document.recipe();
                let last = recipe.nodes().last().map(|named| named.name.as_str());
                let taken = recipe.nodes().iter().map(|named| named.name.as_str()).collect();
                let name = names::free(&names::of_op(op), &taken);
                let mut edit = adding::edit(recipe, name, op, last.map_or(After::Nothing, After::Node), None);
                if let Edit::Add { params: own, .. } = &mut edit {
                    *own = params().into_iter().map(|(key, value)| (key.to_owned(), value)).collect();
                }
                Some(Action::Edit(edit))
            }
        }
    }
}
