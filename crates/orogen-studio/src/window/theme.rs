//! The colors and text sizes of the interface.

use eframe::egui::{Color32, Context, FontId, Frame, TextStyle, ThemePreference, Ui, UiBuilder, UiKind, UiStackInfo};

use crate::settings::Theme;

/// The size of the smallest texts, in points: smaller Chinese cannot be read.
const SMALL: f32 = 11.0;

/// Sets the colors and text sizes of the interface.
pub fn set(context: &Context, theme: Theme) {
    context.all_styles_mut(|style| {
        style.text_styles.insert(TextStyle::Small, FontId::proportional(SMALL));
    });
    context.set_theme(match theme {
        Theme::Dark => ThemePreference::Dark,
        Theme::Light => ThemePreference::Light,
        Theme::System => ThemePreference::System,
    });
}

/// The frame of the panel in the middle: without a fill, because the window is cleared with the same color.
pub fn middle(ui: &Ui) -> Frame {
    Frame::central_panel(ui.style()).fill(Color32::TRANSPARENT)
}

/// The frame of a panel at a side, without a fill.
pub fn side(ui: &Ui) -> Frame {
    Frame::side_top_panel(ui.style()).fill(Color32::TRANSPARENT)
}

/// Shows panels without a fill. What fades into its surroundings is told their color.
pub fn on_cleared(ui: &mut Ui, add: impl FnOnce(&mut Ui)) {
    let behind = UiStackInfo::new(UiKind::Frame).with_frame(Frame::new().fill(ui.visuals().panel_fill));
    ui.scope_builder(UiBuilder::new().ui_stack_info(behind), add);
}
