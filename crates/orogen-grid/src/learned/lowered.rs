//! The parameters of a network and of a level for shaders.

use super::convolution::{LEAK, TAPS};
use super::features::{LEVEL, PASSES};
use super::network::{Draw, Network};
use super::weights::{FEATURES, NOISES, PHASES};
use crate::multiscale::hash;

/// The parameters of a level, with their names in shaders.
#[derive(Debug, Clone, PartialEq)]
pub struct Words {
    /// The start values of the hashes of the noise.
    pub hashes: [(&'static str, u64); NOISES],
    /// Numeric parameters.
    pub numbers: [(&'static str, f32); 6],
}

impl Network {
    /// Number of passes of the filter before the first layer, and number of layers.
    #[must_use]
    pub fn passes(&self) -> [usize; 2] {
        [PASSES, self.weights.layers.len()]
    }

    /// The sizes on which the text of shaders depends, with their names there.
    #[must_use]
    pub fn sizes(&self) -> [(&'static str, u32); 5] {
        let channels = self.weights.channels;
        // Weights of the first layer, and of each other one.
        let [first, other] = [FEATURES + NOISES, channels].map(|inputs| (TAPS * inputs + 1) * channels);
        [
            ("INPUTS", FEATURES + NOISES),
            ("CHANNELS", channels),
            ("LAYERS", self.weights.layers.len()),
            ("FIRST_WEIGHTS", first),
            ("WEIGHTS", other),
        ]
        .map(|(name, size)| (name, size as u32))
    }

    /// The bits of all weights: those of each layer by tap, input and output, and its offsets; then those from each
    /// channel to the fine samples, and their offsets.
    pub fn weights(&self) -> impl Iterator<Item = u32> {
        let layers = self.weights.layers.iter().flat_map(|layer| layer.weights.iter().chain(&layer.offsets));
        let phases: &[[f32; PHASES]] = &self.weights.phases;
        layers.chain(phases.iter().flatten()).chain(&self.weights.offsets).map(|weight| weight.to_bits())
    }

    /// The parameters of a draw from coarse heights with this cell.
    #[must_use]
    pub fn words(&self, cell: f64, draw: &Draw) -> Words {
        let start = |plane| hash::start(draw.seed, draw.level, plane);
        let hashes = ["first_noise", "second_noise", "third_noise", "fourth_noise"];
        Words {
            hashes: std::array::from_fn(|plane| (hashes[plane], start(plane as u64))),
            numbers: [
                ("cell", cell as f32),
                ("per_cell", (1.0 / cell) as f32),
                ("octave", self.octave(cell)),
                ("noise", draw.noise),
                ("level_square", LEVEL),
                ("leak", LEAK),
            ],
        }
    }
}
