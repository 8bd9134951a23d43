//! The noises that fields are made of, as a choice in recipes.

use crate::declare::{Param, Shape};
use crate::value::Value;
use orogen_noise::{Basis, LengthMismatch};

impl Param for Basis {
    const SHAPE: Shape = Shape::Choice(|| Basis::all().iter().map(|basis| (basis.name(), about(*basis))).collect());

    fn read(value: &Value) -> Option<Basis> {
        match value {
            Value::Text(name) => Basis::from_name(name),
            _ => None,
        }
    }

    fn write(&self) -> Value {
        Value::Text(self.name().to_string())
    }
}

fn about(basis: Basis) -> &'static str {
    match basis {
        Basis::White => "An independent value per square.",
        Basis::Value => "Random values on a lattice, blended.",
        Basis::Perlin => "Perlin's gradient noise over a hashed lattice: never repeats.",
        Basis::ClassicDiagonal => "Perlin's 2002 table, four diagonal gradients, as most textbooks have it.",
        Basis::ClassicEight => "Perlin's 2002 table, eight gradients.",
        Basis::ClassicAngle => "Perlin's 2002 table, unit gradients at 256 angles.",
        Basis::Simplex => "Perlin's Simplex noise: gradients on the corners of triangles.",
        Basis::OpenSimplex2 => "OpenSimplex2, fast: Simplex noise with more directions.",
        Basis::OpenSimplex2Smooth => "OpenSimplex2, smooth: wider, rounder kernels.",
        Basis::Worley => "Worley's cellular noise: the distance to the nearest point.",
        Basis::WorleyEdge => "Worley's cellular noise: the distance to the nearest edge of a cell.",
    }
}

/// A block of noise. The engine's blocks always have the length of their points; were one ever wrong, it would be NaN and
/// seen, not the noise of another place.
pub(super) fn fill(out: &mut [f32], noise: impl FnOnce(&mut [f32]) -> Result<(), LengthMismatch>) {
    if noise(out).is_err() {
        out.fill(f32::NAN);
    }
}

/// How many nanoseconds a sample takes.
#[derive(Debug, Clone, Copy)]
pub(super) struct Cost {
    /// Anywhere.
    pub anywhere: f64,
    /// Where samples stand in columns and rows.
    pub in_rows: f64,
}

impl Cost {
    /// Of so many octaves.
    pub(super) fn octaves(self, octaves: u32) -> Cost {
        let octaves = f64::from(octaves);
        Cost { anywhere: octaves * self.anywhere, in_rows: octaves * self.in_rows }
    }

    /// Of octaves that move those after them: then a row is no row any more. What they are moved by takes its time, too.
    pub(super) fn moved(self) -> Cost {
        let each = self.anywhere + 1.1;
        Cost { anywhere: each, in_rows: each }
    }
}

/// What an octave over a basis takes, measured like the figures of `plan/cost.rs`: 512 x 512 samples, wavelength 100 samples,
/// 6 octaves.
pub(super) fn cost(basis: Basis) -> Cost {
    let (anywhere, in_rows) = match basis {
        Basis::White => (0.4, 0.06),
        Basis::Value => (0.8, 0.1),
        Basis::Perlin => (1.0, 0.15),
        Basis::ClassicDiagonal | Basis::ClassicEight => (2.2, 0.15),
        Basis::ClassicAngle => (5.0, 0.15),
        Basis::Simplex => (1.8, 0.9),
        Basis::OpenSimplex2 => (2.0, 1.0),
        Basis::OpenSimplex2Smooth => (2.5, 2.5),
        Basis::Worley => (2.7, 2.7),
        Basis::WorleyEdge => (7.2, 7.2),
    };
    Cost { anywhere, in_rows }
}
