//! The colors of a recipe's surfaces and terrain classes.

use orogen::io::palette::Rgb;
use orogen::io::palette::color::hex;
use orogen::recipe::Recipe;
use orogen::recipe::surface::Coloring;
use toml_edit::{Array, DocumentMut, Item, TableLike};

use super::tables::set;

/// A kind of table with colors.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Ground {
    /// A table `[[surface]]`.
    Surface,
    /// A table `[[class]]`.
    Class,
}

impl Ground {
    fn key(self) -> &'static str {
        match self {
            Ground::Surface => "surface",
            Ground::Class => "class",
        }
    }

    /// Index, name and colors of a recipe's surfaces or classes, in the order of the recipe: one color, or the colors
    /// of a gradient. Surfaces with a picture are omitted.
    #[must_use]
    pub fn of(self, recipe: &Recipe) -> Vec<(usize, String, Vec<Rgb>)> {
        match self {
            Ground::Surface => {
                let surfaces = recipe.surfaces().iter().enumerate();
                let colors = surfaces.filter_map(|(k, surface)| match &surface.color {
                    Coloring::Plain(color) => Some((k, surface.name.clone(), vec![*color])),
                    Coloring::Gradient(colors, _) => Some((k, surface.name.clone(), colors.clone())),
                    _ => None,
                });
                colors.collect()
            }
            Ground::Class => {
                let classes = recipe.classes().iter().enumerate();
                classes.map(|(k, class)| (k, class.name.clone(), vec![class.color(k)])).collect()
            }
        }
    }
}

/// Sets the colors of a surface or a class.
///
/// # Errors
/// If the text has no such table.
pub fn set_colors(document: &mut DocumentMut, ground: Ground, k: usize, colors: &[Rgb]) -> Result<(), String> {
    let key = ground.key();
    let missing = || format!("the text has no [[{key}]] number {}", k + 1);
    let own: &mut dyn TableLike = match document.get_mut(key).ok_or_else(missing)? {
        Item::ArrayOfTables(tables) => tables.get_mut(k).ok_or_else(missing)?,
        Item::Value(toml_edit::Value::Array(tables)) => {
            tables.get_mut(k).and_then(toml_edit::Value::as_inline_table_mut).ok_or_else(missing)?
        }
        _ => return Err(missing()),
    };
    match (colors, own.contains_key("gradient")) {
        (colors, true) => set(own, "gradient", colors.iter().map(|color| hex(*color)).collect::<Array>().into()),
        ([color], false) => set(own, "color", hex(*color).into()),
        _ => return Err(format!("[[{key}]] number {} has one color, not {}", k + 1, colors.len())),
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::editing::document::Document;
    use crate::editing::edit::Edit;
    use orogen::presets;

    #[test]
    fn colors_of_surfaces_and_classes_are_edited() {
        let mut document = Document::of_preset(presets::find("tile-island").unwrap()).unwrap();
        let before = Ground::Class.of(document.recipe());
        document.apply(&Edit::Colors { ground: Ground::Class, index: 1, colors: vec![[1, 2, 3]] }).unwrap();
        let after = Ground::Class.of(document.recipe());
        assert_eq!((&after[0], &after[1].2), (&before[0], &vec![[1, 2, 3]]));
        let tail = "\n[[surface]]\nname = \"meadow\"\ngradient = [\"#102030\", \"#ffffff\"] # two\n";
        document.type_text(format!("{}{tail}", document.text()));
        assert!(document.is_valid(), "{:?}", document.diagnostics());
        let colors = vec![[9, 8, 7], [0, 0, 0], [255, 1, 2]];
        document.apply(&Edit::Colors { ground: Ground::Surface, index: 0, colors: colors.clone() }).unwrap();
        assert_eq!(Ground::Surface.of(document.recipe()), [(0, "meadow".to_owned(), colors.clone())]);
        assert!(document.text().contains("# two"));
        let none = Edit::Colors { ground: Ground::Surface, index: 7, colors };
        assert!(document.apply(&none).unwrap_err().to_string().contains("number 8"));
    }
}
