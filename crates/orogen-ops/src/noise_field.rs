//! Fields that are noises, for the `noise` block of `op!`.

use crate::lower::Lowering;
use crate::op::Evaluator;
use orogen_grid::error::{Error, ErrorKind, Result};
use orogen_noise::shader::function::Shader;
use orogen_noise::{Basis, Depth, Kind, LengthMismatch, PreparedIn};

/// The computation of a noise on a graphics card.
pub type Lowered = Lowering<Shader>;

/// Number of dimensions of a noise: 2 if `vertical`, its wavelength along the altitude, is 0, otherwise 3.
#[must_use]
pub fn dimensions(vertical: f64) -> usize {
    if vertical > 0.0 { 3 } else { 2 }
}

/// A noise of the plane or of space.
pub struct NoiseField {
    noise: PreparedIn,
    vertical: f64,
}

impl NoiseField {
    /// A noise with the [`dimensions`] for `vertical`.
    #[must_use]
    pub fn new(noise: PreparedIn, vertical: f64) -> NoiseField {
        NoiseField { noise, vertical }
    }

    /// The noise as a field.
    #[must_use]
    pub fn evaluator(self) -> Evaluator {
        let NoiseField { noise, vertical } = self;
        Box::new(move |at, inputs, out| {
            let depth = (vertical > 0.0).then(|| Depth::Slice(inputs.altitude() / vertical));
            checked(noise.fill(at, depth.as_slice(), out))
        })
    }

    /// The computation on graphics cards.
    #[must_use]
    pub fn lower(&self) -> Lowered {
        if self.vertical > 0.0 {
            return Lowering::Processor("noise of space is not computed on graphics cards");
        }
        Lowering::Shader(self.noise.shader())
    }
}

/// Converts the result of a noise. It fails only if the lengths differ, which is a bug: blocks always have the length
/// of their points.
pub(crate) fn checked(filled: std::result::Result<(), LengthMismatch>) -> Result<()> {
    filled.map_err(|mismatch| Error::new(ErrorKind::Internal, mismatch.to_string()))
}

/// Nanoseconds per sample of a fractal, at arbitrary positions and on a lattice of columns and rows.
#[must_use]
pub fn fractal_cost(basis: Basis, kind: Kind, octaves: u32) -> [f64; 2] {
    let [anywhere, in_rows] = basis.cost();
    let octave = match kind {
        // Earlier octaves displace the positions of later ones, which takes time, and rows share no work.
        Kind::Swiss { .. } | Kind::Jordan { .. } => [anywhere + 1.1; 2],
        _ => [anywhere, in_rows],
    };
    octave.map(|cost| f64::from(octaves) * cost)
}
