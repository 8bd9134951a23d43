//! Palette files: any text is a palette in each of the formats, or refused with a message. A palette has a color
//! everywhere.

use orogen::io::palette::fitted::Fitted;
use orogen::io::palette::read::parse;

/// Runs the target on an input; one that is no text is skipped.
pub fn run(input: &[u8]) {
    let Ok(text) = std::str::from_utf8(input) else { return };
    for extension in ["cpt", "gpl", "toml", "txt"] {
        if let Ok(palette) = parse("it", extension, text) {
            let fitted = Fitted::new(&palette, -100.0, 900.0, 0.0);
            for height in [-1e9, -100.0, 0.0, 333.3, 900.0, 1e9, f32::NAN] {
                let color = fitted.at(height);
                assert!(color.iter().all(|part| part.is_finite()), "{extension} at {height}: {color:?}\n{text}");
            }
        }
    }
}
