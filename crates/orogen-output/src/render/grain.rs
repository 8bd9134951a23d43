//! Detail smaller than a cell: a tile of noise for the grain of rock, grass and water.

use orogen_noise::{Perlin, Points};

/// Side of the tile in samples; a power of two.
pub(super) const SIDE: usize = 256;

/// Wavelength of the tile's noise in samples.
const WAVELENGTH: usize = 8;

/// Cosine and sine of 37 degrees times 0, 1, 2, ...
const TURNS: [[f64; 2]; 8] = [
    [1.0, 0.0],
    [0.798_635_5, 0.601_815],
    [0.275_637_4, 0.961_261_7],
    [-0.358_368, 0.933_580_4],
    [-0.848_048_1, 0.529_919_3],
    [-0.996_194_7, -0.087_155_7],
    [-0.743_144_8, -0.669_130_6],
    [-0.190_809, -0.981_627_2],
];

/// Shift of a noise for each kind, in wavelengths, so that kinds of one angle differ.
const SHIFT: f64 = 7.31;

/// A tile of periodic Perlin noise with its derivatives.
#[derive(Debug, Clone)]
pub(super) struct Grain {
    /// Value, and derivatives east and south per wavelength.
    pub samples: Vec<[f32; 3]>,
}

/// A value between -1 and 1, and its derivatives east and south per wavelength.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Bump {
    pub value: f32,
    pub slope: [f32; 2],
}

impl Grain {
    /// Computes the tile.
    pub fn new() -> Grain {
        let noise = Perlin::new(5, WAVELENGTH as f64);
        let axis: Vec<f64> = (0..SIDE).map(|i| i as f64).collect();
        let mut parts = [vec![0.0; SIDE * SIDE], vec![0.0; SIDE * SIDE], vec![0.0; SIDE * SIDE]];
        if let Ok(tiled) = noise.tiled([(SIDE / WAVELENGTH) as u32; 2]) {
            let [value, dx, dy] = &mut parts;
            // The lengths agree, so this cannot fail.
            let _ = tiled.fill_with_gradient(&Points::Lattice { xs: &axis, ys: &axis }, value, dx, dy);
        }
        let [value, dx, dy] = parts;
        let scale = WAVELENGTH as f32;
        let samples = value.iter().zip(dx.iter().zip(&dy)).map(|(v, (dx, dy))| [*v, dx * scale, dy * scale]).collect();
        Grain { samples }
    }

    /// The noise at a position in units of its wavelength. `kind` selects one of several independent noises; each is
    /// rotated by a different angle, which hides the repetition of the tile.
    pub fn at(&self, x: f64, y: f64, kind: u32) -> Bump {
        let [cos, sin] = TURNS[(kind & 7) as usize];
        let shift = f64::from(kind) * SHIFT;
        let scale = WAVELENGTH as f64;
        let (u, v) = ((x * cos - y * sin + shift) * scale, (x * sin + y * cos - shift) * scale);
        let (i, j) = (whole(u), whole(v));
        let (s, t) = ((u - i as f64) as f32, (v - j as f64) as f32);
        let side = SIDE as i64 - 1;
        let sample = |i: i64, j: i64| self.samples[((j & side) as usize) * SIDE + (i & side) as usize];
        let (nw, ne, sw, se) = (sample(i, j), sample(i + 1, j), sample(i, j + 1), sample(i + 1, j + 1));
        let [value, du, dv] = [0, 1, 2].map(|k| {
            let north = nw[k] + (ne[k] - nw[k]) * s;
            north + (sw[k] + (se[k] - sw[k]) * s - north) * t
        });
        let (cos, sin) = (cos as f32, sin as f32);
        Bump { value, slope: [du * cos + dv * sin, dv * cos - du * sin] }
    }
}

/// A noise of [`Grain`] as an affine map from positions to the tile: (u, v) = matrix (x, y) + offset, in samples.
///
/// The offset refers to an origin near the camera and is reduced by whole tiles, so that single precision suffices.
#[derive(Debug, Clone, Copy)]
pub(super) struct GrainMap {
    pub matrix: [[f64; 2]; 2],
    pub offset: [f64; 2],
    /// Cosine and sine of the noise's angle.
    pub turn: [f64; 2],
}

impl GrainMap {
    /// The noise `kind` at `(x * scale[0], y * scale[1])`, for positions relative to `origin`.
    pub fn new(kind: u32, scale: [f64; 2], origin: [f64; 2]) -> GrainMap {
        let [cos, sin] = TURNS[(kind & 7) as usize];
        let matrix = [[cos * scale[0], -sin * scale[1]], [sin * scale[0], cos * scale[1]]]
            .map(|row| row.map(|part| part * WAVELENGTH as f64));
        let shift = f64::from(kind) * SHIFT * WAVELENGTH as f64;
        let offset = [0, 1].map(|k| {
            let at = matrix[k][0] * origin[0] + matrix[k][1] * origin[1] + [shift, -shift][k];
            at.rem_euclid(SIDE as f64)
        });
        GrainMap { matrix, offset, turn: [cos, sin] }
    }
}

/// The floor of a number. (`floor` is a function call on machines without an instruction for it.)
fn whole(x: f64) -> i64 {
    let cut = x as i64;
    cut - i64::from(x < cut as f64)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn slopes_are_those_of_the_values() {
        let grain = Grain::new();
        for k in 0..200u32 {
            let (x, y) = (f64::from(k) * 1.37 - 90.0, f64::from(k * k % 173) * 0.77);
            let step = 0.125;
            let at = |dx: f64, dy: f64| grain.at(x + dx, y + dy, k).value;
            let bump = grain.at(x, y, k);
            let slope = [(at(step, 0.0) - at(-step, 0.0)) / 0.25, (at(0.0, step) - at(0.0, -step)) / 0.25];
            assert!(bump.slope.iter().zip(slope).all(|(a, b)| (a - b).abs() < 0.5), "{k}: {bump:?} {slope:?}");
        }
    }

    #[test]
    fn it_varies_and_repeats_only_after_many_wavelengths() {
        let grain = Grain::new();
        let values: Vec<f32> = (0..1000).map(|i| grain.at(f64::from(i) * 0.173, 0.4, 0).value).collect();
        let most = values.iter().copied().fold(0.0f32, |most, v| most.max(v.abs()));
        assert!(most > 0.5 && most <= 1.2, "{most}");
        let period = (SIDE / WAVELENGTH) as f64;
        assert!((grain.at(3.3, 1.2, 0).value - grain.at(3.3 + period, 1.2, 0).value).abs() < 1e-5);
        assert_eq!([-1.5, -1.0, -0.0, 0.9, 7.0].map(whole), [-2, -1, 0, 0, 7]);
    }
}
