//! Phacelle noise as functions of WGSL.

use super::lattice::{Lattice, PLACE};
use super::noise::HASH;
use crate::phacelle::Phacelle;

/// The parts of a text that define `fn phacelle(words: u32, x: Cell, y: Cell, direction: vec2<f32>) -> vec2<f32>`:
/// cosine and sine of stripes along a direction, in the cell of [`Phacelle::shader_lattice`], with
/// [`Phacelle::shader_words`] at `words`.
pub const PHACELLE: [&str; 3] = [PLACE, HASH, include_str!("phacelle.wgsl")];

impl Phacelle {
    /// The words that the function reads; without the period.
    #[doc(hidden)]
    #[must_use]
    pub fn shader_words(&self) -> Vec<u32> {
        let prepared = self.prepare();
        let octaves = prepared.program().octaves();
        let mut words: Vec<u32> = octaves.iter().flat_map(|octave| octave.words[..2].concat()).collect();
        words.extend(prepared.wave().map(f32::to_bits));
        words
    }

    /// The lattice of its cells.
    #[doc(hidden)]
    #[must_use]
    pub fn shader_lattice(&self) -> Lattice {
        let prepared = self.prepare();
        let program = prepared.program();
        let frequency = program.octaves().first().map_or(0.0, |octave| octave.frequency);
        Lattice { limit: program.limit, ..Lattice::square(frequency, [0.0; 2]) }
    }
}
