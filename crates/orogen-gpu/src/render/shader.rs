//! The shader's text, and the encoding of a scene for the shader.

use orogen_output::render::encode::SceneData;
use orogen_output::render::shader::{LIGHT, Named};

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
