//! A font of the system with Chinese characters.

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

/// The best font with Chinese characters: its family, its data, and its number in them.
#[must_use]
pub fn chinese_font() -> Option<(&'static str, Vec<u8>, u32)> {
    let mut database = fontdb::Database::new();
    database.load_system_fonts();
    let family = FAMILIES.into_iter().find_map(|family| {
        let query = fontdb::Query { families: &[fontdb::Family::Name(family)], ..fontdb::Query::default() };
        database.query(&query).map(|id| (family, id))
    });
    let (family, id) = family?;
    let (bytes, index) = database.with_face_data(id, |bytes, index| (bytes.to_vec(), index))?;
    Some((family, bytes, index))
}
