//! Phacelle noise as WGSL functions.

use super::lattice::{Lattice, PLACE};
use super::noise::HASH;
use crate::phacelle::Phacelle;

/// The parts of a text that defines `fn phacelle(words: u32, x: Cell, y: Cell, direction: vec2<f32>) -> vec2<f32>`. It
/// returns the cosine and sine of stripes along a direction. The cell is that of [`Phacelle::shader_lattice`], and
/// `words` is the index of [`Phacelle::shader_words`].
pub const PHACELLE: [&str; 3] = [PLACE, HASH, include_str!("phacelle.wgsl")];

impl Phacelle {
    /// The words that the function reads. They do not include the period.
    #[doc(hidden)]
    #[must_use]
    pub fn shader_words(&self) -> Vec<u32> {
        let prepared = self.prepare();
        let octaves = prepared.program().octaves();
        let mut words: Vec<u32> = octaves.iter().flat_map(|octave| octave.words[..2].concat()).collect();
        words.extend(prepared.wave().map(f32::to_bits));
        words
    }

    /// The lattice of cells.
    #[doc(hidden)]
    #[must_use]
    pub fn shader_lattice(&self) -> Lattice {
        let prepared = self.prepare();
        let program = prepared.program();
        let frequency = program.octaves().first().map_or(0.0, |octave| octave.frequency);
        Lattice { limit: program.limit, ..Lattice::square(frequency, [0.0; 2]) }
    }
}
