//! The graph of the recipe: nodes, groups, wires, and a search for new nodes.

use std::collections::HashMap;
use std::sync::Arc;

use eframe::egui::{
    self, Align2, ColorImage, FontId, Key, PointerButton, Pos2, Rect, Response, Sense, Stroke, StrokeKind,
    TextureHandle, TextureOptions, Ui, UiBuilder, Vec2, pos2, vec2,
};
use orogen::declare::Input;

use super::action::Action;
use super::command::Command;
use super::graph_box::{self, Shown, WIDTH};
use super::graph_route::Reroutes;
use super::graph_search::{Found, OpTextures, Search};
use crate::catalogue::Language;
use crate::editing::adding::After;
use crate::editing::brush::Effect;
use crate::editing::edit::Edit;
use crate::editing::reader::Reader;
use crate::editing::{adding, bypass, drawing, groups, names, strokes};
use crate::preview::picture::Picture;
use crate::studio::Studio;
use crate::view::arrangement::{self, Area};
use crate::view::scene::{GraphBox, Kind, Scene};

/// State of the panel.
pub struct Graph {
    /// The position of the graph's origin in the panel, in points.
    pub(super) offset: Vec2,
    /// The scale of the graph; 1 is normal.
    pub(super) zoom: f32,
    /// The shown group; empty for the whole recipe.
    pub(super) group: String,
    /// The shown scene.
    pub(super) scene: Scene,
    /// Positions of boxes, in points of a graph at normal size. Positions of removed boxes are kept for undo.
    pub(super) places: HashMap<String, Pos2>,
    /// What the scene depends on: the revision, the group, and whether there are pictures.
    pub(super) placed: Option<(u64, String, bool)>,
    /// The search for a new node.
    search: Option<Search>,
    /// The pictures of ops, once the search was open.
    ops: Option<OpTextures>,
    /// The node from which a wire is being drawn.
    wire: Option<String>,
    /// The wire that was chosen, by what reads through it.
    pub(super) chosen: Option<Reader>,
    /// The points of wires.
    pub(super) reroutes: Reroutes,
    /// The corner where the selection rectangle started.
    rectangle: Option<Pos2>,
    /// The small pictures of nodes on the graphics card.
    textures: HashMap<String, (Arc<Picture>, TextureHandle)>,
    pub(super) wants_whole: bool,
    /// The size of the panel for which the whole graph is shown, until the user moves it.
    fitted: Option<Vec2>,
}

/// The height of the row with the path of groups and the button, which cover no box of a graph that is shown whole.
const ROW: f32 = 32.0;

/// The smallest scale at which the user can show a graph, unless the whole graph needs a smaller one.
const SMALLEST: f32 = 0.15;

impl Default for Graph {
    fn default() -> Graph {
        Graph {
            offset: vec2(20.0, 20.0),
            zoom: 1.0,
            group: String::new(),
            scene: Scene::default(),
            places: HashMap::new(),
            placed: None,
            search: None,
            ops: None,
            wire: None,
            chosen: None,
            reroutes: Reroutes::default(),
            rectangle: None,
            textures: HashMap::new(),
            wants_whole: true,
            fitted: None,
        }
    }
}

impl Graph {
    /// Drops the state of the previous document.
    pub fn reset(&mut self) {
        *self = Graph { ops: self.ops.take(), ..Graph::default() };
    }

    /// Opens the search for a new node.
    pub fn open_search(&mut self) {
        self.search = Some(Search::new(self.to_graph(pos2(80.0, 60.0))));
    }

    /// Shows the whole graph.
    pub fn show_whole(&mut self) {
        self.wants_whole = true;
    }

    /// Shows the content of a group; the whole recipe for the empty name.
    pub fn enter(&mut self, group: &str) {
        group.clone_into(&mut self.group);
        self.search = None;
        self.wants_whole = true;
    }

    /// Whether the whole graph is shown, because the user has not moved it.
    pub(super) fn is_whole(&self) -> bool {
        self.fitted.is_some()
    }

    /// Converts a position in the panel to the graph.
    pub(super) fn to_graph(&self, at: Pos2) -> Pos2 {
        ((at - self.offset) / self.zoom).to_vec2().to_pos2()
    }

    /// Shows the panel.
    pub fn show(&mut self, ui: &mut Ui, studio: &Studio, language: Language, actions: &mut Vec<Action>) {
        self.update(studio);
        self.load(ui, studio);
        let (rect, background) = ui.allocate_exact_size(ui.available_size(), Sense::click_and_drag());
        background.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Canvas, true, language.text("spoken.graph")));
        let is_resized = self.fitted.is_some_and(|size| size != rect.size());
        if std::mem::take(&mut self.wants_whole) || is_resized {
            self.fit(studio, rect.size());
            self.fitted = Some(rect.size());
        }
        let origin = rect.min;
        self.navigate(ui, &background, origin);
        let painter = ui.painter_at(rect);
        painter.rect_filled(rect, 0.0, ui.visuals().extreme_bg_color);
        let scene = std::mem::take(&mut self.scene);
        let rects: Vec<Rect> = scene.boxes.iter().map(|block| self.rect_of(block, studio, origin)).collect();
        self.show_frames(ui, &painter, (&scene, &rects), (studio, language), actions);
        let routes = self.routes(&scene, &rects, studio);
        self.draw_wires(ui, &painter, &scene, &routes, studio);
        for (block, own) in scene.boxes.iter().zip(&rects) {
            self.show_box(ui, &painter, block, *own, (rect, studio, language), &scene, actions);
        }
        let is_on_wire = self.show_reroutes(ui, (&painter, &background), &routes, (studio, language), actions);
        self.finish_wire(ui, &painter, &scene, &rects, actions);
        self.select(ui, &painter, &background, &scene, &rects, studio, actions);
        self.scene = scene;
        let pointer = background.interact_pointer_pos();
        if is_on_wire {
            self.search = None;
        } else if background.double_clicked() || background.secondary_clicked() {
            let at = self.to_graph(pointer.unwrap_or(rect.center()) - origin.to_vec2());
            self.search = Some(Search::new(at));
        } else if background.clicked() {
            actions.push(Action::Select(Vec::new()));
            self.search = None;
        }
        let is_over = ui.rect_contains_pointer(rect) && ui.ctx().memory(|memory| memory.focused().is_none());
        let is_delete = ui.input(|input| input.key_pressed(Key::Delete) || input.key_pressed(Key::Backspace));
        if is_over && is_delete && !self.remove_point(studio, actions) && !self.cut_wire(studio, actions) {
            actions.push(Action::Command(Command::Delete));
        }
        self.find(ui, rect, studio, language, actions);
        let tidy_rect = Rect::from_min_size(rect.right_top() + vec2(-70.0, 6.0), vec2(64.0, 20.0));
        if ui.put(tidy_rect, egui::Button::new(language.text("graph.tidy")).small()).clicked() {
            self.tidy(studio.has_thumbnails);
            self.wants_whole = true;
        }
        self.crumbs(ui, rect, language);
        if !studio.document.is_valid() {
            let (place, color) = (rect.left_bottom() + vec2(8.0, -6.0), ui.visuals().error_fg_color);
            let text = language.text("graph.invalid");
            painter.text(place, Align2::LEFT_BOTTOM, text, FontId::proportional(12.0), color);
        }
    }

    /// The path of groups that leads to the shown one.
    fn crumbs(&mut self, ui: &mut Ui, rect: Rect, language: Language) {
        if self.group.is_empty() {
            return;
        }
        let place = Rect::from_min_size(rect.min + vec2(8.0, 6.0), vec2(rect.width() - 90.0, 22.0));
        let mut chosen = None;
        ui.scope_builder(UiBuilder::new().max_rect(place), |ui| {
            ui.horizontal(|ui| {
                if ui.button(language.text("graph.recipe")).clicked() {
                    chosen = Some(String::new());
                }
                let ends = self.group.match_indices('/').map(|(at, _)| at).chain([self.group.len()]);
                for end in ends {
                    let group = &self.group[..end];
                    ui.label("›");
                    let crumb = ui.selectable_label(group == self.group, groups::own_name(group));
                    if crumb.clicked() {
                        chosen = Some(group.to_owned());
                    }
                }
            });
        });
        if let Some(group) = chosen.filter(|group| *group != self.group) {
            self.enter(&group);
        }
    }

    fn rect_of(&self, block: &GraphBox, studio: &Studio, origin: Pos2) -> Rect {
        let place = self.place_of(block).unwrap_or_default();
        let size = graph_box::size(block, studio.has_thumbnails);
        Rect::from_min_size(origin + self.offset + place.to_vec2() * self.zoom, size * self.zoom)
    }

    /// Uploads new small pictures to the graphics card.
    fn load(&mut self, ui: &Ui, studio: &Studio) {
        let nodes = self.scene.boxes.iter().filter_map(|block| block.outlets.first().or(block.nodes.first()));
        let mut textures = std::mem::take(&mut self.textures);
        for node in nodes {
            match studio.thumbnails.of(node).filter(|_| studio.has_thumbnails) {
                None => drop(textures.remove(node)),
                Some(picture) => {
                    if textures.get(node).is_none_or(|(known, _)| !Arc::ptr_eq(known, picture)) {
                        let image = ColorImage::from_rgba_unmultiplied(picture.size, &picture.pixels);
                        let texture = ui.ctx().load_texture(format!("node {node}"), image, TextureOptions::LINEAR);
                        textures.insert(node.clone(), (Arc::clone(picture), texture));
                    }
                }
            }
        }
        // Pictures of nodes that are gone would stay on the graphics card.
        textures.retain(|node, _| studio.thumbnails.of(node).is_some());
        self.textures = textures;
    }

    fn fit(&mut self, studio: &Studio, size: Vec2) {
        // The boxes and the points of wires at normal size.
        let shown = (self.offset, self.zoom);
        (self.offset, self.zoom) = (Vec2::ZERO, 1.0);
        let rects: Vec<Rect> = self.scene.boxes.iter().map(|block| self.rect_of(block, studio, Pos2::ZERO)).collect();
        let points = self.routes(&self.scene, &rects, studio).into_iter().flat_map(|route| route.points);
        let bounds = points.fold(Rect::NOTHING, |all, point| all.union(Rect::from_pos(point)));
        let bounds = rects.iter().fold(bounds, |all, rect| all.union(*rect));
        (self.offset, self.zoom) = shown;
        if bounds.is_finite() && bounds.width() > 0.0 {
            let room = (size - vec2(32.0, ROW + 16.0)).max(Vec2::splat(40.0));
            self.zoom = (room.x / bounds.width()).min(room.y / bounds.height()).min(1.0);
            self.offset = (size + vec2(0.0, ROW)) / 2.0 - bounds.center().to_vec2() * self.zoom;
        }
    }

    fn navigate(&mut self, ui: &Ui, background: &Response, origin: Pos2) {
        if background.dragged_by(PointerButton::Middle) || background.dragged_by(PointerButton::Secondary) {
            self.offset += background.drag_delta();
            self.fitted = None;
        }
        if background.contains_pointer()
            && let Some(pointer) = ui.input(|input| input.pointer.hover_pos())
        {
            let (scroll, pinch) = ui.input(|input| (input.smooth_scroll_delta().y, input.zoom_delta()));
            let factor = pinch * libm::expf(scroll * 0.003);
            if (factor - 1.0).abs() > 1e-4 {
                let fixed = pointer - origin;
                let zoom = (self.zoom * factor).clamp(SMALLEST.min(self.zoom), 2.5);
                self.offset = fixed - (fixed - self.offset) * (zoom / self.zoom);
                self.zoom = zoom;
                self.fitted = None;
            }
        }
    }

    /// Selects the boxes in a rectangle that is dragged over the background.
    #[allow(clippy::too_many_arguments, reason = "all of it is of this one frame")]
    fn select(
        &mut self,
        ui: &Ui,
        painter: &egui::Painter,
        background: &Response,
        scene: &Scene,
        rects: &[Rect],
        studio: &Studio,
        actions: &mut Vec<Action>,
    ) {
        if background.drag_started_by(PointerButton::Primary) {
            self.rectangle = ui.input(|input| input.pointer.press_origin());
        }
        let (Some(begun), Some(pointer)) = (self.rectangle, ui.input(|input| input.pointer.latest_pos())) else {
            return;
        };
        let area = Rect::from_two_pos(begun, pointer);
        let color = ui.visuals().selection.bg_fill;
        painter.rect_filled(area, 0.0, color.gamma_multiply(0.25));
        painter.rect_stroke(area, 0.0, Stroke::new(1.0, color), StrokeKind::Inside);
        if !ui.input(|input| input.pointer.any_released()) {
            return;
        }
        self.rectangle = None;
        let adds = ui.input(|input| input.modifiers.command || input.modifiers.shift);
        let mut selected = if adds { studio.selected.clone() } else { Vec::new() };
        for (block, rect) in scene.boxes.iter().zip(rects) {
            if block.kind != Kind::Outside && area.intersects(*rect) {
                selected.extend(block.nodes.iter().filter(|name| !studio.selected.contains(name) || !adds).cloned());
            }
        }
        actions.push(Action::Select(selected));
    }

    #[allow(clippy::too_many_arguments, reason = "all of it is of this one frame")]
    fn show_box(
        &mut self,
        ui: &Ui,
        painter: &egui::Painter,
        block: &GraphBox,
        rect: Rect,
        (clip, studio, language): (Rect, &Studio, Language),
        scene: &Scene,
        actions: &mut Vec<Action>,
    ) {
        let id = ui.scope_id().with(("node", &block.id));
        let response = ui.interact(rect.intersect(clip), id, Sense::click_and_drag());
        let label = match block.kind {
            Kind::Node(_) => language.fill("spoken.node", &[("name", &block.id)]),
            Kind::Group => language.fill("spoken.group", &[("name", block.id.trim_end_matches('/'))]),
            Kind::Outside => language.fill("spoken.outside", &[("name", &block.title)]),
            Kind::Output => language.fill("spoken.output", &[("name", &block.title)]),
        };
        response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Button, true, label.clone()));
        let is_own = !matches!(block.kind, Kind::Outside | Kind::Output);
        let is_selected = is_own && block.nodes.iter().all(|name| studio.selected.contains(name));
        if response.dragged_by(PointerButton::Primary) {
            let moved = |other: &&GraphBox| {
                other.id == block.id
                    || is_selected
                        && !matches!(other.kind, Kind::Outside | Kind::Output)
                        && other.nodes.iter().all(|name| studio.selected.contains(name))
            };
            self.drag(scene.boxes.iter().filter(moved), response.drag_delta());
        }
        self.click(ui, &response, block, is_selected, studio, actions);
        // Names that are too long or too small for the box.
        let response = response.on_hover_text(&block.title);
        if is_own {
            response.context_menu(|ui| self.menu(ui, block, (studio, language), actions));
        }
        let shown = Shown {
            language,
            is_bypassed: matches!(block.kind, Kind::Node(_))
                && studio
                    .document
                    .recipe()
                    .nodes()
                    .iter()
                    .any(|named| named.name == block.id && bypass::is_bypassed(named)),
            is_locked: block.nodes.iter().any(|name| studio.document.kept().locked.contains(name)),
            is_selected,
            is_in_view: block.nodes.contains(&studio.look.layer)
                || block.kind == Kind::Output && block.title == studio.look.layer,
            picture: block
                .outlets
                .first()
                .filter(|_| block.kind != Kind::Outside && studio.has_thumbnails)
                .and_then(|node| self.textures.get(node))
                .map(|(_, texture)| texture),
            zoom: self.zoom,
        };
        graph_box::draw(painter, ui.visuals(), block, rect, &shown);
        for (k, name) in block.outlets.iter().enumerate() {
            let out = graph_box::at(rect, graph_box::outlet(block, k), self.zoom, true);
            let grip = Rect::from_center_size(out, Vec2::splat(15.0 * self.zoom.max(0.5))).intersect(clip);
            let grip = ui.interact(grip, ui.scope_id().with(("out", &block.id, name)), Sense::drag());
            let spoken = language.fill("spoken.layer", &[("name", name)]);
            grip.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Canvas, true, spoken.clone()));
            if grip.drag_started() {
                self.wire = Some(name.clone());
            }
        }
    }

    /// Moves boxes.
    pub(super) fn drag<'a>(&mut self, boxes: impl Iterator<Item = &'a GraphBox>, by: Vec2) {
        self.fitted = None;
        for key in boxes.map(|block| self.key(block)).collect::<Vec<_>>() {
            if let Some(place) = self.places.get_mut(&key) {
                *place += by / self.zoom;
            }
        }
    }

    /// Selects, shows or opens a box that is clicked.
    fn click(
        &mut self,
        ui: &Ui,
        response: &Response,
        block: &GraphBox,
        is_selected: bool,
        studio: &Studio,
        actions: &mut Vec<Action>,
    ) {
        if block.kind == Kind::Outside {
            if response.clicked() || response.double_clicked() {
                // Shows its own group, with the node selected.
                self.enter(block.nodes.first().map_or("", |name| groups::group_of(name)));
                actions.push(Action::Select(block.nodes.clone()));
            }
            return;
        }
        if block.kind == Kind::Output {
            if response.clicked() || response.double_clicked() {
                actions.push(Action::Show(block.title.clone()));
            }
            return;
        }
        let adds = ui.input(|input| input.modifiers.command || input.modifiers.shift);
        let is_dragged = response.drag_started_by(PointerButton::Primary);
        let is_menu = response.secondary_clicked();
        if response.clicked() || ((is_dragged || is_menu) && !is_selected) {
            let others = studio.selected.iter().filter(|name| adds && !block.nodes.contains(name)).cloned();
            let own = block.nodes.iter().filter(|_| !(adds && is_selected)).cloned();
            actions.push(Action::Select(own.chain(others).collect()));
        }
        if response.double_clicked() {
            match block.group_name() {
                Some(group) => self.enter(group),
                None => actions.extend(block.nodes.first().map(|name| Action::Show(name.clone()))),
            }
        }
    }

    /// Draws the wire that is being dragged, and connects it where it ends.
    fn finish_wire(
        &mut self,
        ui: &Ui,
        painter: &egui::Painter,
        scene: &Scene,
        rects: &[Rect],
        actions: &mut Vec<Action>,
    ) {
        let Some(source) = self.wire.clone() else { return };
        let Some(pointer) = ui.input(|input| input.pointer.latest_pos()) else { return };
        let all = || scene.boxes.iter().zip(rects);
        if let Some((block, rect)) = all().find(|(block, _)| block.outlets.contains(&source)) {
            let k = block.outlets.iter().position(|name| *name == source).unwrap_or_default();
            let start = graph_box::at(*rect, graph_box::outlet(block, k), self.zoom, true);
            self.draw_wire(painter, start, pointer, true, ui.visuals().selection.bg_fill);
        }
        if !ui.input(|input| input.pointer.any_released()) {
            return;
        }
        self.wire = None;
        let under = all().find(|(_, rect)| rect.expand(8.0 * self.zoom).contains(pointer));
        let Some((block, rect)) = under.filter(|(block, _)| !block.outlets.contains(&source)) else { return };
        if block.kind == Kind::Output {
            let name = block.title.clone();
            actions.push(Action::Edit(Edit::Output { name, source: Input::Node(source) }));
            return;
        }
        // On the title, the first input is used; a node without inputs has a mask.
        let near = graph_box::port_near(block, (pointer.y - rect.top()) / self.zoom).and_then(|k| block.ports.get(k));
        let (node, input) = match (near, block.kind) {
            (Some(port), _) => (port.node.clone(), port.key.clone()),
            (None, Kind::Node(_)) => (block.id.clone(), "mask".to_owned()),
            (None, _) => return,
        };
        actions.push(Action::Edit(Edit::Connect { node, input, source: Input::Node(source) }));
    }

    /// The search for a new node, and its result.
    fn find(&mut self, ui: &Ui, rect: Rect, studio: &Studio, language: Language, actions: &mut Vec<Action>) {
        let Some(mut search) = self.search.take() else { return };
        let place = rect.min + self.offset + search.at.to_vec2() * self.zoom;
        let ops = self.ops.get_or_insert_with(|| OpTextures::new(ui.ctx()));
        ops.update(&studio.session());
        let op = match search.show(ui, (rect, place), ops, language) {
            Found::Nothing => {
                self.search = Some(search);
                return;
            }
            Found::Closed => return,
            Found::Op(op) => op,
        };
        if drawing::OPS.contains(&op) {
            // A drawing needs points.
            actions.push(Action::Draw(op));
            return;
        }
        let recipe = studio.document.recipe();
        let taken = recipe.nodes().iter().filter_map(|named| groups::rest(&named.name, &self.group)).collect();
        let name = groups::within(&self.group, &names::free(&names::of_op(op), &taken));
        let range = studio.frame.as_ref().map(|frame| frame.range());
        let after = match (&self.chosen, studio.selected.first()) {
            (Some(reader), _) => After::Wire(reader),
            (None, Some(selected)) => After::Node(selected),
            (None, None) => After::Nothing,
        };
        let edit = adding::edit(recipe, name.clone(), op, after, range);
        let has_input = matches!(&edit, Edit::Add { inputs, .. } if !inputs.is_empty());
        if !has_input {
            // A free position near the pointer.
            let size = |block: &GraphBox| graph_box::size(block, studio.has_thumbnails).into();
            let boxes = self.scene.boxes.iter();
            let taken: Vec<Area> =
                boxes.filter_map(|block| Some((self.place_of(block)?.into(), size(block)))).collect();
            let free = arrangement::free(search.at.into(), [WIDTH, 120.0], &taken);
            self.places.insert(name, free.into());
        }
        if op == strokes::OP {
            // With an input it changes heights; without one it is a mask.
            actions.push(Action::Brush(if has_input { Effect::Raise } else { Effect::Paint }));
        }
        actions.push(Action::Edit(edit));
    }
}
