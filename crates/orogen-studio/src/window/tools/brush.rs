//! The brush: its settings, the ring at the pointer, and the stroke while the button is pressed.

use eframe::egui::{self, Align2, Color32, CursorIcon, Event, Id, Key, Pos2, Response, Stroke, Ui, Vec2};

use super::Projection;
use crate::catalogue::Language;
use crate::editing::brush::{Brush, Effect, Painting, RADII};
use crate::preview::frame::Frame;
use crate::studio::{self, Studio};
use crate::window::action::Action;
use crate::window::fields::{self, Number};
use crate::window::label::label;

/// State of the brush.
#[derive(Default)]
pub struct BrushTool {
    /// The settings; `None` until it is used.
    brush: Option<Brush>,
    /// The stroke that is being painted, and the view in which it is.
    painting: Option<(Painting, Id)>,
}

/// The names of an effect and of its help, as keys of the catalog.
#[must_use]
pub fn names(effect: Effect) -> [&'static str; 2] {
    match effect {
        Effect::Paint => ["tool.paint", "tool.paint_help"],
        Effect::Erase => ["tool.erase", "tool.erase_help"],
        Effect::Raise => ["tool.raise", "tool.height_help"],
        Effect::Lower => ["tool.lower", "tool.height_help"],
    }
}

/// The factor by which a key press changes the radius.
const STEP: f64 = 1.2;

/// Number of sides of a ring.
const RING: u32 = 64;

impl BrushTool {
    /// The brush with an effect. A new brush suits the picture.
    fn with(&mut self, effect: Effect, frame: &Frame) -> &mut Brush {
        let brush = self.brush.get_or_insert_with(|| {
            let window = frame.window();
            let range = frame.range().map(|height| height as f32);
            Brush::fitting(effect, window.width.max(window.height) as f64 * window.cell, range)
        });
        brush.effect = effect;
        brush
    }

    /// Shows the settings.
    pub fn settings(&mut self, ui: &mut Ui, effect: Effect, frame: &Frame, language: Language) {
        let brush = self.with(effect, frame);
        let share = Number { range: [0.0, 1.0], default: 0.5, unit: "", is_whole: false };
        let length = Number { range: RADII, default: brush.radius, unit: "m", is_whole: false };
        let set = |ui: &mut Ui, key: &'static str, value: &mut f64, declared: &Number| {
            let name = language.text(key);
            ui.label(name);
            if let Some(new) = fields::number(ui, name, *value, declared).value {
                *value = new;
            }
        };
        ui.horizontal(|ui| {
            set(ui, "tool.radius", &mut brush.radius, &length);
            set(ui, "tool.hardness", &mut brush.hardness, &share);
            match effect.is_of_heights() {
                true => set(ui, "tool.height", &mut brush.height, &Number { range: [0.0, 1e6], ..length }),
                false => set(ui, "tool.strength", &mut brush.strength, &share),
            }
        });
    }

    /// Paints while the button is pressed; `[`, `]` and Ctrl with the wheel change the radius. A stroke begins only if
    /// the press is free, not one that closes a menu.
    pub fn paint(
        &mut self,
        ui: &Ui,
        response: &Response,
        projection: &Projection,
        (studio, is_free): (&Studio, bool),
        actions: &mut Vec<Action>,
    ) {
        let Some(brush) = &mut self.brush else { return };
        if response.contains_pointer() {
            let is_typing = ui.ctx().memory(|memory| memory.focused().is_some());
            let factor = ui.input(|input| {
                let key = |key: Key, factor: f64| if !is_typing && input.key_pressed(key) { factor } else { 1.0 };
                f64::from(input.zoom_delta()) * key(Key::OpenBracket, 1.0 / STEP) * key(Key::CloseBracket, STEP)
            });
            if factor != 1.0 {
                brush.scale(factor);
            }
            ui.ctx().set_cursor_icon(CursorIcon::Crosshair);
        }
        let is_down = response.is_pointer_button_down_on() && ui.input(|input| input.pointer.primary_down());
        let begins = is_down && ui.input(|input| input.pointer.primary_pressed());
        match &mut self.painting {
            // A press and its release may occur in one frame.
            None if is_free && (begins || response.clicked()) => {
                let at = ui.input(|input| input.pointer.press_origin()).or(response.interact_pointer_pos());
                let at = at.and_then(|at| projection.world(at));
                let Some(painting) = at.and_then(|at| begin(*brush, studio, at)) else { return };
                actions.push(Action::Edit(painting.edit()));
                match is_down && studio.document.is_valid() {
                    true => self.painting = Some((painting, response.id)),
                    false => actions.push(Action::EndGesture),
                }
            }
            Some((painting, view)) if *view == response.id => {
                let moves = ui.input(|input| {
                    let moved = input.events.iter().filter_map(|event| match event {
                        Event::PointerMoved(at) => projection.world(*at),
                        _ => None,
                    });
                    moved.collect::<Vec<[f64; 2]>>()
                });
                // All movements, because the pointer may move far between two frames.
                if moves.into_iter().filter(|at| painting.continue_to(*at)).count() > 0 {
                    actions.push(Action::Edit(painting.edit()));
                }
                if !is_down {
                    self.painting = None;
                    actions.push(Action::EndGesture);
                }
            }
            _ => {}
        }
    }

    /// Draws the rings of the radius and of the hardness around the pointer, and the line of the current stroke.
    pub fn draw(
        &self,
        painter: &egui::Painter,
        pointer: Option<Pos2>,
        projection: &Projection,
        studio: &Studio,
        language: Language,
    ) {
        let Some(brush) = &self.brush else { return };
        if let Some((painting, _)) = &self.painting {
            for part in projection.line(painting.line()) {
                painter.line(part, Stroke::new(1.5, Color32::from_white_alpha(120)));
            }
        }
        let Some((at, world)) = pointer.and_then(|at| Some((at, projection.world(at)?))) else { return };
        for (radius, width) in [(brush.radius, 1.5), (brush.radius * brush.hardness, 1.0)] {
            let ring: Vec<[f64; 2]> = (0..=RING)
                .map(|k| libm::sincos(std::f64::consts::TAU * f64::from(k) / f64::from(RING)))
                .map(|(sin, cos)| [world[0] + radius * cos, world[1] + radius * sin])
                .collect();
            for part in projection.line(&ring) {
                painter.line(part.clone(), Stroke::new(width + 1.5, Color32::from_black_alpha(130)));
                painter.line(part, Stroke::new(width, Color32::WHITE));
            }
        }
        if self.painting.is_none() && begin(*brush, studio, world).is_none() {
            label(painter, at + Vec2::new(0.0, 24.0), Align2::CENTER_TOP, language.text("tool.nothing"));
        }
    }
}

fn begin(brush: Brush, studio: &Studio, at: [f64; 2]) -> Option<Painting> {
    let recipe = studio.document.recipe();
    let selected = studio.selected.first().map(String::as_str);
    Painting::begin(brush, recipe, selected, &studio::surface(recipe), at)
}
