//! The search for a new node of the graph.

use std::cmp::Reverse;
use std::collections::HashMap;
use std::sync::{Arc, LazyLock};

use eframe::egui::text::{LayoutJob, TextFormat};
use eframe::egui::{
    self, Button, CollapsingHeader, ColorImage, Context, FontId, Image, Key, Pos2, Rect, TextEdit, TextureHandle,
    TextureId, TextureOptions, Ui, Vec2, WidgetText, vec2,
};
use orogen::Session;
use orogen::node::Node;
use orogen::presets;

use super::op_groups;
use crate::catalogue::Language;
use crate::preview::op_pictures::OpPictures;

/// The size of the list, and the number of letters of a description on one of its lines.
const WIDTH: f32 = 380.0;
const HEIGHT: f32 = 400.0;
const LETTERS: usize = 55;

/// The side of the picture of an op.
const PICTURE: f32 = 36.0;

/// Number of ops that are listed before the groups: those that presets use most.
const COMMON: usize = 4;

/// Small pictures of the ops on the graphics card.
pub struct OpTextures {
    pictures: OpPictures,
    textures: HashMap<String, TextureHandle>,
}

impl OpTextures {
    /// No pictures yet; they wake the window of the context.
    #[must_use]
    pub fn new(context: &Context) -> OpTextures {
        let context = context.clone();
        let wake = Arc::new(move || context.request_repaint());
        OpTextures { pictures: OpPictures::new(wake), textures: HashMap::new() }
    }

    /// Makes the pictures, at the first call, and takes those that are made.
    pub fn update(&mut self, session: &Session) {
        self.pictures.update(session);
    }

    fn of(&mut self, context: &Context, op: &str) -> Option<TextureId> {
        if let Some(texture) = self.textures.get(op) {
            return Some(texture.id());
        }
        let picture = self.pictures.of(op)?;
        let image = ColorImage::from_rgba_unmultiplied(picture.size, &picture.pixels);
        let texture = context.load_texture(format!("op {op}"), image, TextureOptions::LINEAR);
        let id = texture.id();
        self.textures.insert(op.to_owned(), texture);
        Some(id)
    }
}

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
    pub fn show(
        &mut self,
        ui: &Ui,
        (rect, place): (Rect, Pos2),
        pictures: &mut OpTextures,
        language: Language,
    ) -> Found {
        let mut chosen = Found::Nothing;
        let mut is_open = true;
        let place = place.clamp(rect.min, (rect.max - vec2(WIDTH + 10.0, 200.0)).max(rect.min));
        egui::Window::new(language.text("graph.add"))
            .open(&mut is_open)
            .fixed_pos(place)
            .fixed_size(vec2(WIDTH, HEIGHT + 40.0))
            .collapsible(false)
            .show(ui.ctx(), |ui| {
                let field = ui.add(
                    TextEdit::singleline(&mut self.text).desired_width(WIDTH).hint_text(language.text("graph.search")),
                );
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
                let is_browsed = self.text.trim().is_empty();
                egui::ScrollArea::vertical().max_height(HEIGHT).auto_shrink([false, true]).show(ui, |ui| {
                    let mut list = |ui: &mut Ui, ops: &[&'static str]| {
                        for op in ops {
                            if op_entry(ui, op, pictures, language) {
                                chosen = Found::Op(op);
                            }
                        }
                    };
                    match is_browsed {
                        true => {
                            ui.strong(language.text("ops.common"));
                            list(ui, &found[..COMMON.min(found.len())]);
                            for group in &op_groups::ALL {
                                CollapsingHeader::new(language.text(group.name)).show(ui, |ui| list(ui, group.ops));
                            }
                        }
                        false => list(ui, &found),
                    }
                });
            });
        let is_closed = ui.input(|input| input.key_pressed(Key::Escape)) || !is_open;
        if is_closed { Found::Closed } else { chosen }
    }
}

/// An entry for an op; whether it was clicked.
fn op_entry(ui: &mut Ui, op: &str, pictures: &mut OpTextures, language: Language) -> bool {
    let Some(node) = Node::named(op) else { return false };
    let about = language.told_shortly(node.spec().doc);
    let words = WidgetText::from(entry(ui, op, &about, language));
    let side = Vec2::splat(PICTURE);
    let entry = match pictures.of(ui.ctx(), op) {
        Some(picture) => ui.add(Button::selectable(false, (Image::new((picture, side)), words))),
        None => ui.add(Button::selectable(false, words).min_size(vec2(0.0, PICTURE))),
    };
    entry.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Button, true, language.named(op)));
    entry.on_hover_text(about).clicked()
}

/// The text of an entry: the name of the op, and its description on one line.
fn entry(ui: &Ui, op: &str, about: &str, language: Language) -> LayoutJob {
    let format = |size: f32, color| TextFormat::simple(FontId::proportional(size), color);
    let mut job = LayoutJob::default();
    let name = language.named(op);
    job.append(name, 0.0, format(13.5, ui.visuals().strong_text_color()));
    if name != op {
        job.append(op, 8.0, format(11.0, ui.visuals().weak_text_color()));
    }
    job.append("\n", 0.0, format(11.0, ui.visuals().weak_text_color()));
    // Chinese letters are more than twice as wide.
    let letters = if language == Language::Chinese { LETTERS * 2 / 5 } else { LETTERS };
    let short = match about.char_indices().nth(letters) {
        Some((end, _)) => format!("{} …", about[..end].trim_end()),
        None => about.to_owned(),
    };
    job.append(&short, 0.0, format(11.0, ui.visuals().weak_text_color()));
    job
}

/// How often presets use an op.
fn uses(op: &str) -> usize {
    static USES: LazyLock<HashMap<String, usize>> = LazyLock::new(|| {
        let mut uses = HashMap::new();
        let lines = presets::all().iter().flat_map(|preset| preset.text.lines());
        for op in lines.filter_map(|line| line.strip_prefix("op = \"")?.split('"').next()) {
            *uses.entry(op.to_owned()).or_default() += 1;
        }
        uses
    });
    USES.get(op).copied().unwrap_or_default()
}

/// The ops whose name or description, in any language, contains all words of a text. Ops come first whose name begins
/// with the text, then those with a word of the name or the short description that does, then others; among these, the
/// ones that presets use most.
#[must_use]
pub fn matches(text: &str) -> Vec<&'static str> {
    let text = text.trim().to_lowercase();
    let begins = |words: &str| words.split(|c: char| !c.is_alphanumeric()).any(|word| word.starts_with(&text));
    let mut found: Vec<(u8, Reverse<usize>, &'static str)> = Node::all()
        .iter()
        .map(Node::spec)
        // Inputs of subgraphs are written by recipes that use them.
        .filter(|spec| spec.op != "input")
        .filter_map(|spec| {
            let names = Language::ALL.map(|language| language.named(spec.op).to_lowercase());
            let about = Language::ALL.map(|language| language.told(spec.doc).to_lowercase()).join("\n");
            let short = Language::ALL.map(|language| language.told_shortly(spec.doc).to_lowercase());
            let has = |word: &str| names.iter().any(|name| name.contains(word)) || about.contains(word);
            let rank = match () {
                () if text.is_empty() || names.iter().any(|name| name.starts_with(&text)) => 0,
                () if names.iter().chain(&short).any(|words| begins(words)) => 1,
                () if names.iter().any(|name| name.contains(&text)) => 2,
                () if text.split_whitespace().all(has) => 3,
                () => return None,
            };
            Some((rank, Reverse(uses(spec.op)), spec.op))
        })
        .collect();
    found.sort_unstable();
    found.into_iter().map(|(.., op)| op).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nodes_are_found_by_name_and_description() {
        assert_eq!(matches("blur")[0], "blur");
        assert_eq!(matches("fb")[0], "fbm");
        assert!(matches("hydraulic").contains(&"pipes") && matches("erosion").contains(&"stream-power"));
        // Sense before letters: `hetero` contains these, too.
        let erosion = matches("ero");
        let at = |op: &str| erosion.iter().position(|found| *found == op).unwrap();
        assert!(at("stream-power") == 0 && at("pipes") < at("hetero") && at("droplets") < at("hetero"));
        assert!(matches("")[..2].contains(&"fbm"), "what is used most");
        assert!(matches("no such thing").is_empty());
        assert_eq!((matches("坡度")[0], matches("热风化")[0]), ("slope", "thermal"));
        assert_eq!(matches("").len() + 1, Node::all().len());
    }
}
