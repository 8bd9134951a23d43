//! The fields of a rendered picture.

use eframe::egui::{DragValue, Ui};
use orogen::jobs::render::{ELEVATION, EXAGGERATION, FOV, HAZE, MAX_SIDE, SAMPLES};
use orogen::palette::named;
use orogen::render::scene::Colors;

use super::rows;
use crate::catalogue::Language;
use crate::export::render::{COLORS, EDGES, RenderExport};
use crate::export::request::Export;
use crate::window::relief_panel::ShownView;

/// Takes over what the view in space shows.
pub fn follow(own: &mut RenderExport, view: &ShownView) {
    own.camera = view.camera;
    own.sun = view.sun;
    own.exaggeration = view.exaggeration;
    own.distance = None;
}

/// Shows the fields.
pub fn show(ui: &mut Ui, export: &mut Export, view: &ShownView, language: Language) {
    let own = &mut export.render;
    rows::grid(ui, "render", |ui| {
        ui.label(language.text("export.picture"));
        ui.horizontal(|ui| {
            for (side, suffix) in own.size.iter_mut().zip([" ×", ""]) {
                ui.add(DragValue::new(side).range(1..=MAX_SIDE).speed(4.0).suffix(suffix));
            }
        });
        ui.end_row();
        ui.label("");
        if ui.button(language.text("export.follow")).clicked() {
            follow(own, view);
        }
        ui.end_row();
        rows::pair(ui, language.text("export.camera"), &mut own.camera, [0.0..=360.0, ELEVATION], language);
        let metres = ["", " m"];
        let distance = language.text("export.distance");
        rows::optional(ui, distance, &mut own.distance, (10_000.0, 0.1..=1e7), metres, language);
        rows::number(ui, language.text("export.fov"), &mut own.fov, FOV, "°");
        rows::pair(ui, language.text("relief.sun"), &mut own.sun, [0.0..=360.0, 0.0..=90.0], language);
        rows::number(ui, language.text("export.exaggeration"), &mut own.exaggeration, EXAGGERATION, "×");
        rows::number(ui, language.text("export.haze"), &mut own.haze, HAZE, "");
        let items: Vec<_> = COLORS.iter().map(|(colors, _, key)| (*colors, language.text(key).to_owned())).collect();
        let mut colors = own.colors;
        if rows::choice(ui, language.text("export.colors"), &mut colors, &items) {
            own.set_colors(colors);
        }
        if own.colors == Colors::Map {
            let palettes = named::all().iter().map(|palette| palette.name);
            let none = language.text("menu.own_palette");
            rows::optional_name(ui, language.text("export.palette"), &mut own.palette, none, palettes);
            if own.palette.is_some() {
                rows::switch(ui, language.text("export.nearest_color"), &mut own.nearest_color);
            }
            rows::optional_ends(ui, language.text("export.range"), &mut own.range, [0.0, 1000.0], language);
            rows::switch(ui, language.text("export.color_bar"), &mut own.color_bar);
        }
        let automatic = (None, language.text("export.automatic").to_owned());
        let edges: Vec<_> = std::iter::once(automatic)
            .chain(EDGES.iter().map(|(edge, _, key)| (Some(*edge), language.text(key).to_owned())))
            .collect();
        rows::choice(ui, language.text("export.edge"), &mut own.edge, &edges);
        let snow_line = language.text("export.snow_line");
        rows::optional(ui, snow_line, &mut own.snow_line, (2000.0, -1e5..=1e5), metres, language);
        ui.label(language.text("export.rays"));
        ui.add(DragValue::new(&mut own.rays).range(SAMPLES).speed(0.1));
        ui.end_row();
        rows::samples(ui, &mut own.samples, language);
    });
}
