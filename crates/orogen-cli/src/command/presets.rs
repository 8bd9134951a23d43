//! `orogen presets`.

use orogen::recipe::presets;

use crate::failure::Failure;
use crate::say;

/// Prints the presets, one per line: name and description.
pub fn run() -> Result<(), Failure> {
    let longest = presets::all().iter().map(|preset| preset.name.len()).max().unwrap_or(0);
    let mut text = String::new();
    for preset in presets::all() {
        let line = format!("{:longest$}  {}", preset.name, preset.recipe()?.about);
        text.push_str(line.trim_end());
        text.push('\n');
    }
    say::out(&text)
}
