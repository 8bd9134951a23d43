//! The shader's text, and the scene as the shader reads it.

use std::fmt::Write;

use orogen_output::render::encode::SceneData;

/// The shader after its constants, in parts by concern.
const PARTS: [&str; 11] = [
    include_str!("scene.wgsl"),
    include_str!("relief.wgsl"),
    include_str!("march.wgsl"),
    include_str!("sky.wgsl"),
    include_str!("grain.wgsl"),
    include_str!("ground.wgsl"),
    include_str!("water.wgsl"),
    include_str!("tone.wgsl"),
    include_str!("meet.wgsl"),
    include_str!("shade.wgsl"),
    include_str!("picture.wgsl"),
];

/// A scene for the shader.
pub(super) struct Encoded<'a> {
    /// The shader's text. Names and lengths of what a scene has do not depend on the scene, so it is the same for all.
    pub text: String,
    /// Numbers and starts of grids. The index of the picture's first row follows.
    pub words: Vec<u32>,
    /// Grids, with the index of their first sample.
    pub uploads: Vec<(usize, &'a [f32])>,
    /// Number of samples in all grids: the picture follows.
    pub samples: usize,
    pub rays_per_pixel: usize,
}

impl<'a> Encoded<'a> {
    pub fn new(data: &'a SceneData) -> Encoded<'a> {
        let mut text = String::new();
        let mut words = Vec::new();
        let constants = data.constants.iter().map(|(name, values)| match values[..] {
            [red, green, blue] => format!("const {name} = vec3<f32>({red:?}, {green:?}, {blue:?});\n"),
            _ => format!("const {name} = f32({:?});\n", values.first().copied().unwrap_or_default()),
        });
        text.extend(constants);
        text.extend(data.counts.iter().map(|(name, count)| format!("const {name} = {count}u;\n")));
        let mut name_word = |name: &str, at: usize| {
            // Writing to a string cannot fail.
            let _ = writeln!(text, "const {name} = {at}u;");
        };
        for (name, values) in &data.numbers {
            name_word(name, words.len());
            words.extend(values.iter().map(|value| value.to_bits()));
        }
        let mut rays_per_pixel = 1;
        for (name, values) in &data.integers {
            name_word(name, words.len());
            words.extend(values.iter().map(|value| value.cast_unsigned()));
            if *name == "SAMPLES" {
                rays_per_pixel = values.first().map_or(1, |count| count.unsigned_abs() as usize);
            }
        }
        let mut uploads = Vec::new();
        let mut samples = 0;
        for (name, parts) in &data.grids {
            name_word(name, words.len());
            words.push(samples as u32);
            for part in parts.iter().filter(|part| !part.is_empty()) {
                uploads.push((samples, &**part));
                samples += part.len();
            }
        }
        name_word("PICTURE", words.len());
        words.push(samples as u32);
        name_word("FIRST_ROW", words.len());
        text.extend(PARTS);
        Encoded { text, words, uploads, samples, rays_per_pixel }
    }
}
