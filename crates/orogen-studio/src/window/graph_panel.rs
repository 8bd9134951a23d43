//! The graph of the recipe: nodes, wires, and a search for new nodes.

use std::collections::HashMap;

use eframe::egui::{
    self, Align2, Color32, FontId, Key, Pos2, Rect, Sense, Stroke, StrokeKind, TextEdit, Ui, Vec2, pos2, vec2,
};
use orogen::declare::Input;
use orogen::declare::spec::Locality;
use orogen::node::Node;
use orogen::recipe::document::NamedNode;

use super::action::Action;
use super::command::Command;
use crate::catalogue::Language;
use crate::editing::brush::Effect;
use crate::editing::edit::Edit;
use crate::editing::{drawing, names, strokes};
use crate::studio::Studio;
use crate::view::graph_layout::{tidy, wires};

/// State of the panel.
#[derive(Debug)]
pub struct Graph {
    /// Where the origin of the graph is in the panel, in points.
    offset: Vec2,
    /// Size of the graph; 1 is normal.
    zoom: f32,
    /// Places of nodes, in points of a graph of normal size.
    places: HashMap<String, Pos2>,
    /// The revision that the places are of.
    placed: Option<u64>,
    /// The search for a new node, and where the node is to be.
    search: Option<Search>,
    /// The node and layer from which a wire is being drawn.
    wire: Option<String>,
    wants_whole: bool,
}

#[derive(Debug, Default)]
struct Search {
    text: String,
    at: Pos2,
    is_new: bool,
}

/// The size at which names can still be read.
const LEGIBLE: f32 = 0.62;

const WIDTH: f32 = 132.0;
const TITLE: f32 = 34.0;
const ROW: f32 = 15.0;
const GAP: Vec2 = vec2(62.0, 22.0);

impl Default for Graph {
    fn default() -> Graph {
        Graph {
            offset: vec2(20.0, 20.0),
            zoom: 1.0,
            places: HashMap::new(),
            placed: None,
            search: None,
            wire: None,
            wants_whole: true,
        }
    }
}

/// The height of a node of normal size.
fn height(named: &NamedNode) -> f32 {
    TITLE + ROW * named.node.inputs().len().max(1) as f32 + 6.0
}

/// The color of a kind of nodes.
fn color(locality: Locality) -> Color32 {
    match locality {
        Locality::Field => Color32::from_rgb(74, 120, 176),
        Locality::Filter => Color32::from_rgb(84, 140, 92),
        Locality::Levelled => Color32::from_rgb(150, 96, 150),
        Locality::Solver => Color32::from_rgb(186, 112, 62),
    }
}

impl Graph {
    /// Opens the search for a new node.
    pub fn open_search(&mut self) {
        let middle = self.to_graph(self.offset.to_pos2() + vec2(80.0, 60.0));
        self.search = Some(Search { at: middle, is_new: true, ..Search::default() });
    }

    /// Shows the graph as a whole.
    pub fn show_whole(&mut self) {
        self.wants_whole = true;
    }

    fn to_graph(&self, at: Pos2) -> Pos2 {
        ((at - self.offset) / self.zoom).to_vec2().to_pos2()
    }

    /// Places new nodes, and forgets those that are gone.
    fn place(&mut self, studio: &Studio) {
        if self.placed == Some(studio.document.revision()) {
            return;
        }
        self.placed = Some(studio.document.revision());
        let recipe = studio.document.recipe();
        let nodes = recipe.nodes();
        let is_new = self.places.is_empty()
            || nodes.iter().filter(|named| self.places.contains_key(&named.name)).count() < nodes.len() / 2;
        if is_new {
            self.tidy(studio);
            self.wants_whole = true;
            return;
        }
        self.places.retain(|name, _| nodes.iter().any(|named| named.name == *name));
        for (at, named) in nodes.iter().enumerate() {
            if self.places.contains_key(&named.name) {
                continue;
            }
            // Beside what it reads, or where the search was.
            let sources: Vec<Pos2> =
                wires(recipe, at).iter().filter_map(|(_, source)| self.places.get(source).copied()).collect();
            let right = sources.iter().map(|place| place.x).fold(f32::NEG_INFINITY, f32::max);
            let mut place = match sources.first() {
                Some(first) => pos2(right + WIDTH + GAP.x, first.y),
                None => self.to_graph(pos2(60.0, 60.0)),
            };
            while self
                .places
                .values()
                .any(|other| (other.x - place.x).abs() < WIDTH && (other.y - place.y).abs() < 60.0)
            {
                place.y += 84.0;
            }
            self.places.insert(named.name.clone(), place);
        }
    }

    /// Places all nodes in a tidy layout.
    pub fn tidy(&mut self, studio: &Studio) {
        let recipe = studio.document.recipe();
        let tallest = recipe.nodes().iter().map(height).fold(60.0, f32::max);
        let row = tallest.min(96.0) + GAP.y;
        self.places = recipe
            .nodes()
            .iter()
            .zip(tidy(recipe))
            .map(|(named, place)| (named.name.clone(), pos2(place.column as f32 * (WIDTH + GAP.x), place.row * row)))
            .collect();
        // Tall nodes push those below them down.
        let mut order: Vec<(&NamedNode, Pos2)> =
            recipe.nodes().iter().filter_map(|named| Some((named, *self.places.get(&named.name)?))).collect();
        order.sort_by(|a, b| a.1.x.total_cmp(&b.1.x).then(a.1.y.total_cmp(&b.1.y)));
        let mut below: HashMap<i64, f32> = HashMap::new();
        for (named, place) in order {
            let next = below.entry(place.x as i64).or_insert(f32::NEG_INFINITY);
            let y = place.y.max(*next);
            *next = y + height(named) + GAP.y * 0.5;
            self.places.insert(named.name.clone(), pos2(place.x, y));
        }
    }

    /// Shows the panel.
    pub fn show(&mut self, ui: &mut Ui, studio: &Studio, language: Language, actions: &mut Vec<Action>) {
        self.place(studio);
        let (rect, background) = ui.allocate_exact_size(ui.available_size(), Sense::click_and_drag());
        if std::mem::take(&mut self.wants_whole) {
            self.fit(studio, rect.size());
        }
        let origin = rect.min;
        self.navigate(ui, &background, origin);
        let painter = ui.painter_at(rect);
        painter.rect_filled(rect, 0.0, ui.visuals().extreme_bg_color);
        let nodes = studio.document.recipe().nodes();
        let screen = |place: Pos2, graph: &Graph| origin + graph.offset + place.to_vec2() * graph.zoom;
        let rects: HashMap<&str, Rect> = nodes
            .iter()
            .filter_map(|named| {
                let place = screen(*self.places.get(&named.name)?, self);
                Some((named.name.as_str(), Rect::from_min_size(place, vec2(WIDTH, height(named)) * self.zoom)))
            })
            .collect();
        for (at, named) in nodes.iter().enumerate() {
            for (k, (key, source)) in wires(studio.document.recipe(), at).iter().enumerate() {
                if let (Some(from), Some(to)) = (rects.get(source.as_str()), rects.get(named.name.as_str())) {
                    let is_mask = key == "mask";
                    let end = if is_mask { pos2(to.center().x, to.top()) } else { self.port(*to, k) };
                    let is_own = studio.selected.iter().any(|name| *name == named.name || name == source);
                    self.draw_wire(&painter, self.out(*from), end, is_own, ui.visuals().weak_text_color());
                }
            }
        }
        for named in nodes {
            if let Some(own) = rects.get(named.name.as_str()) {
                self.node(ui, &painter, named, *own, (rect, studio), actions);
            }
        }
        self.finish_wire(ui, &painter, nodes, &rects, actions);
        let pointer = background.interact_pointer_pos();
        if background.double_clicked() || background.secondary_clicked() {
            let at = self.to_graph(pointer.unwrap_or(rect.center()) - origin.to_vec2());
            self.search = Some(Search { at, is_new: true, ..Search::default() });
        } else if background.clicked() {
            actions.push(Action::Select(Vec::new()));
            self.search = None;
        }
        if background.hovered() && ui.input(|input| input.key_pressed(Key::Delete) || input.key_pressed(Key::Backspace))
        {
            actions.push(Action::Command(Command::Delete));
        }
        self.search_window(ui, rect, studio, language, actions);
        let tidy_rect = Rect::from_min_size(rect.right_top() + vec2(-70.0, 6.0), vec2(64.0, 20.0));
        if ui.put(tidy_rect, egui::Button::new(language.text("graph.tidy")).small()).clicked() {
            self.tidy(studio);
            self.wants_whole = true;
        }
        if !studio.document.is_valid() {
            let color = ui.visuals().error_fg_color;
            painter.text(
                rect.left_top() + vec2(8.0, 6.0),
                Align2::LEFT_TOP,
                language.text("graph.invalid"),
                FontId::proportional(12.0),
                color,
            );
        }
    }

    fn fit(&mut self, studio: &Studio, size: Vec2) {
        let mut bounds = Rect::NOTHING;
        for named in studio.document.recipe().nodes() {
            if let Some(place) = self.places.get(&named.name) {
                bounds = bounds.union(Rect::from_min_size(*place, vec2(WIDTH, height(named))));
            }
        }
        if bounds.is_finite() && bounds.width() > 0.0 {
            let room = (size - Vec2::splat(32.0)).max(Vec2::splat(40.0));
            self.zoom = (room.x / bounds.width()).min(room.y / bounds.height()).clamp(LEGIBLE, 1.0);
            self.offset = size / 2.0 - bounds.center().to_vec2() * self.zoom;
            // Of what does not fit the end is shown, which is what the outputs read.
            if bounds.width() * self.zoom > room.x {
                self.offset.x = size.x - 16.0 - bounds.right() * self.zoom;
            }
        }
    }

    fn navigate(&mut self, ui: &Ui, background: &egui::Response, origin: Pos2) {
        if background.dragged() {
            self.offset += background.drag_delta();
        }
        if background.contains_pointer()
            && let Some(pointer) = ui.input(|input| input.pointer.hover_pos())
        {
            let (scroll, pinch) = ui.input(|input| (input.smooth_scroll_delta().y, input.zoom_delta()));
            let factor = pinch * libm::expf(scroll * 0.003);
            if (factor - 1.0).abs() > 1e-4 {
                let fixed = pointer - origin;
                let zoom = (self.zoom * factor).clamp(0.15, 2.5);
                self.offset = fixed - (fixed - self.offset) * (zoom / self.zoom);
                self.zoom = zoom;
            }
        }
    }

    /// The place of an input of a node.
    fn port(&self, rect: Rect, k: usize) -> Pos2 {
        pos2(rect.left(), rect.top() + (TITLE + ROW * (k as f32 + 0.5)) * self.zoom)
    }

    /// The place of the output of a node.
    fn out(&self, rect: Rect) -> Pos2 {
        pos2(rect.right(), rect.top() + TITLE * 0.5 * self.zoom)
    }

    fn draw_wire(&self, painter: &egui::Painter, from: Pos2, to: Pos2, is_strong: bool, color: Color32) {
        let bend = ((to.x - from.x).abs() * 0.5).clamp(20.0 * self.zoom, 120.0);
        let stroke =
            Stroke::new(if is_strong { 2.2 } else { 1.3 }, if is_strong { color.gamma_multiply(1.6) } else { color });
        let points = [from, from + vec2(bend, 0.0), to - vec2(bend, 0.0), to];
        painter.add(egui::epaint::CubicBezierShape::from_points_stroke(points, false, Color32::TRANSPARENT, stroke));
    }

    fn node(
        &mut self,
        ui: &Ui,
        painter: &egui::Painter,
        named: &NamedNode,
        rect: Rect,
        (clip, studio): (Rect, &Studio),
        actions: &mut Vec<Action>,
    ) {
        let name = &named.name;
        let spec = named.node.spec();
        let response = ui.interact(rect.intersect(clip), ui.scope_id().with(("node", name)), Sense::click_and_drag());
        response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Button, true, format!("node {name}")));
        if response.dragged()
            && let Some(place) = self.places.get_mut(name)
        {
            *place += response.drag_delta() / self.zoom;
        }
        if response.clicked() || response.drag_started() {
            let add = ui.input(|input| input.modifiers.command || input.modifiers.shift);
            let mut selected = if add { studio.selected.clone() } else { Vec::new() };
            if !selected.contains(name) {
                selected.insert(0, name.clone());
            }
            actions.push(Action::Select(selected));
        }
        if response.double_clicked() {
            actions.push(Action::Show(name.clone()));
        }
        let is_selected = studio.selected.contains(name);
        let visuals = ui.visuals();
        let round = 5.0 * self.zoom;
        painter.rect_filled(rect, round, visuals.window_fill);
        let title = Rect::from_min_max(rect.min, pos2(rect.right(), rect.top() + TITLE * self.zoom));
        painter.rect_filled(title, round, color(spec.locality));
        let border = if is_selected {
            Stroke::new(2.5, visuals.selection.stroke.color)
        } else {
            Stroke::new(1.0, visuals.window_stroke.color)
        };
        painter.rect_stroke(rect, round, border, StrokeKind::Outside);
        if studio.look.layer == *name {
            painter.circle_filled(
                title.right_top() + vec2(-10.0, 10.0) * self.zoom,
                4.0 * self.zoom,
                Color32::from_rgb(255, 214, 90),
            );
        }
        if self.zoom > 0.32 {
            let inside = painter.with_clip_rect(rect.intersect(clip));
            inside.text(
                title.left_top() + vec2(7.0, 4.0) * self.zoom,
                Align2::LEFT_TOP,
                name,
                FontId::proportional(13.0 * self.zoom),
                Color32::WHITE,
            );
            inside.text(
                title.left_top() + vec2(7.0, 19.0) * self.zoom,
                Align2::LEFT_TOP,
                spec.op,
                FontId::proportional(10.5 * self.zoom),
                Color32::from_white_alpha(190),
            );
            for (k, input) in named.node.inputs().iter().enumerate() {
                let shown = match named.node.input(k) {
                    Input::Value(value) => format!("{} = {}", input.name, orogen::words::number(*value)),
                    _ => input.name.to_owned(),
                };
                let place = self.port(rect, k) + vec2(8.0 * self.zoom, 0.0);
                inside.text(
                    place,
                    Align2::LEFT_CENTER,
                    shown,
                    FontId::proportional(10.5 * self.zoom),
                    visuals.text_color(),
                );
            }
        }
        for k in 0..named.node.inputs().len() {
            painter.circle_filled(self.port(rect, k), 3.5 * self.zoom, visuals.weak_text_color());
        }
        let out = self.out(rect);
        painter.circle_filled(out, 5.0 * self.zoom, visuals.strong_text_color());
        let grip = Rect::from_center_size(out, Vec2::splat(16.0 * self.zoom.max(0.5))).intersect(clip);
        let grip = ui.interact(grip, ui.scope_id().with(("out", name)), Sense::drag());
        grip.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Canvas, true, format!("output {name}")));
        if grip.drag_started() {
            self.wire = Some(name.clone());
        }
    }

    /// Draws the wire that is being drawn, and connects it where it ends.
    fn finish_wire(
        &mut self,
        ui: &Ui,
        painter: &egui::Painter,
        nodes: &[NamedNode],
        rects: &HashMap<&str, Rect>,
        actions: &mut Vec<Action>,
    ) {
        let Some(source) = self.wire.clone() else { return };
        let Some(pointer) = ui.input(|input| input.pointer.latest_pos()) else { return };
        if let Some(from) = rects.get(source.as_str()) {
            self.draw_wire(painter, self.out(*from), pointer, true, ui.visuals().selection.bg_fill);
        }
        if !ui.input(|input| input.pointer.any_released()) {
            return;
        }
        self.wire = None;
        let under = nodes.iter().find(|named| {
            rects.get(named.name.as_str()).is_some_and(|rect| rect.expand(8.0 * self.zoom).contains(pointer))
        });
        let Some(named) = under.filter(|named| named.name != source) else { return };
        let Some(rect) = rects.get(named.name.as_str()) else { return };
        let inputs = named.node.inputs();
        let row = ((pointer.y - rect.top()) / self.zoom - TITLE) / ROW;
        // On the title it is the first input, below the last one the mask.
        let input = match (row.max(0.0) as usize, inputs.len()) {
            (_, 0) => "mask".to_owned(),
            (k, count) => inputs[k.min(count - 1)].name.to_owned(),
        };
        actions.push(Action::Edit(Edit::Connect { node: named.name.clone(), input, source: Input::Node(source) }));
    }

    fn search_window(&mut self, ui: &Ui, rect: Rect, studio: &Studio, language: Language, actions: &mut Vec<Action>) {
        let Some(search) = &mut self.search else { return };
        let mut chosen = None;
        let mut is_open = true;
        let place = rect.min + self.offset + search.at.to_vec2() * self.zoom;
        let place = place.clamp(rect.min, (rect.max - vec2(260.0, 120.0)).max(rect.min));
        egui::Window::new(language.text("graph.add"))
            .open(&mut is_open)
            .fixed_pos(place)
            .fixed_size(vec2(250.0, 260.0))
            .collapsible(false)
            .show(ui.ctx(), |ui| {
                let field = ui.add(TextEdit::singleline(&mut search.text).hint_text(language.text("graph.search")));
                if std::mem::take(&mut search.is_new) {
                    field.request_focus();
                }
                let found = matches(&search.text);
                if field.lost_focus() && ui.input(|input| input.key_pressed(Key::Enter)) {
                    chosen = found.first().copied();
                }
                egui::ScrollArea::vertical().max_height(220.0).show(ui, |ui| {
                    for op in found {
                        let Some(node) = Node::named(op) else { continue };
                        let about = orogen::declare::short(node.spec().doc);
                        if ui.selectable_label(false, op).on_hover_text(about).clicked() {
                            chosen = Some(op);
                        }
                    }
                });
            });
        if ui.input(|input| input.key_pressed(Key::Escape)) || !is_open {
            self.search = None;
            return;
        }
        if let Some(op) = chosen {
            let at = search.at;
            self.search = None;
            let recipe = studio.document.recipe();
            let taken = recipe.nodes().iter().map(|named| named.name.as_str()).collect();
            let name = names::free(&names::of_op(op), &taken);
            // The selected node is what it reads.
            let inputs = studio.selected.first().and_then(|selected| {
                let node = Node::named(op)?;
                let first = node.spec().inputs.first().map(|input| input.name);
                let first = first.or(node.spec().named_inputs.then_some("a"))?;
                Some((first.to_owned(), selected.clone()))
            });
            if inputs.is_none() {
                self.places.insert(name.clone(), at);
            }
            if drawing::OPS.contains(&op) {
                // It is nothing without points.
                actions.push(Action::Draw(op));
                return;
            }
            if op == strokes::OP {
                // Over something it changes heights; alone it is a mask.
                actions.push(Action::Brush(if inputs.is_some() { Effect::Raise } else { Effect::Paint }));
            }
            let inputs = inputs.into_iter().collect();
            actions.push(Action::Edit(Edit::Add { name, op: op.to_owned(), inputs, params: Vec::new() }));
        }
    }
}

/// The ops whose name or description has all words of a text, those whose name begins with it first.
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
