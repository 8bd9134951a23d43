//! A field for an expression: errors are shown while it is typed, and only a valid expression is applied.

use std::collections::HashMap;

use eframe::egui::text::{LayoutJob, TextFormat};
use eframe::egui::{self, FontId, Key, Modifiers, RichText, Stroke, TextEdit, Ui};

use super::action::Action;
use crate::catalogue::Language;
use crate::editing::expression::{ExpressionDiagnostic, Site, word_at};
use crate::studio::Studio;

/// An expression that is being typed.
#[derive(Debug)]
struct Typed {
    text: String,
    /// The expression of the recipe when typing started.
    own: String,
    fault: Option<ExpressionDiagnostic>,
    /// The position of the cursor, in bytes.
    cursor: usize,
}

/// Expressions that are being typed. They are kept when the keyboard focus moves elsewhere.
#[derive(Debug, Default)]
pub struct ExpressionFields {
    typed: HashMap<Site, Typed>,
}

/// Maximum number of completions that are shown.
const SHOWN: usize = 8;

const SIZE: f32 = 12.0;

impl ExpressionFields {
    /// Starts with a text that the recipe does not have yet.
    pub fn begin(&mut self, site: Site, own: &str, text: &str) {
        let typed = Typed { text: text.to_owned(), own: own.to_owned(), fault: None, cursor: text.len() };
        self.typed.insert(site, typed);
    }

    /// Drops the typed text.
    pub fn end(&mut self, site: &Site) {
        self.typed.remove(site);
    }

    /// Whether an expression is being typed.
    #[must_use]
    pub fn is_typed(&self, site: &Site) -> bool {
        self.typed.contains_key(site)
    }

    /// Shows the field; `own` is the expression in the recipe.
    pub fn show(
        &mut self,
        ui: &mut Ui,
        site: &Site,
        own: &str,
        studio: &Studio,
        language: Language,
        actions: &mut Vec<Action>,
    ) {
        let mut typed = self.typed.remove(site).unwrap_or_else(|| Typed {
            text: own.to_owned(),
            own: own.to_owned(),
            fault: None,
            cursor: own.len(),
        });
        let id = id_of(site);
        if typed.own != own && typed.text != own && !ui.ctx().memory(|memory| memory.has_focus(id)) {
            // The recipe was changed elsewhere, for example by undo.
            (typed.text, typed.fault) = (own.to_owned(), None);
        }
        own.clone_into(&mut typed.own);
        let before = typed.text.clone();
        let (plain, error) = (ui.visuals().text_color(), ui.visuals().error_fg_color);
        let fault = typed.fault.clone();
        let mut layouter = |ui: &Ui, text: &dyn egui::TextBuffer, width: f32| {
            let job = underlined(text.as_str(), fault.as_ref(), plain, Stroke::new(2.0, error), width);
            ui.fonts_mut(|fonts| fonts.layout_job(job))
        };
        let completes = ui.ctx().memory(|memory| memory.has_focus(id))
            && ui.input_mut(|input| input.consume_key(Modifiers::CTRL, Key::Period));
        let output = TextEdit::multiline(&mut typed.text)
            .id(id)
            .desired_rows(1)
            .desired_width(f32::INFINITY)
            .layouter(&mut layouter)
            .show(ui);
        let response = &output.response.response;
        let label = format!("{}.{}", site.node, site.key);
        response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::TextInput, true, label.clone()));
        if let Some(range) = output.cursor_range {
            let index: usize = range.primary.index.into();
            typed.cursor = typed.text.char_indices().nth(index).map_or(typed.text.len(), |(at, _)| at);
        }
        let has_ended = response.lost_focus();
        if let Some(fault) = &typed.fault {
            ui.colored_label(error, language.message(&fault.message));
        }
        self.words(ui, site, &mut typed, completes, studio, language);
        if typed.text != before {
            typed.fault = site.check(&studio.document, &typed.text).err();
            if typed.fault.is_none() {
                actions.push(Action::Edit(site.edit(&typed.text)));
                typed.own.clone_from(&typed.text);
            }
        }
        if has_ended {
            actions.push(Action::EndGesture);
        }
        // A valid expression is already in the recipe.
        if typed.fault.is_some() || typed.text != own {
            self.typed.insert(site.clone(), typed);
        }
    }

    /// Completions for the word at the cursor, and a menu of all words.
    fn words(
        &mut self,
        ui: &mut Ui,
        site: &Site,
        typed: &mut Typed,
        completes: bool,
        studio: &Studio,
        language: Language,
    ) {
        let span = word_at(&typed.text, typed.cursor);
        let begun = typed.text.get(span.clone()).unwrap_or_default().to_owned();
        let words = site.words(studio.document.recipe());
        let mut chosen = None;
        ui.horizontal_wrapped(|ui| {
            ui.menu_button(RichText::new("ƒ").small(), |ui| {
                egui::ScrollArea::vertical().max_height(320.0).show(ui, |ui| {
                    for word in &words {
                        if ui.button(&word.text).on_hover_text(&word.about).clicked() {
                            chosen = Some((typed.cursor..typed.cursor, word.text.clone()));
                            ui.close();
                        }
                    }
                });
            })
            .response
            .on_hover_text(language.text("inspector.words"));
            if begun.is_empty() || typed.fault.is_none() && typed.text == typed.own && !completes {
                return;
            }
            let found = words.iter().filter(|word| word.text.starts_with(&begun) && word.text != begun);
            for (k, word) in found.take(SHOWN).enumerate() {
                let button = egui::Button::new(RichText::new(&word.text).monospace().small()).small();
                if ui.add(button).on_hover_text(&word.about).clicked() || (completes && k == 0) {
                    chosen = Some((span.clone(), word.text.clone()));
                }
            }
        });
        if let Some((span, word)) = chosen.filter(|(span, _)| typed.text.is_char_boundary(span.start)) {
            typed.cursor = span.start + word.len();
            typed.text.replace_range(span, &word);
            let id = id_of(site);
            let index = typed.text.get(..typed.cursor).map_or(0, |before| before.chars().count());
            if let Some(mut state) = TextEdit::load_state(ui.ctx(), id) {
                let cursor = egui::text::CCursor::new(index);
                state.cursor.set_char_range(Some(egui::text::CCursorRange::one(cursor)));
                state.store(ui.ctx(), id);
            }
            ui.ctx().memory_mut(|memory| memory.request_focus(id));
        }
    }
}

/// The identifier of the field of an expression in the interface.
fn id_of(site: &Site) -> egui::Id {
    egui::Id::unique(("expression", &site.node, &site.key))
}

/// Lays out an expression with the erroneous part underlined.
fn underlined(
    text: &str,
    fault: Option<&ExpressionDiagnostic>,
    color: egui::Color32,
    stroke: Stroke,
    width: f32,
) -> LayoutJob {
    let mut job = LayoutJob::default();
    job.wrap.max_width = width;
    let format =
        |underline: Stroke| TextFormat { font_id: FontId::monospace(SIZE), color, underline, ..TextFormat::default() };
    // The error may refer to the text before the last character was typed.
    let span = fault.map(|fault| fault.span.clone()).filter(|span| text.get(span.clone()).is_some());
    let span = span.unwrap_or(text.len()..text.len());
    let parts = [(0..span.start, Stroke::NONE), (span.clone(), stroke), (span.end..text.len(), Stroke::NONE)];
    for (part, underline) in parts {
        if let Some(part) = text.get(part).filter(|part| !part.is_empty()) {
            job.append(part, 0.0, format(underline));
        }
    }
    if text.is_empty() {
        job.append("", 0.0, format(Stroke::NONE));
    }
    job
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_wrong_part_is_underlined() {
        let fault = ExpressionDiagnostic { span: 4..8, message: String::new() };
        let job =
            underlined("a * hils + 1", Some(&fault), egui::Color32::WHITE, Stroke::new(1.0, egui::Color32::RED), 99.0);
        assert_eq!(job.text, "a * hils + 1");
        let lines: Vec<(&str, bool)> = job
            .sections
            .iter()
            .map(|part| {
                (&job.text[part.byte_range.start.into()..part.byte_range.end.into()], part.format.underline.width > 0.0)
            })
            .collect();
        assert_eq!(lines, [("a * ", false), ("hils", true), (" + 1", false)]);
        assert_eq!(underlined("a", Some(&fault), egui::Color32::WHITE, Stroke::NONE, 99.0).text, "a");
    }
}
