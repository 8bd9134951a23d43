//! The shader's text, and the encoding of a scene for the shader.

use std::fmt::Write;

use orogen_output::render::encode::SceneData;

/// The parts that other shaders also use: the light of the sky and of water, and tone mapping.
const LIGHT: [&str; 4] =
    [include_str!("scene.wgsl"), include_str!("sky.wgsl"), include_str!("water.wgsl"), include_str!("tone.wgsl")];

/// The rest of the shader, in parts by concern.
const PARTS: [&str; 10] = [
    include_str!("data.wgsl"),
    include_str!("relief.wgsl"),
    include_str!("march.wgsl"),
    include_str!("skylight_at.wgsl"),
    include_str!("grain.wgsl"),
    include_str!("ground.wgsl"),
    include_str!("waves.wgsl"),
    include_str!("meet.wgsl"),
    include_str!("shade.wgsl"),
    include_str!("picture.wgsl"),
];

/// A scene for the shader.
pub(super) struct Encoded<'a> {
    /// The shader's text. Names and lengths of a scene's data do not depend on the scene, so the text is the same for
    /// all scenes.
    pub text: String,
    /// Numbers and starts of grids. The index of the picture's first row follows.
    pub words: Vec<u32>,
    /// Grids, with the index of their first sample.
    pub uploads: Vec<(usize, &'a [f32])>,
    /// Number of samples in all grids; the picture follows them.
    pub samples: usize,
    pub rays_per_pixel: usize,
}

/// The constants, numbers and grids of a scene, by name.
struct Named<'a> {
    text: String,
    words: Vec<u32>,
    uploads: Vec<(usize, &'a [f32])>,
    samples: usize,
}

impl<'a> Named<'a> {
    fn new(data: &'a SceneData) -> Named<'a> {
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
    fn word(&mut self, name: &str) {
        // Writing to a string cannot fail.
        let _ = writeln!(self.text, "const {name} = {}u;", self.words.len());
    }
}

impl<'a> Encoded<'a> {
    pub fn new(data: &'a SceneData) -> Encoded<'a> {
        let mut named = Named::new(data);
        named.word("PICTURE");
        named.words.push(named.samples as u32);
        named.word("FIRST_ROW");
        let Named { mut text, words, uploads, samples } = named;
        text.extend(LIGHT.into_iter().chain(PARTS));
        let rays = data.integers.iter().find_map(|(name, values)| (*name == "SAMPLES").then(|| values.first())?);
        let rays_per_pixel = rays.map_or(1, |count| count.unsigned_abs() as usize);
        Encoded { text, words, uploads, samples, rays_per_pixel }
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
    /// Encodes the data of [`Lighting`](orogen_output::render::lighting::Lighting).
    #[must_use]
    pub fn new(data: &SceneData) -> LightShader {
        let Named { mut text, words, uploads, .. } = Named::new(data);
        text.extend(LIGHT);
        LightShader { text, words, tables: uploads.into_iter().flat_map(|(_, part)| part).copied().collect() }
    }
}
