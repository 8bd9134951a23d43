//! The fields of a package for a game engine.

use eframe::egui::{DragValue, RichText, Ui};
use orogen::export::registry;
use orogen::export::targets::list;

use super::rows;
use crate::catalogue::Language;
use crate::export::layer::layers;
use crate::export::request::Export;
use crate::studio::Studio;

/// Number of tiles along a side.
const TILES: std::ops::RangeInclusive<usize> = 1..=100;

/// Shows the fields.
pub fn show(ui: &mut Ui, export: &mut Export, studio: &Studio, language: Language) {
    let own = &mut export.engine;
    let mut is_other = false;
    rows::grid(ui, "engine", |ui| {
        let items: Vec<(&'static str, String)> =
            list::all().iter().map(|target| (target.name, target.name.to_owned())).collect();
        let mut name = own.target.name;
        if rows::choice(ui, language.text("export.engine"), &mut name, &items)
            && let Some(target) = list::named(name)
        {
            own.set_target(target);
            is_other = true;
        }
        let mut layer = own.layer.clone();
        let recipe = studio.document.recipe();
        let mut names = registry::named("png").map(|format| layers(format, recipe)).unwrap_or_default();
        if !recipe.scatter().is_empty() {
            names.extend(own.target.objects_layer().map(str::to_owned));
        }
        if rows::names(ui, language.text("menu.layer"), &mut layer, names, language) {
            is_other = true;
            own.layer = layer;
        }
        let most = language.text("export.side_of_world").to_owned();
        let sides: Vec<(Option<usize>, String)> = std::iter::once((None, most))
            .chain(own.target.sides.iter().map(|side| (Some(*side), side.to_string())))
            .collect();
        rows::choice(ui, language.text("export.side"), &mut own.side, &sides);
        if own.target.tile.is_some() {
            let label = ui.label(language.text("export.tiles"));
            ui.horizontal(|ui| {
                for (tiles, suffix) in own.tiles.iter_mut().zip([" ×", ""]) {
                    ui.add(DragValue::new(tiles).range(TILES).speed(0.05).suffix(suffix)).labelled_by(label.id);
                }
            });
            ui.end_row();
        }
    });
    ui.add_space(4.0);
    ui.label(RichText::new(language.told(own.target.about)).weak());
    if is_other {
        export.set_extension();
    }
}
