//! The 3D view.

use std::sync::Arc;
use std::time::Duration;

use eframe::egui::{self, FontId, Key, PointerButton, Rect, Sense, Slider, Ui, WidgetInfo};
use eframe::egui_wgpu::Callback;

use super::action::Action;
use super::label::draft;
use super::light::{Block, Light};
use super::relief_drawing::{Ability, Drawing, PictureId, Scene};
use super::tools::{Projection, Tools};
use super::{legend, tool_row};
use crate::catalogue::Language;
use crate::platform::Instant;
use crate::preview::contours::suiting;
use crate::preview::frame::{Frame, Quality};
use crate::preview::ring::Ring;
use crate::studio::Studio;
use crate::view::camera::{Camera, Side};
use crate::view::land::Land;
use crate::view::pace::{Changes, Pace, REST};
use crate::view::rings;

/// State of the view.
pub struct ReliefPanel {
    /// The camera.
    pub camera: Camera,
    /// Vertical exaggeration; `None` before the first picture.
    exaggeration: Option<f64>,
    /// Whether the exaggeration stays as it is. At first it follows the land, until its first complete picture; then
    /// only the user changes it, so that higher land looks higher.
    is_settled: bool,
    has_water: bool,
    has_shadows: bool,
    has_wire: bool,
    /// The sun while it is being moved; shadows are updated when it stops.
    sun: Option<[f64; 2]>,
    light: Light,
    /// The resolution while something moves.
    pace: Option<Pace>,
    /// The last picture.
    last: Option<PictureId>,
    /// The time of the interface at which the camera moved last.
    turned: f64,
    /// When the view was created.
    opened: Instant,
    /// Kept cameras.
    pub views: Vec<[f32; 6]>,
}

impl Default for ReliefPanel {
    fn default() -> ReliefPanel {
        ReliefPanel {
            camera: Camera::default(),
            exaggeration: None,
            is_settled: false,
            has_water: true,
            has_shadows: true,
            has_wire: false,
            sun: None,
            light: Light::default(),
            pace: None,
            last: None,
            turned: f64::NEG_INFINITY,
            opened: Instant::now(),
            views: Vec::new(),
        }
    }
}

/// The settings of the view, for a render.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ShownView {
    /// The camera: degrees clockwise from north, and degrees above the horizon.
    pub camera: [f64; 2],
    /// The sun: degrees clockwise from north, and degrees above the horizon.
    pub sun: [f64; 2],
    /// The vertical exaggeration.
    pub exaggeration: f64,
}

/// The place of the picture that the rings of detail surround: a little below its middle, because what is closer needs
/// more detail.
const LOOKED_AT: [f32; 2] = [0.5, 0.6];

/// The size on screen, in pixels, above which the cells of the ground are divided.
const PIXELS_PER_CELL: f64 = 2.0;

/// Speed of flying by keys, relative to the distance, per second.
const FLIGHT: f32 = 0.9;

impl ReliefPanel {
    /// Shows the view.
    pub fn show(
        &mut self,
        ui: &mut Ui,
        studio: &Studio,
        tools: &mut Tools,
        (ability, language): (Option<Ability>, Language),
        actions: &mut Vec<Action>,
    ) {
        self.controls(ui, studio, language, actions);
        let (rect, response) = ui.allocate_exact_size(ui.available_size(), Sense::click_and_drag());
        response.widget_info(|| WidgetInfo::labeled(egui::Role::Canvas, true, language.text("spoken.relief")));
        let painter = ui.painter_at(rect);
        let Some(ability) = ability else {
            say(ui, rect, language.text("relief.no_graphics"));
            return;
        };
        let is_dragging = studio.frame.as_ref().is_some_and(|frame| {
            let rings = studio.rings();
            let land = self.land(frame, &rings);
            tools.use_on(ui, &response, &self.projection(&land, rect), (studio, language), actions)
        });
        if !is_dragging {
            self.navigate(ui, &response, rect, tools);
        }
        let Some(frame) = &studio.frame else {
            painter.rect_filled(rect, 0.0, ui.visuals().extreme_bg_color);
            // The line at the bottom of the window says more about failures.
            let is_failed = studio.failure.is_some() || !studio.document.is_valid();
            say(ui, rect, language.text(if is_failed { "relief.nothing" } else { "relief.waiting" }));
            return;
        };
        self.settle(frame);
        let pixels = ui.pixels_per_point();
        let largest = ability.largest as f32;
        let size = [rect.width(), rect.height()].map(|side| (side * pixels).round().clamp(1.0, largest) as u32);
        let sun = self.sun.unwrap_or(studio.look.sun);
        let drawing = Drawing {
            frame: Arc::clone(frame),
            rings: studio.rings(),
            scene: self.scene(frame, studio, rect.width() / rect.height().max(1.0)),
            light: self.light.of(studio, ui.ctx(), sun, self.block(frame)),
            has_wire: self.has_wire,
            size,
            share: 1.0,
            ability,
        };
        let drawing = self.paced(ui, drawing);
        self.refine(ui, studio, rect, &drawing, actions);
        painter.add(Callback::new_paint_callback(rect, drawing));
        legend::draw(&painter, rect.min + egui::vec2(10.0, 10.0), frame, language);
        draft(&painter, rect, frame, language);
        let rings = studio.rings();
        let land = self.land(frame, &rings);
        tools.draw(ui, &response, &self.projection(&land, rect), (studio, frame), language);
        let aspect = rect.width() / rect.height().max(1.0);
        let place_at = |at: egui::Pos2| land.hit(&self.camera, share(at, rect), aspect);
        let hovered = response.hover_pos().and_then(place_at);
        let aimed = response.interact_pointer_pos().filter(|_| response.double_clicked() && tools.moves());
        let aimed = aimed.and_then(place_at);
        if let Some(place) = hovered {
            let text = readout(frame, land.world(place), language);
            let galley = painter.layout_no_wrap(text, FontId::monospace(11.0), egui::Color32::WHITE);
            let at = rect.left_bottom() + egui::vec2(12.0, -12.0 - galley.size().y);
            // On light ground, light text would not be readable.
            let behind = Rect::from_min_size(at, galley.size()).expand(4.0);
            painter.rect_filled(behind, 3.0, egui::Color32::from_black_alpha(150));
            painter.galley(at, galley, egui::Color32::WHITE);
        }
        if let Some(place) = aimed {
            self.camera.target = place;
        }
    }

    /// The drawing at the resolution that the time of a frame allows: all pixels at rest.
    fn paced(&mut self, ui: &Ui, drawing: Drawing) -> Drawing {
        let (last, id) = (self.last.as_ref(), drawing.id());
        let frame = &drawing.frame;
        // The finest picture is the last one for now.
        let is_last = frame.quality == Quality::Fine && last.is_none_or(|last| !last.has_frame(frame));
        let changes = Changes {
            camera: last.is_some_and(|last| !last.has_camera(&drawing.scene)),
            picture: last.is_none_or(|last| !last.is_same_land(&id)) && !is_last,
            is_held: ui.input(|input| input.pointer.any_down()),
        };
        let pace = self.pace.get_or_insert_with(|| Pace::new(drawing.ability.is_software));
        let time = ui.input(|input| input.time);
        let share = pace.share(changes, time, self.opened.elapsed().as_secs_f64());
        if changes.camera {
            self.turned = time;
        }
        if time - self.turned < REST {
            // The time of a frame is only known if the next one follows at once.
            ui.ctx().request_repaint();
        } else if share < 1.0 || pace.is_moving(time) {
            ui.ctx().request_repaint_after(Duration::from_secs_f64(REST));
        }
        self.last = Some(id);
        Drawing { share, ..drawing }
    }

    /// Requests rings of detail around the place that the camera looks at, once it is at rest.
    fn refine(&self, ui: &Ui, studio: &Studio, rect: Rect, drawing: &Drawing, actions: &mut Vec<Action>) {
        let time = ui.input(|input| input.time);
        if time - self.turned < REST {
            if studio.is_refining() {
                actions.push(Action::Refine(None));
            }
            return;
        }
        if !studio.is_done() {
            return;
        }
        let frame = &drawing.frame;
        let land = self.land(frame, &[]);
        let seen = land.hit(&self.camera, LOOKED_AT, rect.width() / rect.height().max(1.0));
        let windows = seen.map_or_else(Vec::new, |place| {
            let pixel = self.camera.pixel(place, drawing.size[1] as f32);
            let cell = f64::from(pixel) * Land::unit(frame) * PIXELS_PER_CELL;
            rings::around(frame.window(), land.world(place), cell, drawing.ability.ring_cells())
        });
        if studio.refining() != Some(&windows) {
            actions.push(Action::Refine(Some(windows)));
        }
    }

    /// The settings of the view for a render: the position of the camera, and the vertical exaggeration, rounded to a
    /// tenth.
    #[must_use]
    pub fn shown(&self, studio: &Studio) -> ShownView {
        let times = self.times(studio.frame.as_deref());
        ShownView {
            camera: self.camera.bearing(),
            sun: studio.look.sun.map(|degrees| (degrees * 10.0).round() / 10.0),
            exaggeration: ((times * 10.0).round() / 10.0).max(0.1),
        }
    }

    /// Shows the whole land from the initial position.
    pub fn show_whole(&mut self) {
        self.camera = Camera::default();
    }

    /// Drops what belongs to the land of the previous document.
    pub fn reset(&mut self) {
        self.show_whole();
        (self.exaggeration, self.is_settled) = (None, false);
    }

    /// Sets the exaggeration by the first pictures of a document.
    fn settle(&mut self, frame: &Frame) {
        if !self.is_settled {
            let times = suiting_times(frame);
            self.exaggeration = Some(times);
            // Land that is still nearly level is no land to compare others with.
            self.is_settled = frame.quality == Quality::Fine && times < MAX_TIMES;
        }
    }

    fn controls(&mut self, ui: &mut Ui, studio: &Studio, language: Language, actions: &mut Vec<Action>) {
        tool_row::show(ui, "relief", |ui| {
            let mut sun = self.sun.unwrap_or(studio.look.sun);
            ui.label(language.text("relief.sun"));
            let azimuth = ui
                .add(Slider::new(&mut sun[0], 0.0..=360.0).show_value(false))
                .on_hover_text(language.text("relief.azimuth"));
            azimuth.widget_info(|| WidgetInfo::slider(true, sun[0], language.text("relief.azimuth")));
            let altitude = ui
                .add(Slider::new(&mut sun[1], 3.0..=90.0).show_value(false))
                .on_hover_text(language.text("relief.altitude"));
            altitude.widget_info(|| WidgetInfo::slider(true, sun[1], language.text("relief.altitude")));
            if azimuth.changed() || altitude.changed() {
                self.sun = Some(sun);
            }
            let still = !azimuth.dragged() && !altitude.dragged();
            if still && let Some(sun) = self.sun.take() {
                actions.push(Action::Sun(sun));
            }
            ui.separator();
            let label = ui.label(language.text("relief.exaggeration"));
            let mut times = self.times(studio.frame.as_deref());
            let slider = Slider::new(&mut times, 0.1..=20.0).logarithmic(true).max_decimals(1).suffix("×");
            if ui.add(slider).labelled_by(label.id).changed() {
                (self.exaggeration, self.is_settled) = (Some(times), true);
            }
            ui.separator();
            self.cameras(ui, language, actions);
            contours(ui, studio, language, actions);
            ui.toggle_value(&mut self.has_water, language.text("relief.water"));
            ui.toggle_value(&mut self.has_shadows, language.text("relief.shadows"));
            ui.toggle_value(&mut self.has_wire, language.text("relief.wire"));
            let mut finest = studio.look.finest;
            let list = egui::ComboBox::from_id_salt("finest").width(64.0).selected_text(finest.to_string());
            let list = list.show_ui(ui, |ui| {
                for samples in [256, 512, 1024, 2048, 4096] {
                    ui.selectable_value(&mut finest, samples, format!("{samples}²"));
                }
            });
            list.response.on_hover_text(language.text("relief.finest"));
            if finest != studio.look.finest {
                actions.push(Action::Finest(finest));
            }
        });
    }

    /// The menu of cameras: the sides of the land, and those that were kept.
    fn cameras(&mut self, ui: &mut Ui, language: Language, actions: &mut Vec<Action>) {
        ui.menu_button(language.text("relief.views"), |ui| {
            for side in Side::ALL {
                if ui.button(language.text(side.name())).clicked() {
                    self.camera = Camera::of_side(side);
                    ui.close();
                }
            }
            ui.separator();
            for (nth, view) in self.views.iter().enumerate() {
                ui.horizontal(|ui| {
                    let number = (nth + 1).to_string();
                    if ui.button(language.fill("relief.kept_view", &[("number", &number)])).clicked() {
                        self.camera = Camera::of_numbers(*view);
                        ui.close();
                    }
                    let remove = ui.small_button("×").on_hover_text(language.text("relief.drop_view"));
                    let name = language.text("relief.drop_view");
                    remove.widget_info(|| WidgetInfo::labeled(egui::Role::Button, true, format!("{name} {number}")));
                    if remove.clicked() {
                        actions.push(Action::DropView(nth));
                    }
                });
            }
            if ui.button(language.text("relief.keep_view")).clicked() {
                actions.push(Action::KeepView(self.camera.numbers()));
                ui.close();
            }
        });
    }

    fn navigate(&mut self, ui: &Ui, response: &egui::Response, rect: Rect, tools: &Tools) {
        let height = rect.height().max(1.0);
        let drag = response.drag_delta() / height;
        let shift = ui.input(|input| input.modifiers.shift);
        let is_taken = tools.takes_drags(PointerButton::Primary);
        // A tool that uses the first button leaves the second one to turn the land.
        let turning = if is_taken { PointerButton::Secondary } else { PointerButton::Primary };
        let is_tool = is_taken && response.dragged_by(PointerButton::Primary);
        if response.dragged_by(turning) && !shift {
            self.camera.orbit([drag.x, drag.y]);
        } else if response.dragged() && !is_tool {
            self.camera.pan([drag.x, drag.y]);
        }
        if response.contains_pointer() {
            let (scroll, pinch) = ui.input(|input| (input.smooth_scroll_delta().y, input.zoom_delta()));
            // Ctrl with the wheel is for the brush.
            let pinch = if tools.is_brush() { 1.0 } else { pinch };
            if scroll != 0.0 || pinch != 1.0 {
                self.camera.zoom(pinch * libm::expf(scroll * 0.004));
            }
        }
        // Keys fly while the pointer is over the view and no field has the keyboard focus.
        if response.contains_pointer() && ui.ctx().memory(|memory| memory.focused().is_none()) {
            let (step, seconds) = ui.input(|input| {
                let axis =
                    |plus: Key, minus: Key| f32::from(i8::from(input.key_down(plus)) - i8::from(input.key_down(minus)));
                let is_plain = input.modifiers.is_none();
                let step = if is_plain {
                    [axis(Key::D, Key::A), axis(Key::E, Key::Q), axis(Key::W, Key::S)]
                } else {
                    [0.0; 3]
                };
                (step, input.stable_dt.min(0.1))
            });
            if step != [0.0; 3] {
                self.camera.fly(step.map(|part| part * FLIGHT * seconds));
                ui.ctx().request_repaint();
            }
        }
    }

    /// The vertical exaggeration.
    fn times(&self, frame: Option<&Frame>) -> f64 {
        self.exaggeration.or(frame.map(suiting_times)).unwrap_or(1.0)
    }

    /// The lowest and highest height, and the height at the center of the view.
    fn levels(frame: &Frame) -> [f32; 3] {
        let [low, high] = frame.levels;
        [low, high, (low + high) / 2.0]
    }

    /// The land as input of the light.
    fn block(&self, frame: &Frame) -> Block {
        let window = frame.window();
        let [width, height] = [window.width, window.height].map(|samples| (samples.max(2) - 1) as f64 * window.cell);
        let ([low, high, _], unit) = (Self::levels(frame), Land::unit(frame));
        Block {
            across: (width * width + height * height).sqrt() / unit,
            highest: f64::from(high - low) * self.times(Some(frame)) / unit,
            cell: window.cell,
        }
    }

    fn scene(&self, frame: &Frame, studio: &Studio, aspect: f32) -> Scene {
        let window = frame.window();
        let unit = Land::unit(frame) as f32;
        let [low, high, middle] = Self::levels(frame);
        let up = self.times(Some(frame)) as f32 / unit;
        let half = |samples: usize| (samples.max(2) - 1) as f32 * window.cell as f32 / 2.0 / unit;
        let sea = frame.sea_level as f32;
        let is_heights = frame.values.is_none() || studio.look.layer == orogen::world::HEIGHT;
        let has_water = self.has_water && is_heights && low < sea;
        let relief = (high - low).max(1e-3);
        let interval = studio.look.contours.map_or(0.0, |own| suiting(own, [low, high].map(f64::from)) as f32);
        let eye = self.camera.position();
        let matrix = self.camera.matrix(aspect);
        let lowest = (low - middle) * up;
        Scene {
            matrix: matrix.to_cols_array_2d(),
            inverse: matrix.inverse().to_cols_array_2d(),
            extent: [half(window.width), half(window.height), up, middle],
            lines: [interval, 0.5, lowest - 0.06, if self.has_shadows { 1.0 } else { 0.0 }],
            water: [sea, f32::from(u8::from(has_water)), lowest, relief],
            eye: [eye.x, eye.y, eye.z, 0.0],
        }
    }

    /// The land as it stands in the view, with the heights of the finest ring at each place.
    fn land<'a>(&self, frame: &'a Frame, rings: &'a [Arc<Ring>]) -> Land<'a> {
        let [_, _, middle] = Self::levels(frame);
        Land::new((frame, rings), self.times(Some(frame)), middle)
    }

    /// Where the view shows positions of the world.
    fn projection<'a>(&self, land: &'a Land<'a>, rect: Rect) -> Projection<'a> {
        let (camera, aspect) = (self.camera, rect.width() / rect.height().max(1.0));
        let matrix = camera.matrix(aspect);
        let world = move |at: egui::Pos2| land.hit(&camera, share(at, rect), aspect).map(|place| land.world(place));
        Projection::new(rect, world, move |at| {
            let clip = matrix * land.place(at)?.extend(1.0);
            let [x, y] = [clip.x, clip.y].map(|part| part / clip.w);
            let place = rect.center() + egui::vec2(x * rect.width(), -y * rect.height()) / 2.0;
            (clip.w > 0.0).then_some(place)
        })
    }
}

/// A position in the view, from 0, 0 to 1, 1.
fn share(at: egui::Pos2, rect: Rect) -> [f32; 2] {
    [(at.x - rect.left()) / rect.width(), (at.y - rect.top()) / rect.height()]
}

/// The largest vertical exaggeration that is chosen for a land.
const MAX_TIMES: f64 = 10.0;

/// The vertical exaggeration that suits a land: the largest whole number from 1 to 10 with which the relief is at most
/// about a seventh of the width.
fn suiting_times(frame: &Frame) -> f64 {
    let [low, high, _] = ReliefPanel::levels(frame);
    let times = f64::from(0.3 * Land::unit(frame) as f32 / (high - low).max(1e-3));
    times.floor().clamp(1.0, MAX_TIMES)
}

/// The switches for rivers and contours and, if these are on, a field for their interval; 0 chooses one that suits the
/// land.
pub fn contours(ui: &mut Ui, studio: &Studio, language: Language, actions: &mut Vec<Action>) {
    let mut rivers = studio.look.rivers;
    let switch = ui.toggle_value(&mut rivers, language.text("relief.rivers"));
    if switch.on_hover_text(language.text("relief.rivers_help")).clicked() {
        actions.push(Action::Rivers(rivers));
    }
    let own = studio.look.contours;
    let switch = ui.selectable_label(own.is_some(), language.text("relief.contours"));
    if switch.clicked() {
        actions.push(Action::Contours(if own.is_some() { None } else { Some(0.0) }));
    }
    if let Some(own) = own {
        let mut interval = own;
        let suits = |number: f64, _: std::ops::RangeInclusive<usize>| match number > 0.0 {
            true => format!("{} m", orogen::grid::words::number(number)),
            false => language.text("relief.interval_suits").to_owned(),
        };
        let field = ui.add(egui::DragValue::new(&mut interval).range(0.0..=1e5).speed(1.0).custom_formatter(suits));
        if field.on_hover_text(language.text("relief.interval")).changed() {
            actions.push(Action::Contours(Some(interval.round())));
        }
    }
}

/// Shows a text in the middle of the view.
fn say(ui: &mut Ui, rect: Rect, text: &str) {
    let text = egui::RichText::new(text).size(14.0).weak();
    ui.put(rect, egui::Label::new(text).selectable(false));
}

/// The value and the position at the pointer.
#[must_use]
pub fn readout(frame: &Frame, world: [f64; 2], language: Language) -> String {
    let Some([value, height]) = frame.at(world) else { return String::new() };
    let place = format!("{:.0} m E, {:.0} m S", world[0], world[1]);
    let draft =
        if frame.quality == Quality::Draft { format!(" ({})", language.text("analysis.draft")) } else { String::new() };
    match frame.values {
        None => format!("{height:.1} m{draft}   {place}"),
        Some(_) => format!("{value:.4} {}   {height:.1} m{draft}   {place}", language.named(frame.unit)),
    }
}
