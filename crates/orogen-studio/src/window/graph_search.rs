//! The search for a new node of the graph.

use eframe::egui::{self, Key, Pos2, Rect, TextEdit, Ui, vec2};
use orogen::node::Node;

use crate::catalogue::Language;

/// A search, and the position of the new node.
#[derive(Debug, Default)]
pub struct Search {
    text: String,
    /// The position, in points of a graph at normal size.
    pub at: Pos2,
    is_new: bool,
}

/// The result of a search.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Found {
    /// The search continues.
    Nothing,
    /// An op was chosen.
    Op(&'static str),
    /// The search was closed.
    Closed,
}

impl Search {
    /// A search for a node at a position.
    #[must_use]
    pub fn new(at: Pos2) -> Search {
        Search { at, is_new: true, ..Search::default() }
    }

    /// Shows the search at a position of the screen.
    pub fn show(&mut self, ui: &Ui, rect: Rect, place: Pos2, language: Language) -> Found {
        let mut chosen = Found::Nothing;
        let mut is_open = true;
        let place = place.clamp(rect.min, (rect.max - vec2(260.0, 120.0)).max(rect.min));
        egui::Window::new(language.text("graph.add"))
            .open(&mut is_open)
            .fixed_pos(place)
            .fixed_size(vec2(250.0, 260.0))
            .collapsible(false)
            .show(ui.ctx(), |ui| {
                let field = ui.add(TextEdit::singleline(&mut self.text).hint_text(language.text("graph.search")));
                if std::mem::take(&mut self.is_new) {
                    field.request_focus();
                }
                let found = matches(&self.text);
                if field.lost_focus()
                    && ui.input(|input| input.key_pressed(Key::Enter))
                    && let Some(first) = found.first()
                {
                    chosen = Found::Op(first);
                }
                egui::ScrollArea::vertical().max_height(220.0).show(ui, |ui| {
                    for op in found {
                        let Some(node) = Node::named(op) else { continue };
                        let about = orogen::declare::short(node.spec().doc);
                        if ui.selectable_label(false, op).on_hover_text(about).clicked() {
                            chosen = Found::Op(op);
                        }
                    }
                });
            });
        let is_closed = ui.input(|input| input.key_pressed(Key::Escape)) || !is_open;
        if is_closed { Found::Closed } else { chosen }
    }
}

/// The ops whose name or description contains all words of a text. Ops whose name begins with the text come first.
#[must_use]
pub fn matches(text: &str) -> Vec<&'static str> {
    let text = text.trim().to_lowercase();
    let mut found: Vec<(u8, &'static str)> = Node::all()
        .iter()
        .map(Node::spec)
        // Inputs of subgraphs are written by recipes that use them.
        .filter(|spec| spec.op != "input")
        .filter_map(|spec| {
            let about = spec.doc.to_lowercase();
            let rank = match () {
                () if spec.op.starts_with(&text) => 0,
                () if spec.op.contains(&text) => 1,
                () if text.split_whitespace().all(|word| spec.op.contains(word) || about.contains(word)) => 2,
                () => return None,
            };
            Some((rank, spec.op))
        })
        .collect();
    found.sort_unstable();
    found.into_iter().map(|(_, op)| op).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nodes_are_found_by_name_and_description() {
        assert_eq!(matches("blur")[0], "blur");
        assert_eq!(matches("fb")[0], "fbm");
        assert!(matches("hydraulic").contains(&"pipes") || matches("erosion").contains(&"stream-power"));
        assert!(matches("no such thing").is_empty());
        assert_eq!(matches("").len() + 1, Node::all().len());
    }
}
