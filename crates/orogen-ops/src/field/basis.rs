//! Noise bases of fractals, as a choice in recipes.

use crate::declare::{Param, Shape};
use crate::lower::Lowering;
use crate::value::Value;
use orogen_noise::shader::function::Shader;
use orogen_noise::{
    Basis, Classic, Depth, Fractal, LengthMismatch, OpenSimplex2, Perlin, Points, Simplex, Value as ValueNoise, White,
    Worley,
};

impl Param for Basis {
    const SHAPE: Shape = Shape::Choice(|| Basis::all().iter().map(|basis| (basis.name(), basis.about())).collect());

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

/// A block of noise. The engine's blocks always have the length of their points. If a length were wrong, the block
/// would be NaN, so that the error is visible.
pub(super) fn fill(out: &mut [f32], noise: impl FnOnce(&mut [f32]) -> Result<(), LengthMismatch>) {
    if noise(out).is_err() {
        out.fill(f32::NAN);
    }
}

/// A noise of the plane and of space.
pub(super) trait Noise {
    /// The values at points of the plane.
    fn in_plane(&self, at: &Points, out: &mut [f32]) -> Result<(), LengthMismatch>;
    /// The values at points that have the same third coordinate, in metres.
    fn in_space(&self, at: &Points, depth: f64, out: &mut [f32]) -> Result<(), LengthMismatch>;
    /// The noise of the plane as a function for graphics cards.
    fn shader(&self) -> Shader;
}

macro_rules! noises {
    ($($noise:ident),*) => { $(
        impl Noise for $noise {
            fn in_plane(&self, at: &Points, out: &mut [f32]) -> Result<(), LengthMismatch> {
                self.fill(at, out)
            }

            fn in_space(&self, at: &Points, depth: f64, out: &mut [f32]) -> Result<(), LengthMismatch> {
                self.fill3(at, &Depth::Slice(depth), out)
            }

            fn shader(&self) -> Shader {
                self.shader()
            }
        }
    )* };
}
noises!(Classic, Fractal, OpenSimplex2, Perlin, Simplex, ValueNoise, White, Worley);

/// A block of a noise: of the plane, or with a third coordinate of space.
pub(super) fn sample(noise: &impl Noise, at: &Points, depth: Option<f64>, out: &mut [f32]) {
    fill(out, |out| match depth {
        Some(depth) => noise.in_space(at, depth, out),
        None => noise.in_plane(at, out),
    });
}

/// How graphics cards compute a noise: of the plane if `vertical`, its wavelength along the altitude, is 0.
pub(super) fn lower(noise: &impl Noise, vertical: f64) -> Lowering<Shader> {
    if vertical > 0.0 {
        return Lowering::Processor("noise of space is not computed on graphics cards");
    }
    Lowering::Shader(noise.shader())
}

/// Nanoseconds per sample.
#[derive(Debug, Clone, Copy)]
pub(super) struct Cost {
    /// At arbitrary positions.
    pub anywhere: f64,
    /// On a lattice of columns and rows.
    pub in_rows: f64,
}

impl Cost {
    /// With this number of octaves.
    pub(super) fn octaves(self, octaves: u32) -> Cost {
        let octaves = f64::from(octaves);
        Cost { anywhere: octaves * self.anywhere, in_rows: octaves * self.in_rows }
    }

    /// With octaves whose positions are displaced by earlier octaves, so that rows share nothing. The displacement
    /// costs time, too.
    pub(super) fn moved(self) -> Cost {
        let each = self.anywhere + 1.1;
        Cost { anywhere: each, in_rows: each }
    }
}

/// Cost of one octave of a basis.
pub(super) fn cost(basis: Basis) -> Cost {
    let [anywhere, in_rows] = basis.cost();
    Cost { anywhere, in_rows }
}
