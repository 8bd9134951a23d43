//! The note of a node: the comment above it in the recipe.

use toml_edit::{DocumentMut, Item, Table};

/// The notes of all nodes of a recipe that have a table of their own: names and texts, empty where there is no comment.
#[must_use]
pub fn all(text: &str) -> Vec<(String, String)> {
    let Ok(document) = text.parse::<DocumentMut>() else { return Vec::new() };
    let nodes = document.get("nodes").and_then(Item::as_table);
    let tables = nodes.into_iter().flat_map(Table::iter);
    tables.filter_map(|(name, item)| Some((name.to_owned(), of(item.as_table()?)))).collect()
}

/// The comment directly above a table, without its marks. Comments further up belong to what is before it.
fn of(table: &Table) -> String {
    let prefix = table.decor().prefix().and_then(|prefix| prefix.as_str()).unwrap_or_default();
    let line = |line: &str| line.strip_prefix("# ").or(line.strip_prefix('#')).unwrap_or(line).to_owned();
    own(prefix).1.lines().map(line).collect::<Vec<_>>().join("\n")
}

/// What is above a table: what it does not own, and its comment. It owns the lines after the last empty one.
fn own(prefix: &str) -> (&str, &str) {
    let start = prefix.rfind("\n\n").map_or(0, |at| at + 2);
    // A table that follows another one begins with the end of an empty line.
    let start = if start == 0 && prefix.starts_with('\n') { 1 } else { start };
    prefix.split_at(start)
}

/// Sets the note of a node; an empty one removes it.
///
/// # Errors
/// If the node has no table of its own.
pub fn set(document: &mut DocumentMut, name: &str, note: &str) -> Result<(), String> {
    let table = document.get_mut("nodes").and_then(|nodes| nodes.get_mut(name)).and_then(Item::as_table_mut);
    let table = table.ok_or_else(|| format!("`{name}` has no table of its own for a note"))?;
    let prefix = table.decor().prefix().and_then(|prefix| prefix.as_str()).unwrap_or_default().to_owned();
    let mut made = own(&prefix).0.to_owned();
    if !note.is_empty() {
        for line in note.split('\n') {
            // Control characters are not allowed in comments.
            let line: String = line.chars().filter(|c| !c.is_control()).collect();
            made += if line.is_empty() { "#" } else { "# " };
            made += &line;
            made.push('\n');
        }
    }
    table.decor_mut().set_prefix(made);
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::editing::document::Document;
    use crate::editing::edit::Edit;

    const TEXT: &str = "orogen = 1\n\n# All nodes.\n\n# The hills,\n#  rolling.\n[nodes.hills]\nop = \"fbm\"\n\n\
        [nodes.soft]\nop = \"blur\"\nsource = \"hills\"\n\n[outputs]\nheight = \"soft\"\n";

    fn note(document: &Document, name: &str) -> String {
        all(document.text()).into_iter().find(|(own, _)| own == name).unwrap().1
    }

    #[test]
    fn a_note_is_the_comment_above_a_node() {
        let mut document = Document::new("test", TEXT.to_owned()).unwrap();
        assert_eq!(note(&document, "hills"), "The hills,\n rolling.");
        assert_eq!(note(&document, "soft"), "");
        let set = |document: &mut Document, name: &str, text: &str| {
            document.apply(&Edit::Note { node: name.into(), text: text.into() }).unwrap();
        };
        for text in ["smooth", "two\n\nlines\u{7}", "ends with space "] {
            set(&mut document, "soft", text);
            assert_eq!(note(&document, "soft"), text.replace('\u{7}', ""));
            assert_eq!(note(&document, "hills"), "The hills,\n rolling.");
        }
        set(&mut document, "soft", "");
        assert_eq!(document.text(), TEXT);
        set(&mut document, "hills", "");
        assert!(document.text().contains("# All nodes.\n\n[nodes.hills]"), "{}", document.text());
        assert!(document.apply(&Edit::Note { node: "none".into(), text: "x".into() }).is_err());
    }

    #[test]
    fn the_notes_of_presets_come_back() {
        for preset in orogen::presets::all() {
            let document = Document::of_preset(preset).unwrap();
            let mut parsed: DocumentMut = document.text().parse().unwrap();
            for (name, note) in all(document.text()) {
                set(&mut parsed, &name, &note).unwrap();
            }
            let changed = parsed.to_string();
            assert_eq!(changed, document.text(), "{}", preset.name);
        }
    }
}
