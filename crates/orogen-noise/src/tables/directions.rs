//! The gradients of hashed Perlin noise, scaled so that the maximum absolute value of the noise is 1.

/// 1 / .695352704, which scales the 2D maximum to 1. It is a millionth less, so that rounding cannot exceed 1.
const SCALE_2D: f64 = 1.438_117_6;
/// sqrt(4/3), a millionth less.
const SCALE_3D: f64 = 1.154_699_3;

/// 1 / 1.536582335, a millionth less.
const SCALE_4D: f64 = 0.650_793_8;

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
pub const X_2D: [f32; 8] = scaled([C1, C3, S3, S1, -S1, -S3, -C3, -C1], SCALE_2D);
/// y of these directions.
pub const Y_2D: [f32; 8] = scaled([S1, S3, C3, C1, C1, C3, S3, S1], SCALE_2D);

// A corner of the icosahedron is (0, A, B) in a cyclic order and with any signs. A face center is (D, D, D) or (0, E,
// F).
const A: f64 = 0.525_731_112_119_133_6;
const B: f64 = 0.850_650_808_352_040;
const D: f64 = 0.577_350_269_189_625_8;
const E: f64 = 0.356_822_089_773_089_93;
const F: f64 = 0.934_172_358_962_715_8;

/// x of sixteen directions, one of each pair of opposites: six corners and ten face centers of an icosahedron.
pub const X_3D: [f32; 16] = scaled([0.0, 0.0, A, A, B, -B, D, D, D, -D, 0.0, 0.0, E, E, F, -F], SCALE_3D);
/// y of these directions.
pub const Y_3D: [f32; 16] = scaled([A, A, B, -B, 0.0, 0.0, D, D, -D, D, E, E, F, -F, 0.0, 0.0], SCALE_3D);
/// z of these directions.
pub const Z_3D: [f32; 16] = scaled([B, -B, 0.0, 0.0, A, A, D, -D, D, D, F, -F, 0.0, 0.0, E, E], SCALE_3D);

/// x of sixteen directions, one of each pair of opposites: the centers of the 32 edges of a tesseract.
pub const X_4D: [f32; 16] =
    scaled([1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 0.0, 0.0, 0.0, 0.0], SCALE_4D);
/// y of these directions.
pub const Y_4D: [f32; 16] =
    scaled([1.0, 1.0, -1.0, -1.0, 1.0, 1.0, -1.0, -1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 1.0, 1.0, 1.0], SCALE_4D);
/// z of these directions.
pub const Z_4D: [f32; 16] =
    scaled([1.0, -1.0, 1.0, -1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 1.0, -1.0, -1.0, 1.0, 1.0, -1.0, -1.0], SCALE_4D);
/// w of these directions.
pub const W_4D: [f32; 16] =
    scaled([0.0, 0.0, 0.0, 0.0, 1.0, -1.0, 1.0, -1.0, 1.0, -1.0, 1.0, -1.0, 1.0, -1.0, 1.0, -1.0], SCALE_4D);

/// x of twelve directions of the upper half plane, counter-clockwise from 7.5 degrees; four entries are not used.
#[rustfmt::skip]
pub(crate) const OPEN_X_2D: [f32; 16] = scaled([
    0.9914448613738104, 0.9238795325112867, 0.7933533402912352, 0.6087614290087207, 0.38268343236508984, 0.1305261922200517,
    -0.1305261922200516, -0.3826834323650895, -0.6087614290087207, -0.793353340291235, -0.9238795325112867, -0.9914448613738104,
    0.0, 0.0, 0.0, 0.0,
], 1.0);
/// y of these directions.
#[rustfmt::skip]
pub(crate) const OPEN_Y_2D: [f32; 16] = scaled([
    0.13052619222005157, 0.3826834323650898, 0.6087614290087207, 0.7933533402912352, 0.9238795325112867, 0.9914448613738104,
    0.9914448613738104, 0.9238795325112868, 0.7933533402912352, 0.6087614290087209, 0.3826834323650899, 0.130526192220052,
    0.0, 0.0, 0.0, 0.0,
], 1.0);

// The 48 directions of OpenSimplex2 in space, a rounded cuboctahedron: (P, P, O) and (Q, R, 0) in every order, with
// every sign. The first kind has eight signs for each order and is listed twice here, the second has four.
const P: f64 = 0.673887338679005;
const O: f64 = 0.3029054465278827;
const Q: f64 = 0.9348469228350482;
const R: f64 = 0.3550510257214325;

/// x of these directions without their signs; four entries are not used.
pub const OPEN_X_3D: [f32; 16] = scaled([O, O, P, P, P, P, Q, Q, R, 0.0, R, 0.0, 0.0, 0.0, 0.0, 0.0], 1.0);
/// y of these directions without their signs.
pub const OPEN_Y_3D: [f32; 16] = scaled([P, P, O, O, P, P, R, 0.0, Q, Q, 0.0, R, 0.0, 0.0, 0.0, 0.0], 1.0);
/// z of these directions without their signs.
pub const OPEN_Z_3D: [f32; 16] = scaled([P, P, P, P, O, O, 0.0, R, 0.0, R, Q, Q, 0.0, 0.0, 0.0, 0.0], 1.0);
