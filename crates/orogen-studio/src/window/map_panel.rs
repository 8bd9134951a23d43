//! The map: pan and zoom, values under the pointer, a comparison with a kept picture.

use std::sync::Arc;

use eframe::egui::{
    self, Align2, Color32, ColorImage, PointerButton, Pos2, Rect, Response, Sense, Stroke, TextureHandle,
    TextureOptions, Ui, Vec2, pos2,
};

use super::action::Action;
use super::contour_lines::ContourLines;
use super::label::{draft, label};
use super::relief_panel::{contours, readout};
use super::tools::{Projection, Tools};
use super::{legend, tool_row};
use crate::catalogue::Language;
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
    /// The last requested region.
    asked: Option<Region>,
    /// The picture that later ones are compared with.
    kept: Option<Kept>,
    contours: ContourLines,
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

/// Maximum side of a picture.
const LARGEST: usize = 4096;

impl MapPanel {
    /// Shows the whole map.
    pub fn show_whole(&mut self) {
        self.view = None;
    }

    /// Shows the map.
    pub fn show(
        &mut self,
        ui: &mut Ui,
        studio: &Studio,
        tools: &mut Tools,
        language: Language,
        actions: &mut Vec<Action>,
    ) {
        tool_row::show(ui, "map", |ui| {
            contours(ui, studio, language, actions);
            ui.separator();
            self.comparison(ui, studio, language, actions);
        });
        let (rect, response) = ui.allocate_exact_size(ui.available_size(), Sense::click_and_drag());
        response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Canvas, true, language.text("spoken.map")));
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
        if !tools.use_on(ui, &response, &projection(rect, before), (studio, language), actions) {
            navigate(ui, &response, rect, tools, &mut view);
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
        draft(&painter, rect, frame, language);
        legend::draw(
            &painter,
            rect.min + Vec2::new(10.0, if self.kept.is_some() { 40.0 } else { 10.0 }),
            frame,
            language,
        );
        tools.draw(ui, &response, &projection(rect, view), (studio, frame), language);
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

/// Where the map shows positions of the world.
fn projection<'a>(rect: Rect, view: MapView) -> Projection<'a> {
    let size: [f32; 2] = rect.size().into();
    let world = move |at: Pos2| Some(view.world((at - rect.min).into(), size));
    Projection::new(rect, world, move |at| Some(rect.min + Vec2::from(view.screen(at, size))))
}

/// Moves the map by drags and the wheel.
fn navigate(ui: &Ui, response: &Response, rect: Rect, tools: &Tools, view: &mut MapView) {
    let size = [rect.width(), rect.height()];
    let buttons = [PointerButton::Primary, PointerButton::Secondary, PointerButton::Middle];
    if buttons.into_iter().any(|button| response.dragged_by(button) && !tools.takes_drags(button)) {
        let by = response.drag_delta();
        view.pan([by.x, by.y]);
    }
    if response.contains_pointer()
        && let Some(pointer) = ui.input(|input| input.pointer.hover_pos())
    {
        let (scroll, pinch) = ui.input(|input| (input.smooth_scroll_delta().y, input.zoom_delta()));
        // Ctrl with the wheel is for the brush.
        let pinch = if tools.is_brush() { 1.0 } else { pinch };
        if scroll != 0.0 || pinch != 1.0 {
            // The pointer may be over the other picture.
            let at = pointer - rect.min;
            let at = if at.x < 0.0 { at + Vec2::new(rect.width(), 0.0) } else { at };
            view.zoom(f64::from(pinch * libm::expf(scroll * 0.004)), [at.x, at.y], size);
        }
    }
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
