//! Recipes: any text is a recipe or diagnostics.
#![no_main]

use libfuzzer_sys::fuzz_target;
use orogen::Recipe;

fuzz_target!(|text: &str| {
    if let Ok(recipe) = Recipe::parse(text, "it") {
        let written = recipe.to_toml();
        let again = Recipe::parse(&written, "written");
        assert!(again.is_ok_and(|again| again == recipe), "{written}");
    }
});
