//! The recipe as text, with its errors at their lines.

use eframe::egui::text::{LayoutJob, TextFormat};
use eframe::egui::{self, Align2, Color32, FontId, Key, Modifiers, Sense, Stroke, TextEdit, Ui, vec2};
use orogen::grid::error::Diagnostic;
use orogen::node::Node;

use super::action::Action;
use crate::catalogue::Language;
use crate::studio::Studio;

/// State of the panel.
#[derive(Debug, Default)]
pub struct TextPanel {
    /// The text as it is being typed.
    text: String,
    /// The revision of the text.
    revision: Option<u64>,
    /// A line to be shown.
    line: Option<usize>,
    /// Completions for the word at the cursor, and the character where that word begins.
    completions: Vec<String>,
    word: Option<(usize, usize)>,
}

const SIZE: f32 = 12.5;

/// Maximum number of completions that are shown.
const SHOWN: usize = 12;

impl TextPanel {
    /// Shows a line, from 1.
    pub fn go_to(&mut self, line: usize) {
        self.line = Some(line);
    }

    /// Shows the panel.
    pub fn show(&mut self, ui: &mut Ui, studio: &Studio, language: Language, actions: &mut Vec<Action>) {
        if self.revision != Some(studio.document.revision()) {
            self.revision = Some(studio.document.revision());
            if self.text != studio.document.text() {
                self.text = studio.document.text().to_owned();
            }
        }
        let faults = studio.document.diagnostics();
        if !faults.is_empty() {
            self.faults(ui, faults, language, actions);
        }
        let is_dark = ui.visuals().dark_mode;
        let error = ui.visuals().error_fg_color;
        let plain = ui.visuals().text_color();
        let mut layouter = |ui: &Ui, text: &dyn egui::TextBuffer, _: f32| {
            let job = highlighted(text.as_str(), faults, is_dark, plain, error);
            ui.fonts_mut(|fonts| fonts.layout_job(job))
        };
        let go_to = self.line.take();
        egui::ScrollArea::both().auto_shrink(false).show(ui, |ui| {
            ui.horizontal_top(|ui| {
                let numbers = self.text.lines().count().max(1);
                let width = 10.0 + 7.5 * numbers.to_string().len() as f32;
                let (gutter, _) = ui.allocate_exact_size(vec2(width, 1.0), Sense::hover());
                let before = self.text.clone();
                let output = TextEdit::multiline(&mut self.text)
                    .id_salt("recipe")
                    .code_editor()
                    .frame(egui::Frame::NONE)
                    .desired_width(f32::INFINITY)
                    .desired_rows(8)
                    .layouter(&mut layouter)
                    .show(ui);
                let response = &output.response.response;
                response.widget_info(|| {
                    egui::WidgetInfo::labeled(egui::Role::TextInput, true, language.text("spoken.recipe"))
                });
                let row = ui.fonts_mut(|fonts| fonts.row_height(&FontId::monospace(SIZE)));
                let painter = ui.painter();
                for n in 1..=numbers {
                    // Lines are not wrapped, so each line is one row.
                    let Some(line) = output.galley.rows.get(n - 1) else { break };
                    let y = output.galley_pos.y + line.rect().top();
                    let place = egui::pos2(gutter.right() - 6.0, y);
                    if ui.is_rect_visible(egui::Rect::from_min_size(place, vec2(1.0, row))) {
                        let is_wrong =
                            faults.iter().any(|fault| fault.place.as_ref().is_some_and(|place| place.line == n));
                        let color = if is_wrong { error } else { ui.visuals().weak_text_color() };
                        painter.text(place, Align2::RIGHT_TOP, n.to_string(), FontId::monospace(SIZE), color);
                    }
                }
                if let Some(line) = go_to {
                    let rows = &output.galley.rows;
                    let top = rows.get(line.max(1) - 1).map_or(0.0, |row| row.rect().top());
                    let top = output.galley_pos + vec2(0.0, top);
                    ui.scroll_to_rect(egui::Rect::from_min_size(top, vec2(10.0, row)), Some(egui::Align::Center));
                }
                if before != self.text {
                    actions.push(Action::Type(self.text.clone()));
                }
                if response.lost_focus() {
                    actions.push(Action::EndGesture);
                }
                let cursor = output.cursor_range.map(|range| range.primary.index);
                let asks = ui.input_mut(|input| input.consume_key(Modifiers::CTRL, Key::Period));
                if asks && let Some(cursor) = cursor {
                    let cursor: usize = cursor.into();
                    (self.completions, self.word) = complete(&self.text, cursor, studio);
                } else if before != self.text {
                    self.completions.clear();
                }
                let below = output.galley_pos + vec2(20.0, row * 2.0);
                self.completion(ui, below, language, actions);
            });
        });
    }

    /// The list of errors; a click shows the line.
    fn faults(&self, ui: &mut Ui, faults: &[Diagnostic], language: Language, actions: &mut Vec<Action>) {
        egui::ScrollArea::vertical().id_salt("faults").max_height(72.0).show(ui, |ui| {
            for fault in faults {
                let message = language.message(&fault.message);
                let text = match &fault.place {
                    Some(place) => format!("{}: {message}", place.line),
                    None => message.into_owned(),
                };
                let label = egui::Label::new(egui::RichText::new(text).color(ui.visuals().error_fg_color))
                    .sense(Sense::click());
                if ui.add(label).clicked()
                    && let Some(place) = &fault.place
                {
                    actions.push(Action::GoToLine(place.line));
                }
            }
        });
    }

    /// The list of completions.
    fn completion(&mut self, ui: &Ui, at: egui::Pos2, language: Language, actions: &mut Vec<Action>) {
        let Some((from, to)) = self.word.filter(|_| !self.completions.is_empty()) else { return };
        let mut chosen = None;
        egui::Window::new(language.text("text.complete")).fixed_pos(at).collapsible(false).resizable(false).show(
            ui.ctx(),
            |ui| {
                for word in self.completions.iter().take(SHOWN) {
                    if ui.selectable_label(false, word).clicked() {
                        chosen = Some(word.clone());
                    }
                }
            },
        );
        if ui.input(|input| input.key_pressed(Key::Escape)) {
            self.completions.clear();
        }
        if let Some(word) = chosen {
            let start: String = self.text.chars().take(from).collect();
            let end: String = self.text.chars().skip(to).collect();
            self.text = format!("{start}{word}{end}");
            self.completions.clear();
            actions.push(Action::Type(self.text.clone()));
        }
    }
}

/// Completions for the word before a character of the text: ops in quotes after `op`, nodes in other quotes, otherwise
/// the keys of the node's op.
#[must_use]
pub fn complete(text: &str, cursor: usize, studio: &Studio) -> (Vec<String>, Option<(usize, usize)>) {
    let chars: Vec<char> = text.chars().collect();
    let cursor = cursor.min(chars.len());
    let is_word = |c: char| c.is_alphanumeric() || matches!(c, '_' | '-' | '.');
    let start = (0..cursor).rev().take_while(|k| is_word(chars[*k])).last().unwrap_or(cursor);
    let begun: String = chars[start..cursor].iter().collect();
    let line_start = (0..start).rev().find(|k| chars[*k] == '\n').map_or(0, |k| k + 1);
    let line: String = chars[line_start..start].iter().collect();
    let is_quoted = line.matches('"').count() % 2 == 1;
    let key = line.split('=').next().unwrap_or_default().trim().to_owned();
    let candidates: Vec<String> = match (is_quoted, key.as_str()) {
        (true, "op") => Node::all().iter().map(|node| node.spec().op.to_owned()).collect(),
        (true, _) => {
            let nodes = studio.document.recipe().nodes().iter();
            nodes
                .flat_map(|named| {
                    let layers =
                        named.node.layers().iter().skip(1).map(|layer| format!("{}.{}", named.name, layer.name));
                    std::iter::once(named.name.clone()).chain(layers.collect::<Vec<_>>())
                })
                .collect()
        }
        (false, _) => {
            let before: String = chars[..line_start].iter().collect();
            let section = before.rsplit("\n[").next().unwrap_or_default();
            let op = section.lines().find_map(|line| {
                line.trim()
                    .strip_prefix("op")?
                    .trim()
                    .strip_prefix('=')
                    .map(|op| op.trim().trim_matches('"').to_owned())
            });
            match op.as_deref().and_then(Node::named) {
                Some(node) => {
                    let spec = node.spec();
                    let keys =
                        spec.inputs.iter().map(|input| input.name).chain(spec.params.iter().map(|param| param.name));
                    keys.chain(["mask"]).map(|key| format!("{key} = ")).collect()
                }
                None => {
                    ["[nodes.", "[outputs]", "[world]", "[parameters.", "seed = ", "cell = ", "size = ", "sea_level = "]
                        .map(str::to_owned)
                        .into()
                }
            }
        }
    };
    let mut found: Vec<String> =
        candidates.into_iter().filter(|word| word.starts_with(&begun) && *word != begun).collect();
    found.sort();
    (found, Some((start, cursor)))
}

/// The text in colors: comments, keys, texts, numbers, sections; errors are underlined.
fn highlighted(text: &str, faults: &[Diagnostic], is_dark: bool, plain: Color32, error: Color32) -> LayoutJob {
    let tone = |dark: u32, light: u32| {
        let hex = if is_dark { dark } else { light };
        Color32::from_rgb((hex >> 16) as u8, (hex >> 8) as u8, hex as u8)
    };
    let (comment, section, string, value) = (
        tone(0x7a_8590, 0x6a_737d),
        tone(0x8a_b4f8, 0x1a_56b0),
        tone(0xa5_c98a, 0x2c_6e2f),
        tone(0xe5_b567, 0x9a_5b00),
    );
    let mut job = LayoutJob::default();
    let font = FontId::monospace(SIZE);
    for (n, line) in text.split_inclusive('\n').enumerate() {
        let marked = faults.iter().filter_map(|fault| fault.place.as_ref()).find(|place| place.line == n + 1);
        let mut append = |part: &str, color: Color32| {
            if !part.is_empty() {
                let underline = if marked.is_some() { Stroke::new(1.0, error) } else { Stroke::NONE };
                job.append(part, 0.0, TextFormat { font_id: font.clone(), color, underline, ..TextFormat::default() });
            }
        };
        let trimmed = line.trim_start();
        if trimmed.starts_with('#') {
            append(line, comment);
            continue;
        }
        if trimmed.starts_with('[') {
            append(line, section);
            continue;
        }
        match line.split_once('=') {
            Some((key, rest)) => {
                append(key, plain);
                append("=", comment);
                // A comment may follow the value, unless the `#` is inside a text.
                let end = comment_start(rest);
                let (own, note) = rest.split_at(end);
                let is_text = own.trim_start().starts_with(['"', '\'']);
                append(own, if is_text { string } else { value });
                append(note, comment);
            }
            None => append(line, value),
        }
    }
    job
}

/// The position where the comment of a line begins; the length of the line if it has none.
fn comment_start(line: &str) -> usize {
    let mut quote = None;
    for (at, c) in line.char_indices() {
        match (c, quote) {
            ('#', None) => return at,
            ('"' | '\'', None) => quote = Some(c),
            (c, Some(open)) if c == open => quote = None,
            _ => {}
        }
    }
    line.len()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn comments_begin_outside_of_texts() {
        for (line, expect) in [(" 1 # one", 3), (" \"a#b\" # c", 7), (" '#'", 4), ("", 0)] {
            assert_eq!(comment_start(line), expect, "{line}");
        }
    }

    #[test]
    fn all_of_a_text_is_shown() {
        let text = "# a\n[world]\nseed = 1 # b\nname = \"x\"\nrest\n\n";
        let job = highlighted(text, &[], true, Color32::WHITE, Color32::RED);
        assert_eq!(job.text, text);
    }
}
