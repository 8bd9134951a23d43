//! Fonts: egui's fonts, and a system font for Chinese. A browser draws characters that egui's fonts lack by itself.

use std::sync::Arc;

use eframe::egui::{Context, FontData, FontDefinitions, FontFamily};

use crate::platform;

/// Adds a system font with Chinese characters for names of files and nodes in any language of the interface. It is read
/// by a thread, because searching the fonts of the system takes a while.
///
/// # Errors
/// If the thread cannot be started.
pub fn add_chinese_later(context: &Context) -> std::io::Result<()> {
    let context = context.clone();
    let add = move || {
        if add_chinese(&context) {
            context.request_repaint();
        }
    };
    std::thread::Builder::new().name("fonts".into()).spawn(add).map(drop)
}

/// Adds a system font with Chinese characters. Returns false if the system has none; Chinese characters are then shown
/// as boxes.
#[must_use]
pub fn add_chinese(context: &Context) -> bool {
    let Some((family, bytes, index)) = platform::chinese_font() else { return false };
    let font = FontData { index, ..FontData::from_owned(bytes) };
    let mut fonts = FontDefinitions::default();
    fonts.font_data.insert(family.to_owned(), Arc::new(font));
    for list in [FontFamily::Proportional, FontFamily::Monospace] {
        fonts.families.entry(list).or_default().push(family.to_owned());
    }
    context.set_fonts(fonts);
    true
}
