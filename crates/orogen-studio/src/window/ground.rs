//! The colors of the recipe's surfaces and terrain classes, next to the view.

use eframe::egui::{CollapsingHeader, Ui};

use super::action::Action;
use crate::catalogue::Language;
use crate::editing::edit::Edit;
use crate::editing::ground::Ground;
use crate::studio::Studio;

/// Minimum and maximum number of colors of a gradient.
const GRADIENT: [usize; 2] = [2, 8];

/// Shows fields for the colors.
pub fn show(ui: &mut Ui, studio: &Studio, language: Language, actions: &mut Vec<Action>) {
    for (ground, title) in [(Ground::Surface, "inspector.surfaces"), (Ground::Class, "inspector.classes")] {
        let all = ground.of(studio.document.recipe());
        if all.is_empty() {
            continue;
        }
        CollapsingHeader::new(language.text(title)).show(ui, |ui| {
            for (index, name, colors) in all {
                let mut edited = colors.clone();
                ui.horizontal(|ui| {
                    edited.iter_mut().for_each(|color| drop(ui.color_edit_button_srgb(color)));
                    // Only gradients have more than one color.
                    if colors.len() > 1 {
                        if colors.len() < GRADIENT[1] && ui.small_button("+").clicked() {
                            edited.extend(colors.last().copied());
                        }
                        if colors.len() > GRADIENT[0] && ui.small_button("−").clicked() {
                            edited.pop();
                        }
                    }
                    ui.label(name);
                });
                if edited != colors {
                    actions.push(Action::Edit(Edit::Colors { ground, index, colors: edited }));
                }
            }
        });
    }
}
