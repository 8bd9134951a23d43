//! The map: pan and zoom, values under the pointer, a profile along a line.

use std::sync::Arc;

use eframe::egui::{
    self, Align2, Color32, ColorImage, FontId, Key, PointerButton, Rect, Sense, Stroke, TextureHandle, TextureOptions,
    Ui, UiBuilder, Vec2, pos2,
};

use super::action::Action;
use super::contour_lines::ContourLines;
use super::label::label;
use super::map_brush::{self, MapBrush};
use super::relief_panel::{contours, readout};
use super::{legend, tool_row};
use crate::catalogue::Language;
use crate::editing::brush::Effect;
use crate::editing::edit::Edit;
use crate::editing::{drawing, names};
use crate::preview::frame::{self, Frame};
use crate::preview::region::Region;
use crate::studio::Studio;
use crate::view::map_view::MapView;

/// State of the map.
#[derive(Default)]
pub struct MapPanel {
    view: Option<MapView>,
    /// The picture, and the identity of its frame.
    texture: Option<(TextureHandle, frame::Key)>,
    /// The ends of the profile, in metres.
    profile: Option<[[f64; 2]; 2]>,
    tool: Tool,
    brush: MapBrush,
    /// The points of the current drawing.
    drawn: Vec<[f64; 2]>,
    /// The last requested region.
    asked: Option<Region>,
    /// The picture that later ones are compared with.
    kept: Option<Kept>,
    contours: ContourLines,
    /// Whether a menu or list was open in the previous frame.
    had_popup: bool,
}

/// A picture that is kept for a comparison.
struct Kept {
    texture: TextureHandle,
    /// Its west, north, east and south sides in metres.
    sides: [f64; 4],
    /// The text of its recipe.
    text: String,
    /// The share of the view in which it is shown, from the left.
    share: f32,
    /// Whether both pictures are shown completely, side by side.
    is_beside: bool,
}

/// The action of a drag or a click on the map.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
enum Tool {
    /// Moves the map.
    #[default]
    Pan,
    /// Draws the line of a profile.
    Profile,
    /// Draws a line or an area, by its op.
    Draw(&'static str),
    /// Paints with a brush.
    Brush(Effect),
}

impl Tool {
    /// The catalog key of its help.
    fn help(self) -> &'static str {
        match self {
            Tool::Pan => "map.pan_help",
            Tool::Profile => "map.profile_help",
            Tool::Draw(_) => "map.draw_help",
            Tool::Brush(effect) => map_brush::names(effect)[1],
        }
    }
}

/// Height of the row with the settings of a tool, in points.
const ROW: f32 = 24.0;

/// Maximum side of a picture.
const LARGEST: usize = 4096;

impl MapPanel {
    /// Shows the whole map.
    pub fn show_whole(&mut self) {
        self.view = None;
    }

    /// Shows the map.
    pub fn show(&mut self, ui: &mut Ui, studio: &Studio, language: Language, actions: &mut Vec<Action>) {
        // A click that closes a menu is not meant for the map.
        let is_popup = egui::Popup::is_any_open(ui.ctx());
        let is_free = !std::mem::replace(&mut self.had_popup, is_popup) && !is_popup;
        self.tools(ui, studio, language, actions);
        // This row is always there, so that the map stays where it is when the tool changes.
        let (row, _) = ui.allocate_exact_size(Vec2::new(ui.available_width(), ROW), Sense::hover());
        ui.scope_builder(UiBuilder::new().max_rect(row), |ui| {
            egui::ScrollArea::horizontal().id_salt("tool").auto_shrink(false).show(ui, |ui| {
                match (self.tool, &studio.frame) {
                    (Tool::Brush(effect), Some(frame)) => self.brush.settings(ui, effect, frame, language),
                    (tool, _) => drop(ui.weak(language.text(tool.help()))),
                }
            });
        });
        let (rect, response) = ui.allocate_exact_size(ui.available_size(), Sense::click_and_drag());
        response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Canvas, true, "map view"));
        let painter = ui.painter_at(rect);
        painter.rect_filled(rect, 0.0, ui.visuals().extreme_bg_color);
        let Some(frame) = &studio.frame else { return };
        let window = frame.window();
        let bounds = [
            window.x as f64 * window.cell,
            window.y as f64 * window.cell,
            window.right() as f64 * window.cell,
            window.bottom() as f64 * window.cell,
        ];
        // Side by side, picture A is in the left half, and the current picture in the right half.
        let whole_rect = rect;
        let is_beside = self.kept.as_ref().is_some_and(|kept| kept.is_beside);
        let rect = if is_beside { rect.with_min_x(rect.center().x) } else { rect };
        let size = [rect.width(), rect.height()];
        let mut view = self.view.unwrap_or_else(|| MapView::fitting(bounds, size));
        let before = view;
        let is_brush = matches!(self.tool, Tool::Brush(_));
        // With a brush, the points of a drawing cannot be dragged.
        if is_brush || !self.handles(ui, rect, studio, &view, actions) {
            self.navigate(ui, &response, rect, &mut view);
        }
        if is_brush {
            self.brush.paint(ui, &response, (rect, &view), (studio, is_free), actions);
        }
        if is_free {
            self.draw_line(ui, &response, (rect, &view), studio, actions);
        }
        if view != before {
            self.view = Some(view);
        }
        let screen = |world: [f64; 2]| {
            let [x, y] = view.screen(world, size);
            rect.min + Vec2::new(x, y)
        };
        let texture = self.texture(ui, frame);
        let [west, north, east, south] = sides(frame);
        let area = Rect::from_two_pos(screen([west, north]), screen([east, south]));
        let whole = Rect::from_min_max(pos2(0.0, 0.0), pos2(1.0, 1.0));
        let here = painter.with_clip_rect(rect);
        here.image(texture, area, whole, Color32::WHITE);
        if let Some(kept) = &self.kept {
            let edge = if is_beside { rect.left() } else { rect.left() + rect.width() * kept.share };
            let part = painter.with_clip_rect(whole_rect.with_max_x(edge));
            let shift = Vec2::new(if is_beside { rect.width() } else { 0.0 }, 0.0);
            let [west, north, east, south] = kept.sides;
            let area = Rect::from_two_pos(screen([west, north]), screen([east, south])).translate(-shift);
            part.rect_filled(whole_rect, 0.0, ui.visuals().extreme_bg_color);
            part.image(kept.texture.id(), area, whole, Color32::WHITE);
            painter.vline(edge, rect.y_range(), Stroke::new(2.0, Color32::WHITE));
            label(&painter, pos2(edge - 8.0, rect.top() + 10.0), Align2::RIGHT_TOP, "A");
            label(&painter, pos2(edge + 8.0, rect.top() + 10.0), Align2::LEFT_TOP, "B");
        }
        let painter = here;
        let shown_from = match &self.kept {
            Some(kept) if !is_beside => rect.left() + rect.width() * kept.share,
            _ => rect.left(),
        };
        self.contours.draw(&painter.with_clip_rect(rect.with_min_x(shown_from)), rect, frame, &view);
        self.follow(studio, &view, size, actions);
        if let Some(pointer) = response.hover_pos() {
            let at = pointer - rect.min;
            let world = view.world([at.x, at.y], size);
            let text = readout(frame, world, language);
            label(&painter, rect.left_bottom() + Vec2::new(8.0, -8.0), Align2::LEFT_BOTTOM, &text);
        }
        scale_bar(&painter, rect, &view);
        legend::draw(
            &painter,
            rect.min + Vec2::new(10.0, if self.kept.is_some() { 40.0 } else { 10.0 }),
            frame,
            language,
        );
        self.draw_drawing(&painter, studio, screen);
        self.draw_profile(ui, &painter, rect, frame, screen);
        if is_brush {
            self.brush.draw(&painter, response.hover_pos(), (rect, &view), studio, language);
        }
    }

    /// The choice of the tool, and the comparison.
    fn tools(&mut self, ui: &mut Ui, studio: &Studio, language: Language, actions: &mut Vec<Action>) {
        tool_row::show(ui, |ui| {
            let brushes = Effect::ALL.map(|effect| (Tool::Brush(effect), map_brush::names(effect)[0]));
            let tools = [
                (Tool::Pan, "map.pan"),
                (Tool::Profile, "map.profile"),
                (Tool::Draw(drawing::OPS[0]), "map.path"),
                (Tool::Draw(drawing::OPS[1]), "map.polygon"),
            ];
            for (tool, name) in tools.into_iter().chain(brushes) {
                if ui
                    .selectable_label(self.tool == tool, language.text(name))
                    .on_hover_text(language.text(tool.help()))
                    .clicked()
                {
                    self.tool = tool;
                    self.drawn.clear();
                }
            }
            if self.profile.is_some() && ui.button(language.text("map.clear")).clicked() {
                self.profile = None;
            }
            ui.separator();
            contours(ui, studio, language, actions);
            ui.separator();
            self.comparison(ui, studio, language, actions);
        });
    }

    /// Controls for keeping the picture, to compare it with pictures after later changes.
    fn comparison(&mut self, ui: &mut Ui, studio: &Studio, language: Language, actions: &mut Vec<Action>) {
        match &mut self.kept {
            None => {
                let keep = ui.add_enabled(studio.frame.is_some(), egui::Button::new(language.text("map.keep")));
                if keep.on_hover_text(language.text("map.keep_help")).clicked()
                    && let Some(frame) = &studio.frame
                {
                    let texture = ui.ctx().load_texture("kept map", image(frame), TextureOptions::LINEAR);
                    let text = studio.document.text().to_owned();
                    self.kept = Some(Kept { texture, sides: sides(frame), text, share: 0.5, is_beside: false });
                }
            }
            Some(kept) => {
                ui.toggle_value(&mut kept.is_beside, language.text("map.beside"))
                    .on_hover_text(language.text("map.beside_help"));
                ui.label("A");
                let share = egui::Slider::new(&mut kept.share, 0.0..=1.0).show_value(false);
                ui.add_enabled(!kept.is_beside, share).on_hover_text(language.text("map.share"));
                ui.label("B");
                let can_return = kept.text != studio.document.text();
                let back = ui.add_enabled(can_return, egui::Button::new(language.text("map.return")));
                if back.on_hover_text(language.text("map.return_help")).clicked() {
                    actions.push(Action::Type(kept.text.clone()));
                }
                if ui.button(language.text("map.drop")).clicked() {
                    self.kept = None;
                }
            }
        }
    }

    /// Starts drawing a line or an area.
    pub fn draw(&mut self, op: &'static str) {
        self.tool = Tool::Draw(op);
        self.drawn.clear();
    }

    /// Selects a brush.
    pub fn take_brush(&mut self, effect: Effect) {
        self.tool = Tool::Brush(effect);
    }

    /// Adds a point with each click; a double click or Enter ends the drawing, Escape discards it.
    fn draw_line(
        &mut self,
        ui: &Ui,
        response: &egui::Response,
        (rect, view): (Rect, &MapView),
        studio: &Studio,
        actions: &mut Vec<Action>,
    ) {
        let Tool::Draw(op) = self.tool else { return };
        let size = [rect.width(), rect.height()];
        let ends = response.double_clicked() || ui.input(|input| input.key_pressed(Key::Enter));
        if response.clicked()
            && !response.double_clicked()
            && let Some(pointer) = response.interact_pointer_pos()
        {
            let at = pointer - rect.min;
            self.drawn.push(view.world([at.x, at.y], size).map(f64::round));
        }
        if ui.input(|input| input.key_pressed(Key::Escape)) {
            self.drawn.clear();
        }
        let fewest = if op == drawing::OPS[0] { 2 } else { 3 };
        if ends && self.drawn.len() >= fewest {
            let taken = studio.document.recipe().nodes().iter().map(|named| named.name.as_str()).collect();
            let points = drawing::value(&std::mem::take(&mut self.drawn));
            actions.push(Action::Edit(Edit::Add {
                name: names::free(&names::of_op(op), &taken),
                op: op.to_owned(),
                inputs: Vec::new(),
                params: vec![(drawing::POINTS.to_owned(), points)],
                readers: Vec::new(),
            }));
            self.tool = Tool::Pan;
        }
    }

    /// Handles at the points of the selected drawing. Returns whether one is being dragged.
    fn handles(&self, ui: &Ui, rect: Rect, studio: &Studio, view: &MapView, actions: &mut Vec<Action>) -> bool {
        let Some((name, mut points)) = selected(studio) else { return false };
        let size = [rect.width(), rect.height()];
        let mut is_moving = false;
        for k in 0..points.len() {
            let [x, y] = view.screen(points[k], size);
            let around = Rect::from_center_size(rect.min + Vec2::new(x, y), Vec2::splat(14.0)).intersect(rect);
            if !around.is_positive() {
                continue;
            }
            let handle = ui.interact(around, ui.scope_id().with((name, k)), Sense::drag());
            handle.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Canvas, true, format!("point {k} of {name}")));
            if handle.dragged()
                && let Some(pointer) = handle.interact_pointer_pos()
            {
                let at = pointer - rect.min;
                points[k] = view.world([at.x, at.y], size).map(f64::round);
                actions.push(Action::Edit(Edit::Param {
                    node: name.to_owned(),
                    key: drawing::POINTS.to_owned(),
                    value: drawing::value(&points),
                }));
                is_moving = true;
            }
            if handle.drag_stopped() {
                actions.push(Action::EndGesture);
            }
        }
        is_moving
    }

    /// Draws the current drawing, and the selected one.
    fn draw_drawing(&self, painter: &egui::Painter, studio: &Studio, screen: impl Fn([f64; 2]) -> egui::Pos2) {
        let draw = |points: &[[f64; 2]], is_closed: bool| {
            let mut line: Vec<egui::Pos2> = points.iter().map(|point| screen(*point)).collect();
            if is_closed && let Some(first) = line.first().copied() {
                line.push(first);
            }
            painter.line(line.clone(), Stroke::new(4.0, Color32::from_black_alpha(150)));
            painter.line(line.clone(), Stroke::new(2.0, Color32::from_rgb(255, 240, 120)));
            for point in line {
                painter.circle(point, 4.5, Color32::WHITE, Stroke::new(1.5, Color32::BLACK));
            }
        };
        if let Tool::Draw(op) = self.tool {
            draw(&self.drawn, op != drawing::OPS[0] && self.drawn.len() > 2);
        }
        if let Some((name, points)) = selected(studio) {
            let nodes = studio.document.recipe().nodes();
            let is_area = nodes.iter().any(|named| named.name == name && named.node.spec().op != drawing::OPS[0]);
            draw(&points, is_area);
        }
    }

    fn navigate(&mut self, ui: &Ui, response: &egui::Response, rect: Rect, view: &mut MapView) {
        let size = [rect.width(), rect.height()];
        let is_brush = matches!(self.tool, Tool::Brush(_));
        let is_by_primary = response.dragged_by(PointerButton::Primary);
        let is_line = self.tool == Tool::Profile && is_by_primary;
        if response.dragged() && !is_line && !(is_brush && is_by_primary) {
            let by = response.drag_delta();
            view.pan([by.x, by.y]);
        }
        if is_line && let Some(pointer) = response.interact_pointer_pos() {
            let at = pointer - rect.min;
            let here = view.world([at.x, at.y], size);
            match &mut self.profile {
                Some([_, end]) if !response.drag_started() => *end = here,
                profile => *profile = Some([here, here]),
            }
        }
        if response.contains_pointer()
            && let Some(pointer) = ui.input(|input| input.pointer.hover_pos())
        {
            let (scroll, pinch) = ui.input(|input| (input.smooth_scroll_delta().y, input.zoom_delta()));
            // Ctrl with the wheel is for the brush.
            let pinch = if is_brush { 1.0 } else { pinch };
            if scroll != 0.0 || pinch != 1.0 {
                // The pointer may be over the other picture.
                let at = pointer - rect.min;
                let at = if at.x < 0.0 { at + Vec2::new(rect.width(), 0.0) } else { at };
                view.zoom(f64::from(pinch * libm::expf(scroll * 0.004)), [at.x, at.y], size);
            }
        }
    }

    /// Requests pictures for the view, so that it is shown at its own resolution.
    fn follow(&mut self, studio: &Studio, view: &MapView, size: [f32; 2], actions: &mut Vec<Action>) {
        if self.view.is_none() {
            return;
        }
        let side = f64::from(size[0].max(size[1])) * view.scale * 1.1;
        let wanted = Region::in_view(studio.document.recipe().world.size, view.center, side);
        let is_near = match studio.look.region {
            _ if wanted == Region::Whole || studio.look.region == Region::Whole => wanted == studio.look.region,
            Region::Square { center, side: own } => {
                let moved = (0..2).map(|k| (center[k] - view.center[k]).abs()).fold(0.0, f64::max);
                moved < own * 0.12 && (0.6..1.6).contains(&(own / side))
            }
            Region::Whole => false,
        };
        if !is_near && self.asked != Some(wanted) {
            self.asked = Some(wanted);
            actions.push(Action::Region(wanted));
        }
    }

    fn texture(&mut self, ui: &Ui, frame: &Arc<Frame>) -> egui::TextureId {
        let key = frame.key();
        if let Some((texture, own)) = &self.texture
            && *own == key
        {
            return texture.id();
        }
        let texture = ui.ctx().load_texture("map", image(frame), TextureOptions::LINEAR);
        let id = texture.id();
        self.texture = Some((texture, key));
        id
    }

    fn draw_profile(
        &self,
        ui: &Ui,
        painter: &egui::Painter,
        rect: Rect,
        frame: &Frame,
        screen: impl Fn([f64; 2]) -> egui::Pos2,
    ) {
        let Some([from, to]) = self.profile else { return };
        painter.line_segment([screen(from), screen(to)], Stroke::new(3.0, Color32::from_black_alpha(160)));
        painter.line_segment([screen(from), screen(to)], Stroke::new(1.5, Color32::from_rgb(255, 214, 90)));
        let steps = 200;
        let values: Vec<Option<f32>> = (0..=steps)
            .map(|k| {
                let share = f64::from(k) / f64::from(steps);
                frame.at([0, 1].map(|c| from[c] + (to[c] - from[c]) * share)).map(|[value, _]| value)
            })
            .collect();
        let finite: Vec<f32> = values.iter().flatten().copied().filter(|value| value.is_finite()).collect();
        let low = finite.iter().copied().fold(f32::INFINITY, f32::min);
        let high = finite.iter().copied().fold(f32::NEG_INFINITY, f32::max);
        if finite.len() < 2 {
            return;
        }
        let size = Vec2::new((rect.width() - 24.0).clamp(60.0, 420.0), 96.0);
        let chart = Rect::from_min_size(rect.right_bottom() - size - Vec2::splat(12.0), size);
        painter.rect_filled(chart, 4.0, ui.visuals().window_fill.gamma_multiply(0.92));
        let inner = chart.shrink2(Vec2::new(8.0, 16.0));
        let points: Vec<egui::Pos2> = values
            .iter()
            .enumerate()
            .filter_map(|(k, value)| {
                let share = ((*value)? - low) / (high - low).max(1e-6);
                Some(pos2(
                    inner.left() + inner.width() * k as f32 / steps as f32,
                    inner.bottom() - inner.height() * share,
                ))
            })
            .collect();
        painter.line(points, Stroke::new(1.5, ui.visuals().selection.bg_fill));
        let length = libm::hypot(to[0] - from[0], to[1] - from[1]);
        let text = format!("{low:.1} – {high:.1} {}, {length:.0} m", frame.unit);
        painter.text(
            chart.left_top() + Vec2::new(8.0, 2.0),
            Align2::LEFT_TOP,
            text,
            FontId::proportional(11.0),
            ui.visuals().text_color(),
        );
    }
}

/// The picture of a frame. Large frames are reduced to every second, third, ... sample.
fn image(frame: &Frame) -> ColorImage {
    let window = frame.window();
    let step = window.width.max(window.height).div_ceil(LARGEST).max(1);
    if step == 1 {
        return ColorImage::from_rgba_unmultiplied([window.width, window.height], &frame.shaded);
    }
    let rows = (0..window.height).step_by(step);
    let pixels: Vec<u8> = rows
        .clone()
        .flat_map(|j| (0..window.width).step_by(step).map(move |i| 4 * (j * window.width + i)))
        .flat_map(|at| frame.shaded[at..at + 4].iter().copied())
        .collect();
    ColorImage::from_rgba_unmultiplied([window.width.div_ceil(step), rows.count()], &pixels)
}

/// The sides of the picture of a frame: west, north, east and south in metres. Samples are points, and each is at the
/// center of a pixel.
fn sides(frame: &Frame) -> [f64; 4] {
    let window = frame.window();
    [window.x, window.y, window.right(), window.bottom()].map(|side| (side as f64 - 0.5) * window.cell)
}

/// The selected drawing: the name of its node, and its points.
fn selected(studio: &Studio) -> Option<(&str, Vec<[f64; 2]>)> {
    let name = studio.selected.first()?;
    let named = studio.document.recipe().nodes().iter().find(|named| named.name == *name)?;
    Some((&named.name, drawing::points_of(&named.node)?))
}

/// A bar of a round length.
fn scale_bar(painter: &egui::Painter, rect: Rect, view: &MapView) {
    let target = f64::from(rect.width().min(600.0)) * 0.2 * view.scale;
    let power = libm::pow(10.0, libm::log10(target).floor());
    let length = [5.0, 2.0, 1.0].into_iter().map(|step| step * power).find(|length| *length <= target).unwrap_or(power);
    let width = (length / view.scale) as f32;
    let text = if length >= 1000.0 { format!("{} km", length / 1000.0) } else { format!("{length} m") };
    let start = rect.right_top() + Vec2::new(-width - 14.0, 30.0);
    let end = start + Vec2::new(width, 0.0);
    painter.line_segment([start, end], Stroke::new(4.0, Color32::from_black_alpha(160)));
    painter.line_segment([start, end], Stroke::new(2.0, Color32::WHITE));
    label(painter, start.lerp(end, 0.5) + Vec2::new(0.0, -6.0), Align2::CENTER_BOTTOM, &text);
}
