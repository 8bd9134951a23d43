//! The panels of the window.

use std::sync::Arc;

use eframe::egui::{self, CentralPanel, Panel, RichText, Ui, ViewportBuilder, ViewportClass, ViewportId};

use super::action::Action;
use super::graph_panel::Graph;
use super::inspector::Inspector;
use super::map_panel::MapPanel;
use super::realism_panel::RealismPanel;
use super::relief_drawing::Ability;
use super::relief_panel::ReliefPanel;
use super::start_page::StartPage;
use super::text_panel::TextPanel;
use super::tools::Tools;
use super::variants_panel::VariantsPanel;
use super::{analysis_panel, status, theme, tool_row};
use crate::catalogue::Language;
use crate::platform::{self, Gpu};
use crate::preview::worker::Wake;
use crate::settings::Settings;
use crate::settings::layout::{Below, Layout, View};
use crate::studio::Studio;

/// The panels.
pub struct Panels {
    /// The land in 3D.
    pub relief: ReliefPanel,
    /// The land from above.
    map: MapPanel,
    /// The tools for the land.
    pub tools: Tools,
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

/// The least width of a view beside another one.
const BESIDE: f32 = 160.0;

/// Initial and minimum size of the second window.
const APART: [f32; 2] = [900.0, 700.0];
const LEAST: [f32; 2] = [320.0, 240.0];

impl Panels {
    /// The panels of a window.
    #[must_use]
    pub fn new(wake: &Wake) -> Panels {
        Panels {
            relief: ReliefPanel::default(),
            map: MapPanel::default(),
            tools: Tools::default(),
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
        (self.text, self.map) = (TextPanel::default(), MapPanel::default());
        self.graph.reset();
        self.tools = Tools::default();
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
        let Shown { settings, gpu, language, .. } = *shown;
        let Some(studio) = shown.studio else {
            CentralPanel::default()
                .frame(theme::middle(ui))
                .show(ui, |ui| self.start.show(ui, settings, language, actions));
            return;
        };
        let mut layout = settings.layout;
        Panel::bottom("status").frame(theme::side(ui)).show(ui, |ui| status::show(ui, studio, gpu, language));
        if layout.has_inspector {
            let most = (ui.available_width() * 0.6).clamp(220.0, 520.0);
            let panel = Panel::right("inspector")
                .frame(theme::side(ui))
                .default_size(layout.width.unwrap_or(300.0))
                .size_range(220.0..=most);
            let inspector = panel.show(ui, |ui| {
                egui::ScrollArea::vertical()
                    .auto_shrink(false)
                    .show(ui, |ui| self.inspector.show(ui, studio, language, actions));
            });
            layout.width = Some(inspector.response.rect.width());
        }
        if layout.has_below {
            self.show_below(ui, studio, &mut layout, language, actions);
        }
        CentralPanel::default()
            .frame(theme::middle(ui))
            .show(ui, |ui| self.show_views(ui, (studio, shown), &mut layout, actions));
        if layout != settings.layout {
            actions.push(Action::Layout(layout));
        }
    }

    /// Shows the views with their tools.
    fn show_views(
        &mut self,
        ui: &mut Ui,
        (studio, shown): (&Studio, &Shown),
        layout: &mut Layout,
        actions: &mut Vec<Action>,
    ) {
        let Shown { ability, language, .. } = *shown;
        self.tools.begin(ui.ctx());
        tool_row::show(ui, "land", |ui| {
            for view in View::ALL.into_iter().filter(|view| !platform::IS_PAGE || *view != View::Windows) {
                if ui.selectable_label(layout.view == view, language.text(view.name())).clicked() {
                    layout.view = view;
                }
            }
            if layout.view == View::Windows
                && ui.button(language.text("view.swap")).on_hover_text(language.text("view.swap_help")).clicked()
            {
                layout.is_relief_apart = !layout.is_relief_apart;
            }
            ui.separator();
            self.tools.choice(ui, language);
        });
        self.tools.settings(ui, studio, language);
        match layout.view {
            View::Relief => self.relief.show(ui, studio, &mut self.tools, (ability, language), actions),
            View::Map => self.map.show(ui, studio, &mut self.tools, language, actions),
            View::Both => {
                let width = ui.available_width();
                let panel = Panel::left("relief").frame(theme::middle(ui)).resizable(true);
                let panel = panel.default_size(layout.beside.unwrap_or(width / 2.0));
                let relief = panel
                    .size_range(BESIDE..=(width - BESIDE).max(BESIDE))
                    .show(ui, |ui| self.relief.show(ui, studio, &mut self.tools, (ability, language), actions));
                layout.beside = Some(relief.response.rect.width());
                CentralPanel::default()
                    .frame(theme::middle(ui))
                    .show(ui, |ui| self.map.show(ui, studio, &mut self.tools, language, actions));
            }
            View::Windows => self.show_windows(ui, (studio, shown), layout, actions),
        }
    }

    /// Shows one view here, and the other one in a window of its own.
    fn show_windows(
        &mut self,
        ui: &mut Ui,
        (studio, shown): (&Studio, &Shown),
        layout: &mut Layout,
        actions: &mut Vec<Action>,
    ) {
        let Shown { ability, language, .. } = *shown;
        let is_relief_apart = layout.is_relief_apart;
        let mut show = |ui: &mut Ui, is_relief: bool| match is_relief {
            true => self.relief.show(ui, studio, &mut self.tools, (ability, language), actions),
            false => self.map.show(ui, studio, &mut self.tools, language, actions),
        };
        show(ui, !is_relief_apart);
        let of_view = language.text(if is_relief_apart { View::Relief.name() } else { View::Map.name() });
        let title = format!("{} – {of_view}", studio.document.title());
        let builder = ViewportBuilder::default().with_title(title).with_inner_size(APART).with_min_inner_size(LEAST);
        let is_closed = ui.ctx().show_viewport_immediate(ViewportId::from_hash_of("apart"), builder, |ui, class| {
            if class == ViewportClass::EmbeddedWindow {
                // Systems without more windows show it within this one.
                ui.set_min_size(LEAST.into());
            }
            CentralPanel::default().show(ui, |ui| show(ui, is_relief_apart));
            ui.input(|input| input.viewport().close_requested())
        });
        if is_closed {
            layout.view = if is_relief_apart { View::Map } else { View::Relief };
        }
    }

    fn show_below(
        &mut self,
        ui: &mut Ui,
        studio: &Studio,
        layout: &mut Layout,
        language: Language,
        actions: &mut Vec<Action>,
    ) {
        let available = ui.available_height();
        // The view keeps some room.
        let most = (available * 0.8).min(available - VIEW).max(60.0);
        let height = layout.height.unwrap_or(available * 0.36);
        let panel =
            Panel::bottom("below").frame(theme::side(ui)).resizable(true).default_size(height).size_range(60.0..=most);
        let below = panel.show(ui, |ui| {
            ui.horizontal(|ui| {
                for (below, name) in [
                    (Below::Graph, "below.graph"),
                    (Below::Text, "below.text"),
                    (Below::Analysis, "below.analysis"),
                    (Below::Real, "below.real"),
                    (Below::Variants, "below.variants"),
                ] {
                    let is_shown = layout.below == below;
                    let label = match below == Below::Text && !studio.document.is_valid() {
                        // Red on the color of the selection would not be readable.
                        true if is_shown => RichText::new(format!("! {}", language.text(name))),
                        true => RichText::new(format!("! {}", language.text(name))).color(ui.visuals().error_fg_color),
                        false => RichText::new(language.text(name)),
                    };
                    if ui.selectable_label(is_shown, label).clicked() {
                        layout.below = below;
                    }
                }
            });
            // A panel with little content keeps its size.
            ui.set_min_size(ui.available_size());
            match layout.below {
                Below::Graph => self.graph.show(ui, studio, language, actions),
                Below::Text => self.text.show(ui, studio, language, actions),
                Below::Analysis => analysis_panel::show(ui, studio, language),
                Below::Real => self.real.show(ui, studio, language),
                Below::Variants => self.variants.show(ui, studio, language, actions),
            }
        });
        layout.height = Some(below.response.rect.height());
    }
}
