//! Functions of WGSL with their numbers.

use super::lattice::{AxisWords, LATTICE_WORDS, Lattice, Positions};

/// A function of WGSL that computes one number per sample.
///
/// Its signature is `fn NAME(base: u32, place: Placement, a: f32, b: f32, ..) -> f32` with one number for each input of
/// the op. What it reads of `data` starts at `base`: its `words`, and then a block for each of its lattices. Parameters
/// are words, so the text depends on none of them.
#[derive(Debug, Clone, PartialEq)]
pub struct Shader {
    /// The name of the function.
    pub name: &'static str,
    /// The parts of the text that defines it, each of which other functions may have, too: the text of a kernel
    /// contains each once, in this order. [`PLACE`](super::lattice::PLACE) is always there.
    pub code: Vec<&'static str>,
    /// Its numbers.
    pub words: Vec<u32>,
    /// The lattices on which it needs the position of samples.
    pub lattices: Vec<Lattice>,
    /// A faster function of the same words, if there is one, for samples that are not displaced.
    pub undisplaced: Option<Undisplaced>,
}

/// A function for samples that are not displaced: its tables have the keys of the hash in place of cells, which are not
/// hashed for each sample.
#[derive(Debug, Clone, PartialEq)]
pub struct Undisplaced {
    /// The name of the function.
    pub name: &'static str,
    /// The last part of the text, in place of that of the other function.
    pub code: &'static str,
    /// The words of the hash on each lattice.
    pub hashes: Vec<AxisWords>,
}

impl Shader {
    /// A function without lattices.
    #[must_use]
    pub fn new(name: &'static str, code: &'static str, numbers: &[f32]) -> Shader {
        let words = numbers.iter().map(|number| number.to_bits()).collect();
        Shader { name, code: vec![code], words, lattices: Vec::new(), undisplaced: None }
    }

    /// With a lattice on which it needs the position of samples.
    #[must_use]
    pub fn on(mut self, lattice: Lattice) -> Shader {
        self.lattices.push(lattice);
        self
    }

    /// The function for samples that are displaced or not: its name, and the parts of its text.
    #[must_use]
    pub fn function(&self, is_displaced: bool) -> (&'static str, Vec<&'static str>) {
        match self.undisplaced.as_ref().filter(|_| !is_displaced) {
            Some(undisplaced) => {
                let others = self.code.iter().take(self.code.len().saturating_sub(1)).copied();
                (undisplaced.name, others.chain([undisplaced.code]).collect())
            }
            None => (self.name, self.code.clone()),
        }
    }

    /// Appends the numbers and the tables for samples at these positions, from which they may be displaced, to `data`;
    /// returns the `base`.
    pub fn encode(&self, positions: &Positions, is_displaced: bool, data: &mut Vec<u32>) -> u32 {
        let base = data.len();
        data.extend_from_slice(&self.words);
        let blocks = data.len();
        data.resize(blocks + LATTICE_WORDS * self.lattices.len(), 0);
        for (i, lattice) in self.lattices.iter().enumerate() {
            let hash = self.undisplaced.as_ref().filter(|_| !is_displaced).and_then(|function| function.hashes.get(i));
            let block = lattice.encode(positions, hash, data);
            data[blocks + LATTICE_WORDS * i..][..LATTICE_WORDS].copy_from_slice(&block);
        }
        base as u32
    }
}
