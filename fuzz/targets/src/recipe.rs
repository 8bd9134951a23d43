//! Recipes: any text is a recipe or diagnostics.

use orogen::Recipe;

/// Runs the target on an input; one that is no text is skipped.
pub fn run(input: &[u8]) {
    let Ok(text) = std::str::from_utf8(input) else { return };
    if let Ok(recipe) = Recipe::parse(text, "it") {
        let written = recipe.to_toml();
        let again = Recipe::parse(&written, "written");
        assert!(again.is_ok_and(|again| again == recipe), "{written}");
    }
}
