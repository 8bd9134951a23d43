//! WGSL functions and the numbers that they read.

use super::lattice::{AxisWords, LATTICE_WORDS, Lattice, Positions};

/// A WGSL function that computes one number per sample.
///
/// Its signature is `fn NAME(base: u32, place: Placement, a: f32, b: f32, ..) -> f32`, with one number for each input
/// of the op. The function reads `data` from `base` on: its `words`, and then a block for each of its lattices.
/// Parameters are words, so the text does not depend on them.
#[derive(Debug, Clone, PartialEq)]
pub struct Shader {
    /// The name of the function.
    pub name: &'static str,
    /// The parts of the text that defines it. Functions can have parts in common; the text of a kernel contains each
    /// part once, in this order. [`PLACE`](super::lattice::PLACE) is always included.
    pub code: Vec<&'static str>,
    /// The numbers that the function reads.
    pub words: Vec<u32>,
    /// The lattices on which the function needs the position of samples.
    pub lattices: Vec<Lattice>,
    /// A faster function with the same words, for samples that are not displaced; `None` if there is none.
    pub undisplaced: Option<Undisplaced>,
}

/// A function for samples that are not displaced. Its tables contain the keys of the hash instead of cells, so that
/// cells are not hashed for each sample.
#[derive(Debug, Clone, PartialEq)]
pub struct Undisplaced {
    /// The name of the function.
    pub name: &'static str,
    /// The last part of the text, which replaces the last part of the other function.
    pub code: &'static str,
    /// The words of the hash for each lattice.
    pub hashes: Vec<AxisWords>,
}

impl Shader {
    /// A function without lattices.
    #[must_use]
    pub fn new(name: &'static str, code: &'static str, numbers: &[f32]) -> Shader {
        let words = numbers.iter().map(|number| number.to_bits()).collect();
        Shader { name, code: vec![code], words, lattices: Vec::new(), undisplaced: None }
    }

    /// Adds a lattice on which the function needs the position of samples.
    #[must_use]
    pub fn on(mut self, lattice: Lattice) -> Shader {
        self.lattices.push(lattice);
        self
    }

    /// The name of the function for displaced or undisplaced samples, and the parts of its text.
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

    /// Appends the words and the tables for samples at these positions to `data`. Returns the `base`. `is_displaced`
    /// states whether samples may be displaced from the positions.
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
