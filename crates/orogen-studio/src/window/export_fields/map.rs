//! The fields of a map sheet.

use eframe::egui::{Checkbox, ComboBox, DragValue, Grid, Ui};
use orogen::jobs::map::MapColors;
use orogen::jobs::sheet_format::SheetFormat;
use orogen::palette::named;
use orogen::sheet::options::Resolution;
use orogen::sheet::paper;
use orogen::world::HEIGHT;

use super::rows;
use crate::catalogue::Language;
use crate::export::map::{COLORS, DPI, LABELS, MapExport, PARTS, SCALES, SHADINGS, SIDE};
use crate::export::request::Export;
use crate::studio::Studio;

/// Columns of the parts.
const COLUMNS: usize = 3;

/// Shows the fields.
pub fn show(ui: &mut Ui, export: &mut Export, studio: &Studio, language: Language) {
    let own = &mut export.map;
    let mut is_other = false;
    rows::grid(ui, "map", |ui| {
        let formats: Vec<(SheetFormat, String)> =
            SheetFormat::ALL.into_iter().map(|format| (format, format!(".{}", format.name()))).collect();
        is_other = rows::choice(ui, language.text("export.format"), &mut own.format, &formats);
        rows::samples(ui, &mut own.samples, language);
        colors(ui, own, studio, language);
        let shadings: Vec<_> =
            SHADINGS.iter().map(|(shading, _, key)| (*shading, language.text(key).to_owned())).collect();
        rows::choice(ui, language.text("export.shading"), &mut own.shading, &shadings);
        let interval = language.text("export.interval");
        if own.levels.is_empty() {
            rows::optional(ui, interval, &mut own.interval, (100.0, 0.01..=10_000.0), ["", " m"], language);
        }
        rows::text(ui, language.text("export.levels"), &mut own.levels);
        let automatic = (None, language.text("export.automatic").to_owned());
        let labels: Vec<_> = std::iter::once(automatic)
            .chain(LABELS.iter().map(|(labels, _, key)| (Some(*labels), language.text(key).to_owned())))
            .collect();
        rows::choice(ui, language.text("export.labels"), &mut own.labels, &labels);
        rows::switch(ui, language.text("export.grid"), &mut own.has_grid);
        if own.has_grid {
            let step = language.text("export.grid_step");
            rows::optional(ui, step, &mut own.grid_step, (1000.0, 1e-6..=1e7), ["", ""], language);
        }
        let colors = &mut own.page_colors;
        rows::color(ui, language.text("export.page_color"), &mut colors.page);
        rows::color(ui, language.text("export.ink_color"), &mut colors.ink);
        rows::optional_color(ui, language.text("export.water_color"), &mut colors.water, [34, 92, 156], language);
        rows::optional_color(ui, language.text("export.contour_color"), &mut colors.contours, [126, 82, 42], language);
        for (key, area, first) in
            [("export.river_area", &mut own.river_area, 1e6), ("export.lake_area", &mut own.lake_area, 1e5)]
        {
            rows::optional(ui, language.text(key), area, (first, 1.0..=1e15), ["", " m²"], language);
        }
        rows::text(ui, language.text("export.names"), &mut own.names);
        rows::text(ui, language.text("export.sheet_title"), &mut own.title);
        let fitted = language.text("export.paper_fitted");
        rows::optional_name(
            ui,
            language.text("export.paper"),
            &mut own.paper,
            fitted,
            paper::NAMES.iter().map(|(name, _)| *name),
        );
        if own.paper.is_some() {
            rows::switch(ui, language.text("export.landscape"), &mut own.is_landscape);
        } else {
            let scale = language.text("export.map_scale");
            rows::optional(ui, scale, &mut own.map_scale, (100_000.0, 1.0..=1e9), ["1 : ", ""], language);
        }
        resolution(ui, &mut own.resolution, language);
    });
    ui.add_space(4.0);
    ui.strong(language.text("export.parts"));
    Grid::new("parts").num_columns(COLUMNS).spacing([16.0, 4.0]).show(ui, |ui| {
        for (nth, (_, key, part)) in PARTS.iter().enumerate() {
            ui.add(Checkbox::new(part(&mut own.parts), language.text(key)));
            if nth % COLUMNS == COLUMNS - 1 {
                ui.end_row();
            }
        }
    });
    if is_other {
        export.set_extension();
    }
}

/// What the colors show, and how.
fn colors(ui: &mut Ui, own: &mut MapExport, studio: &Studio, language: Language) {
    let items: Vec<_> = COLORS.iter().map(|(colors, _, key)| (*colors, language.text(key).to_owned())).collect();
    let mut colors = own.colors;
    if rows::choice(ui, language.text("export.colors"), &mut colors, &items) {
        own.set_colors(colors);
    }
    if own.colors != MapColors::Palette {
        return;
    }
    let mut layer = own.layer.clone();
    if rows::names(ui, language.text("menu.layer"), &mut layer, MapExport::layers(studio.document.recipe())) {
        own.set_layer(&layer);
    }
    let palettes = named::all().iter().map(|palette| palette.name);
    let none = language.text("menu.own_palette");
    rows::optional_name(ui, language.text("export.palette"), &mut own.palette, none, palettes);
    if own.palette.is_some() {
        rows::switch(ui, language.text("export.nearest_color"), &mut own.nearest_color);
    }
    if own.layer != HEIGHT {
        let automatic = (None, language.text("export.automatic").to_owned());
        let scales: Vec<_> = std::iter::once(automatic)
            .chain(SCALES.iter().map(|(scale, _, key)| (Some(*scale), language.text(key).to_owned())))
            .collect();
        rows::choice(ui, language.text("export.scale"), &mut own.scale, &scales);
    }
    rows::optional_ends(ui, language.text("export.range"), &mut own.range, [0.0, 1000.0], language);
}

/// The resolution: pixels per inch, or pixels of the page.
fn resolution(ui: &mut Ui, value: &mut Option<Resolution>, language: Language) {
    ui.label(language.text("export.resolution"));
    ui.horizontal(|ui| {
        let [automatic, inch, longer] =
            ["export.automatic", "export.dpi", "export.page_side"].map(|key| language.text(key));
        let shown = match value {
            None => automatic,
            Some(Resolution::Inch(_)) => inch,
            Some(Resolution::Longer(_)) => longer,
        };
        ComboBox::from_id_salt("resolution").width(200.0).selected_text(shown).show_ui(ui, |ui| {
            for (text, first) in
                [(automatic, None), (inch, Some(Resolution::Inch(150.0))), (longer, Some(Resolution::Longer(2000)))]
            {
                if ui.selectable_label(shown == text, text).clicked() && shown != text {
                    *value = first;
                }
            }
        });
        match value {
            None => {}
            Some(Resolution::Inch(dpi)) => {
                // The command line takes whole numbers.
                let mut whole = *dpi as u16;
                if ui.add(DragValue::new(&mut whole).range(DPI)).changed() {
                    *dpi = f64::from(whole);
                }
            }
            Some(Resolution::Longer(pixels)) => drop(ui.add(DragValue::new(pixels).range(SIDE).speed(5.0))),
        }
    });
    ui.end_row();
}
