//! The gradients of hashed Perlin noise, scaled so that the noise's greatest size is 1.

/// 1 / .695352704: what brings the 2D maximum to 1, a millionth less so that rounding cannot pass it.
const SCALE_2D: f64 = 1.438_117_6;
/// sqrt(4/3), a millionth less.
const SCALE_3D: f64 = 1.154_699_3;

const C1: f64 = 0.980_785_280_403_230_4;
const S1: f64 = 0.195_090_322_016_128_27;
const C3: f64 = 0.831_469_612_302_545_2;
const S3: f64 = 0.555_570_233_019_602_2;

const fn scaled<const N: usize>(from: [f64; N], factor: f64) -> [f32; N] {
    let mut to = [0.0; N];
    let mut i = 0;
    while i < N {
        to[i] = (from[i] * factor) as f32;
        i += 1;
    }
    to
}

/// x of the eight directions of the upper half plane, counter-clockwise from 11.25 degrees.
pub(crate) const X_2D: [f32; 8] = scaled([C1, C3, S3, S1, -S1, -S3, -C3, -C1], SCALE_2D);
/// Their y.
pub(crate) const Y_2D: [f32; 8] = scaled([S1, S3, C3, C1, C1, C3, S3, S1], SCALE_2D);

// A corner of the icosahedron is (0, A, B) in some cyclic order and up to signs; a face centre (D, D, D) or (0, E, F).
const A: f64 = 0.525_731_112_119_133_6;
const B: f64 = 0.850_650_808_352_040;
const D: f64 = 0.577_350_269_189_625_8;
const E: f64 = 0.356_822_089_773_089_93;
const F: f64 = 0.934_172_358_962_715_8;

/// x of sixteen directions, one of each pair of opposites: six corners and ten face centres of an icosahedron.
pub(crate) const X_3D: [f32; 16] = scaled([0.0, 0.0, A, A, B, -B, D, D, D, -D, 0.0, 0.0, E, E, F, -F], SCALE_3D);
/// Their y.
pub(crate) const Y_3D: [f32; 16] = scaled([A, A, B, -B, 0.0, 0.0, D, D, -D, D, E, E, F, -F, 0.0, 0.0], SCALE_3D);
/// Their z.
pub(crate) const Z_3D: [f32; 16] = scaled([B, -B, 0.0, 0.0, A, A, D, -D, D, D, F, -F, 0.0, 0.0, E, E], SCALE_3D);
