//! Stored plans: a text that is not a plan is refused with a message, and so is a plan with any number changed.
//!
//! The first byte of the input chooses a plan, the others change its JSON.

use crate::edits::edited;
use orogen::plan::Plan;
use orogen::{Options, Recipe, Window, World};
use std::sync::LazyLock;

/// Plans and their JSON.
static PLANS: LazyLock<Vec<(Plan, String)>> = LazyLock::new(|| {
    let recipe = Recipe::parse(include_str!("plan.toml"), "it").expect("a recipe");
    let world = World::with_options(recipe, Options { threads: Some(1), ..Options::default() }).expect("a world");
    let window = Window::new(6, 5, 10.0).at(20, 10);
    let layers: [&[&str]; 3] = [&["height"], &["height", "soft"], &["whole"]];
    let plans = layers.into_iter().map(|layers| world.plan(layers, &window).expect("a plan"));
    plans.map(|plan| (plan.clone(), serde_json::to_string(&plan).expect("JSON"))).collect()
});

/// Runs the target on an input.
pub fn run(bytes: &[u8]) {
    let _ = serde_json::from_slice::<Plan>(bytes);
    let Some((&which, edits)) = bytes.split_first() else { return };
    let (plan, text) = &PLANS[usize::from(which) % PLANS.len()];
    if let Ok(read) = serde_json::from_slice::<Plan>(&edited(text.as_bytes(), edits)) {
        // Other spaces, or the same number in other digits.
        assert_eq!(read, *plan);
    }
}
