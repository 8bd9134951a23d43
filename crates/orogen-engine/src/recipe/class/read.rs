//! Conversion of `[[class]]` tables.

use super::document::{End, HEIGHT, MAX_CLASSES, Share, TerrainClass};
use crate::recipe::condition::read::{CONDITIONS, Places, ValueReader};
use orogen_grid::words::suggestion;
use orogen_ops::value::{Span, Spanned, Value};

/// The keys of a class, beside conditions.
pub const KEYS: [&str; 5] = ["name", "color", "any", "mask", "share"];

/// The keys of a share.
const SHARE_KEYS: [&str; 3] = ["of", "lowest", "highest"];

/// The classes of a recipe with the positions of their tables, and their problems.
#[derive(Debug, Default)]
pub struct Read {
    /// The classes.
    pub classes: Vec<TerrainClass>,
    /// The positions of their tables and of the names in those.
    pub places: Places,
    /// The problems, with positions.
    pub diagnostics: Vec<(Span, String)>,
}

/// Reads the list of classes. `bounded` tells whether the world is bounded: only then are drainage areas and shares known.
pub fn read(value: &Spanned<Value>, bounded: bool) -> Read {
    let mut out = Read::default();
    let mut values = ValueReader::new(bounded);
    match &value.value {
        Value::List(items) if items.is_empty() => {
            values.diagnostic(&value.span, "`class` needs at least one entry; add a table `[[class]]` with a `name`");
        }
        Value::List(items) if items.len() > MAX_CLASSES => values.diagnostic(
            &value.span,
            format!("there are {} tables `[[class]]`; a recipe has at most {MAX_CLASSES}", items.len()),
        ),
        Value::List(items) => {
            for item in items {
                let Some(class) = class(&mut values, item, out.classes.is_empty(), bounded) else { continue };
                if !class.name.is_empty() && out.classes.iter().any(|other| other.name == class.name) {
                    let message = format!(
                        "there are two classes `{}`; give one another name, or join them by `any`, a list of alternatives",
                        class.name
                    );
                    values.diagnostic(&item.span, message);
                }
                out.classes.push(class);
                out.places.tables.push(item.span.clone());
            }
        }
        other => values.diagnostic(
            &value.span,
            format!("`class` must be a list of tables, `[[class]]`, not {}", other.describe()),
        ),
    }
    out.places.names = values.names;
    Read { diagnostics: values.diagnostics, ..out }
}

fn class(values: &mut ValueReader, table: &Spanned<Value>, is_first: bool, bounded: bool) -> Option<TerrainClass> {
    let entries = values.table("a class", table)?;
    let name = values.name(entries, &table.span, "a class", "water");
    let mut out = TerrainClass { name, ..TerrainClass::default() };
    for (key, value) in entries {
        let limits = matches!(key.value.as_str(), "any" | "mask" | "share") || CONDITIONS.contains(&key.value.as_str());
        if is_first && limits {
            let message =
                format!("the first class is everywhere and cannot have `{}`; list the base class first", key.value);
            values.diagnostic(&key.span, message);
            continue;
        }
        match key.value.as_str() {
            "color" => out.color = values.color(value),
            "mask" => out.mask = values.input("mask", value),
            "any" => out.any = values.alternatives(value),
            "share" => out.share = share(values, value, bounded),
            known if KEYS.contains(&known) => {}
            condition if CONDITIONS.contains(&condition) => out.all.extend(values.condition(condition, value)),
            unknown => {
                let hint = suggestion(unknown, KEYS.into_iter().chain(CONDITIONS));
                values.diagnostic(&key.span, format!("unknown key `{unknown}` in a class; {hint}"));
            }
        }
    }
    Some(out)
}

/// An exact share: what cells are ordered by, and how many are selected from one end.
fn share(values: &mut ValueReader, value: &Spanned<Value>, bounded: bool) -> Option<Share> {
    const EXAMPLE: &str = "{ of = \"height\", lowest = 0.4 }";
    let Value::Table(_) = &value.value else {
        let message = format!("`share` must be a table such as {EXAMPLE}, not {}", value.value.describe());
        values.diagnostic(&value.span, message);
        return None;
    };
    let entries = values.table("`share`", value)?;
    if !bounded {
        values.diagnostic(
            &value.span,
            "`share` needs a bounded world; set `size` in `world`, or use a condition instead",
        );
    }
    let (mut of, mut ends) = (None, Vec::new());
    for (key, value) in entries {
        let end = End::ALL.iter().find(|(name, _)| *name == key.value);
        match (key.value.as_str(), end, &value.value) {
            ("of", _, Value::Text(name)) if !name.is_empty() => {
                values.names.push((name.clone(), value.span.clone()));
                of = Some(name.clone());
            }
            ("of", _, other) => {
                let message = format!("`of` must be \"{HEIGHT}\" or name a node or a layer, not {}", other.describe());
                values.diagnostic(&value.span, message);
                of = Some(HEIGHT.to_string());
            }
            (_, Some((name, end)), _) => ends.push((*end, values.share(name, value))),
            (unknown, None, _) => {
                let hint = suggestion(unknown, SHARE_KEYS);
                values.diagnostic(&key.span, format!("unknown key `{unknown}` in `share`; {hint}"));
            }
        }
    }
    if of.is_none() {
        values.diagnostic(&value.span, format!("`share` needs `of`, what cells are ordered by, such as {EXAMPLE}"));
    }
    match ends.as_slice() {
        [(end, part)] => Some(Share { of: of?, end: *end, part: *part }),
        _ => {
            let message = format!("`share` needs either `lowest` or `highest`, a part of all cells, such as {EXAMPLE}");
            values.diagnostic(&value.span, message);
            None
        }
    }
}
