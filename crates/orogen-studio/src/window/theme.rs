//! The colors of the interface.

use eframe::egui::{Context, ThemePreference};

use crate::settings::Theme;

/// Sets the colors of the interface.
pub fn set(context: &Context, theme: Theme) {
    context.set_theme(match theme {
        Theme::Dark => ThemePreference::Dark,
        Theme::Light => ThemePreference::Light,
        Theme::System => ThemePreference::System,
    });
}
