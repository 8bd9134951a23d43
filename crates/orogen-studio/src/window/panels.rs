//! The panels of the window.

use std::sync::Arc;

use eframe::egui::{self, CentralPanel, Panel, RichText, Ui};
use orogen::gpu::Gpu;

use super::action::Action;
use super::graph_panel::Graph;
use super::inspector::Inspector;
use super::map_panel::MapPanel;
use super::realism_panel::RealismPanel;
use super::relief::Ability;
use super::relief_panel::ReliefPanel;
use super::start_page::StartPage;
use super::text_panel::TextPanel;
use super::variants_panel::VariantsPanel;
use super::{analysis_panel, status};
use crate::catalogue::Language;
use crate::preview::worker::Wake;
use crate::settings::Settings;
use crate::studio::Studio;

/// The main view.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum View {
    /// The land in 3D.
    Relief,
    /// The land from above.
    Map,
}

/// The panel below the view.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Below {
    /// The graph of nodes.
    Graph,
    /// The text of the recipe.
    Text,
    /// Measurements.
    Analysis,
    /// Measurements compared with real land.
    Real,
    /// Pictures with other seeds and values.
    Variants,
}

/// The panels, and which of them are shown.
pub struct Panels {
    /// The main view.
    pub view: View,
    /// The panel below the view.
    pub below: Below,
    /// The land in 3D.
    pub relief: ReliefPanel,
    /// The land from above.
    pub map: MapPanel,
    /// The graph of nodes.
    pub graph: Graph,
    /// The text of the recipe.
    pub text: TextPanel,
    /// The parameters of the selected node.
    pub inspector: Inspector,
    real: RealismPanel,
    variants: VariantsPanel,
    start: StartPage,
}

/// The state that the panels show.
pub struct Shown<'a> {
    /// The state of the document; `None` on the start page.
    pub studio: Option<&'a Studio>,
    /// Settings that are remembered between runs.
    pub settings: &'a Settings,
    /// The graphics card that computes previews.
    pub gpu: Option<&'a Gpu>,
    /// The abilities of the window's device.
    pub ability: Option<Ability>,
    /// The language.
    pub language: Language,
}

/// The least height of the view with its tools.
const VIEW: f32 = 160.0;

impl Panels {
    /// The panels with the 3D view above the graph.
    #[must_use]
    pub fn new(wake: &Wake) -> Panels {
        Panels {
            view: View::Relief,
            below: Below::Graph,
            relief: ReliefPanel::default(),
            map: MapPanel::default(),
            graph: Graph::default(),
            text: TextPanel::default(),
            inspector: Inspector::default(),
            real: RealismPanel::new(Arc::clone(wake)),
            variants: VariantsPanel::new(Arc::clone(wake)),
            start: StartPage::default(),
        }
    }

    /// Drops the state of the previous document.
    pub fn reset(&mut self) {
        self.inspector = Inspector::default();
        (self.graph, self.text, self.map) = (Graph::default(), TextPanel::default(), MapPanel::default());
        self.relief.reset();
    }

    /// Shows the whole land in each view.
    pub fn show_whole(&mut self) {
        self.relief.show_whole();
        self.map.show_whole();
        self.graph.show_whole();
    }

    /// Shows the panels, or the start page.
    pub fn show(&mut self, ui: &mut Ui, shown: &Shown, actions: &mut Vec<Action>) {
        let Shown { settings, gpu, ability, language, .. } = *shown;
        let Some(studio) = shown.studio else {
            CentralPanel::default().show(ui, |ui| self.start.show(ui, settings, language, actions));
            return;
        };
        Panel::bottom("status").show(ui, |ui| status::show(ui, studio, gpu, language));
        if settings.has_inspector {
            let most = (ui.available_width() * 0.6).clamp(220.0, 520.0);
            Panel::right("inspector").default_size(300.0).size_range(220.0..=most).show(ui, |ui| {
                egui::ScrollArea::vertical()
                    .auto_shrink(false)
                    .show(ui, |ui| self.inspector.show(ui, studio, language, actions));
            });
        }
        if settings.has_below {
            self.show_below(ui, studio, language, actions);
        }
        CentralPanel::default().show(ui, |ui| {
            ui.horizontal(|ui| {
                for (view, name) in [(View::Relief, "view.relief"), (View::Map, "view.map")] {
                    if ui.selectable_label(self.view == view, language.text(name)).clicked() {
                        self.view = view;
                    }
                }
            });
            match self.view {
                View::Relief => self.relief.show(ui, studio, ability, language, actions),
                View::Map => self.map.show(ui, studio, language, actions),
            }
        });
    }

    fn show_below(&mut self, ui: &mut Ui, studio: &Studio, language: Language, actions: &mut Vec<Action>) {
        let available = ui.available_height();
        // The view keeps some room.
        let most = (available * 0.8).min(available - VIEW).max(60.0);
        Panel::bottom("below").resizable(true).default_size(available * 0.36).size_range(60.0..=most).show(ui, |ui| {
            ui.horizontal(|ui| {
                for (below, name) in [
                    (Below::Graph, "below.graph"),
                    (Below::Text, "below.text"),
                    (Below::Analysis, "below.analysis"),
                    (Below::Real, "below.real"),
                    (Below::Variants, "below.variants"),
                ] {
                    let label = match below == Below::Text && !studio.document.is_valid() {
                        // Red on the color of the selection would not be readable.
                        true if self.below == below => RichText::new(format!("! {}", language.text(name))),
                        true => RichText::new(format!("! {}", language.text(name))).color(ui.visuals().error_fg_color),
                        false => RichText::new(language.text(name)),
                    };
                    if ui.selectable_label(self.below == below, label).clicked() {
                        self.below = below;
                    }
                }
            });
            // A panel with little content keeps its size.
            ui.set_min_size(ui.available_size());
            match self.below {
                Below::Graph => self.graph.show(ui, studio, language, actions),
                Below::Text => self.text.show(ui, studio, language, actions),
                Below::Analysis => analysis_panel::show(ui, studio, language),
                Below::Real => self.real.show(ui, studio, language),
                Below::Variants => self.variants.show(ui, studio, language, actions),
            }
        });
    }
}
