//! The list of `[[surface]]` tables.

use super::document::{MAX_SURFACES, Surface};
use crate::recipe::condition::part::{is_limit, refuse_limit};
use crate::recipe::table::keys::Keys;
use crate::recipe::table::list::List;

/// The list.
pub static SURFACES: List<Surface> = List {
    key: "surface",
    doc: "Surfaces that cover the ground, from bottom to top. Each covers those before it where its conditions hold; the first one is everywhere.",
    names: ["a surface", "surfaces"],
    count: [0, MAX_SURFACES],
    keys: Keys { needs: &[("name", "`name`, such as \"rock\"")], parts: Surface::PARTS },
    entry: |table, values, before| {
        let limit = table.entries.iter().find(|(key, _)| is_limit(&key.value) || key.value == "opacity");
        if let Some((key, _)) = limit.filter(|_| before.is_empty()) {
            refuse_limit(values, "surface", key);
        }
        SURFACES.keys.read(table, values, Surface::default())
    },
};
