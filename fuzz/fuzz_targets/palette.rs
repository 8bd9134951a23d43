//! Palette files: any text is a palette in each of the formats, or refused with a message. A palette has a colour everywhere.
#![no_main]

use libfuzzer_sys::fuzz_target;
use orogen::palette::fitted::Fitted;
use orogen::palette::read::parse;

fuzz_target!(|text: &str| {
    for extension in ["cpt", "gpl", "toml", "txt"] {
        if let Ok(palette) = parse("it", extension, text) {
            let fitted = Fitted::new(&palette, -100.0, 900.0, 0.0);
            for height in [-1e9, -100.0, 0.0, 333.3, 900.0, 1e9, f32::NAN] {
                let color = fitted.at(height);
                assert!(color.iter().all(|part| part.is_finite()), "{extension} at {height}: {color:?}\n{text}");
            }
        }
    }
});
