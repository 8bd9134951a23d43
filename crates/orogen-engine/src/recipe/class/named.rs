//! Numbering of a recipe's classes by their names: as the terrains of a tileset, or as the standard classes.

use crate::recipe::class::expand::expand_at;
use crate::recipe::document::Recipe;
use orogen_grid::error::{Error, ErrorKind, Result};

/// Gives the classes of a recipe the numbers of their names in a list. `list` describes the list in messages: "terrain
/// of the tileset `fields-16`". `cell` is the cell of the map, in metres.
///
/// # Errors
/// If a class has a name that is not in the list, or the recipe also has an output `class`.
pub fn number(recipe: &mut Recipe, names: &[&str], list: &str, cell: f64) -> Result<()> {
    let code_of = |name: &str| {
        let code = (0..).zip(names).find(|(_, known)| **known == name).map(|(code, _): (u8, _)| code);
        code.ok_or_else(|| {
            let message =
                format!("the class `{name}` is no {list}, of which there are: {}; rename the class", names.join(", "));
            Error::new(ErrorKind::Request, message)
        })
    };
    let codes: Vec<u8> = recipe.classes().iter().map(|class| code_of(&class.name)).collect::<Result<_>>()?;
    expand_at(recipe, cell, &codes)
}
