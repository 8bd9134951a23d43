//! What shaders share that draw the land: the light of the sky and of water, and tone mapping, in WGSL.

use std::fmt::Write;

use super::encode::SceneData;

/// The light of the sky and of water, and tone mapping.
pub const LIGHT: [&str; 4] =
    [include_str!("scene.wgsl"), include_str!("sky.wgsl"), include_str!("water.wgsl"), include_str!("tone.wgsl")];

/// The constants, numbers and grids of a scene, by name.
pub struct Named<'a> {
    /// Declarations in WGSL.
    pub text: String,
    /// Numbers and starts of grids.
    pub words: Vec<u32>,
    /// Grids, with the index of their first sample.
    pub uploads: Vec<(usize, &'a [f32])>,
    /// Number of samples in all grids.
    pub samples: usize,
}

impl<'a> Named<'a> {
    /// Names the data of a scene.
    #[must_use]
    pub fn new(data: &'a SceneData) -> Named<'a> {
        let constants = data.constants.iter().map(|(name, values)| match values[..] {
            [red, green, blue] => format!("const {name} = vec3<f32>({red:?}, {green:?}, {blue:?});\n"),
            _ => format!("const {name} = f32({:?});\n", values.first().copied().unwrap_or_default()),
        });
        let counts = data.counts.iter().map(|(name, count)| format!("const {name} = {count}u;\n"));
        let mut named =
            Named { text: constants.chain(counts).collect(), words: Vec::new(), uploads: Vec::new(), samples: 0 };
        for (name, values) in &data.numbers {
            named.word(name);
            named.words.extend(values.iter().map(|value| value.to_bits()));
        }
        for (name, values) in &data.integers {
            named.word(name);
            named.words.extend(values.iter().map(|value| value.cast_unsigned()));
        }
        for (name, parts) in &data.grids {
            named.word(name);
            named.words.push(named.samples as u32);
            for part in parts.iter().filter(|part| !part.is_empty()) {
                named.uploads.push((named.samples, &**part));
                named.samples += part.len();
            }
        }
        named
    }

    /// Names the next word.
    pub fn word(&mut self, name: &str) {
        // Writing to a string cannot fail.
        let _ = writeln!(self.text, "const {name} = {}u;", self.words.len());
    }
}

/// The light of pictures for shaders of other programs: light of the sky, haze, ground and water, and tone mapping.
#[derive(Debug, Clone, PartialEq)]
pub struct LightShader {
    /// Functions in WGSL; the text is the same for all light. The shader that includes it must define `fn word(at: u32)
    /// -> u32`, which returns a word, and `fn triple_of(start: u32) -> vec3<f32>`, which returns three successive
    /// numbers of the tables.
    pub text: String,
    /// The words.
    pub words: Vec<u32>,
    /// The tables, one after the other.
    pub tables: Vec<f32>,
}

impl LightShader {
    /// Encodes the data of [`Lighting`](super::lighting::Lighting).
    #[must_use]
    pub fn new(data: &SceneData) -> LightShader {
        let Named { mut text, words, uploads, .. } = Named::new(data);
        text.extend(LIGHT);
        LightShader { text, words, tables: uploads.into_iter().flat_map(|(_, part)| part).copied().collect() }
    }
}
