//! The colors and text sizes of the interface.

use eframe::egui::{Context, FontId, TextStyle, ThemePreference};

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
