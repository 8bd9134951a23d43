//! Fonts: egui's fonts, and a system font for Chinese.

use std::sync::Arc;

use eframe::egui::{Context, FontData, FontDefinitions, FontFamily};

/// Font families with Chinese characters, the best first.
const FAMILIES: [&str; 12] = [
    "Noto Sans CJK SC",
    "Noto Sans SC",
    "Source Han Sans SC",
    "Source Han Sans CN",
    "Microsoft YaHei",
    "PingFang SC",
    "Hiragino Sans GB",
    "WenQuanYi Micro Hei",
    "WenQuanYi Zen Hei",
    "Droid Sans Fallback",
    "SimHei",
    "SimSun",
];

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
    let Some((family, font)) = chinese() else { return false };
    let mut fonts = FontDefinitions::default();
    fonts.font_data.insert(family.to_owned(), Arc::new(font));
    for list in [FontFamily::Proportional, FontFamily::Monospace] {
        fonts.families.entry(list).or_default().push(family.to_owned());
    }
    context.set_fonts(fonts);
    true
}

/// The best font with Chinese characters: its family and data.
fn chinese() -> Option<(&'static str, FontData)> {
    let mut database = fontdb::Database::new();
    database.load_system_fonts();
    let family = FAMILIES.into_iter().find_map(|family| {
        let query = fontdb::Query { families: &[fontdb::Family::Name(family)], ..fontdb::Query::default() };
        database.query(&query).map(|id| (family, id))
    });
    let (family, id) = family?;
    let (bytes, index) = database.with_face_data(id, |bytes, index| (bytes.to_vec(), index))?;
    Some((family, FontData { index, ..FontData::from_owned(bytes) }))
}
