//! The brush on the map: its settings, the ring at the pointer, and the stroke while the button is pressed.

use eframe::egui::{self, Align2, Color32, CursorIcon, Event, Key, Pos2, Rect, Response, Stroke, Ui, Vec2};

use super::action::Action;
use super::fields::{self, Number};
use super::label::label;
use crate::catalogue::Language;
use crate::editing::brush::{Brush, Effect, Painting, RADII};
use crate::preview::frame::Frame;
use crate::studio::{self, Studio};
use crate::view::map_view::MapView;

/// State of the brush.
#[derive(Default)]
pub struct MapBrush {
    /// The settings; `None` until it is used.
    brush: Option<Brush>,
    /// The stroke that is being painted.
    painting: Option<Painting>,
}

/// The names of an effect and of its help, as keys of the catalog.
#[must_use]
pub fn names(effect: Effect) -> [&'static str; 2] {
    match effect {
        Effect::Paint => ["map.paint", "map.paint_help"],
        Effect::Erase => ["map.erase", "map.erase_help"],
        Effect::Raise => ["map.raise", "map.height_help"],
        Effect::Lower => ["map.lower", "map.height_help"],
    }
}

/// The factor by which a key press changes the radius.
const STEP: f64 = 1.2;

impl MapBrush {
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
            set(ui, "map.radius", &mut brush.radius, &length);
            set(ui, "map.hardness", &mut brush.hardness, &share);
            match effect.is_of_heights() {
                true => set(ui, "map.height", &mut brush.height, &Number { range: [0.0, 1e6], ..length }),
                false => set(ui, "map.strength", &mut brush.strength, &share),
            }
        });
    }

    /// Paints while the button is pressed; `[`, `]` and Ctrl with the wheel change the radius. A stroke begins only if
    /// the press is free, not one that closes a menu.
    pub fn paint(
        &mut self,
        ui: &Ui,
        response: &Response,
        (rect, view): (Rect, &MapView),
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
        let world = |at: Pos2| view.world((at - rect.min).into(), rect.size().into());
        let is_down = response.is_pointer_button_down_on() && ui.input(|input| input.pointer.primary_down());
        let begins = is_down && ui.input(|input| input.pointer.primary_pressed());
        match &mut self.painting {
            // A press and its release may occur in one frame.
            None if is_free && (begins || response.clicked()) => {
                let at = ui.input(|input| input.pointer.press_origin()).or(response.interact_pointer_pos());
                let Some(painting) = at.and_then(|at| begin(*brush, studio, world(at))) else { return };
                actions.push(Action::Edit(painting.edit()));
                match is_down && studio.document.is_valid() {
                    true => self.painting = Some(painting),
                    false => actions.push(Action::EndGesture),
                }
            }
            Some(painting) => {
                let moves = ui.input(|input| {
                    let moved = input.events.iter().filter_map(|event| match event {
                        Event::PointerMoved(at) => Some(world(*at)),
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
            None => {}
        }
    }

    /// Draws the rings of the radius and of the hardness around the pointer, and the line of the current stroke.
    pub fn draw(
        &self,
        painter: &egui::Painter,
        pointer: Option<Pos2>,
        (rect, view): (Rect, &MapView),
        studio: &Studio,
        language: Language,
    ) {
        let Some(brush) = &self.brush else { return };
        if let Some(painting) = &self.painting {
            let screen = |at: &[f64; 2]| rect.min + Vec2::from(view.screen(*at, rect.size().into()));
            let line: Vec<Pos2> = painting.line().iter().map(screen).collect();
            painter.line(line, Stroke::new(1.5, Color32::from_white_alpha(120)));
        }
        let Some(at) = pointer else { return };
        let radius = (brush.radius / view.scale) as f32;
        for (radius, width) in [(radius, 1.5), (radius * brush.hardness as f32, 1.0)] {
            painter.circle_stroke(at, radius, Stroke::new(width + 1.5, Color32::from_black_alpha(130)));
            painter.circle_stroke(at, radius, Stroke::new(width, Color32::WHITE));
        }
        let world = view.world((at - rect.min).into(), rect.size().into());
        if self.painting.is_none() && begin(*brush, studio, world).is_none() {
            label(painter, at + Vec2::new(0.0, 24.0), Align2::CENTER_TOP, language.text("map.nothing"));
        }
    }
}

fn begin(brush: Brush, studio: &Studio, at: [f64; 2]) -> Option<Painting> {
    let recipe = studio.document.recipe();
    let selected = studio.selected.first().map(String::as_str);
    Painting::begin(brush, recipe, selected, &studio::surface(recipe), at)
}
