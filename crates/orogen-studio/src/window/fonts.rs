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

/// Adds a system font with Chinese characters. Returns its family, or `None` if the system has none; Chinese characters
/// are then shown as boxes.
#[must_use]
pub fn add_chinese(context: &Context) -> Option<String> {
    let mut database = fontdb::Database::new();
    database.load_system_fonts();
    let family = FAMILIES.into_iter().find_map(|family| {
        let query = fontdb::Query { families: &[fontdb::Family::Name(family)], ..fontdb::Query::default() };
        database.query(&query).map(|id| (family, id))
    });
    let (family, id) = family?;
    let data = database.with_face_data(id, |bytes, index| (bytes.to_vec(), index))?;
    let mut fonts = FontDefinitions::default();
    let font = FontData { index: data.1, ..FontData::from_owned(data.0) };
    fonts.font_data.insert(family.to_owned(), Arc::new(font));
    for list in [FontFamily::Proportional, FontFamily::Monospace] {
        fonts.families.entry(list).or_default().push(family.to_owned());
    }
    context.set_fonts(fonts);
    Some(family.to_owned())
}
