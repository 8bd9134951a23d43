//! The noises that fields are made of, as a choice in recipes.

use crate::declare::{Param, Shape};
use crate::value::Value;
use orogen_noise::{Basis, Mismatch};

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
pub(super) fn fill(out: &mut [f32], noise: impl FnOnce(&mut [f32]) -> Result<(), Mismatch>) {
    if noise(out).is_err() {
        out.fill(f32::NAN);
    }
}
