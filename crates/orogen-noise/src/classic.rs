//! Perlin's noise over the permutation table of his 2002 reference.

use crate::program::{Program, Source};
use crate::seed;
use std::f32::consts::SQRT_2;

/// Which gradients a hash of [`Classic`] stands for in 2D. In 3D all variants are the 2002 reference: the twelve edges of a
/// cube, four of them twice.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Default)]
pub enum ClassicVariant {
    /// As most textbook ports have it: the low three bits pick +-x +-y, so there are four diagonals, each twice.
    #[default]
    Diagonal,
    /// The low three bits pick one of eight directions: four diagonals (1, 1) and four axes (1, 0).
    Eight,
    /// Unit vectors at 256 angles times sqrt 2, as the textbook versions for array languages have it.
    Angle,
}

/// Perlin's improved noise as published: a table of 256 entries, so it repeats every 256 cells.
///
/// For the look of the textbooks, and to check against them: with seed 0, wavelength 1 and depth, it is `ImprovedNoise.noise(x, y,
/// z)` of the reference. [`crate::Perlin`] is better noise and faster. The table holds no seed; other seeds move the
/// lattice by whole cells, so two seeds are two places of one endless noise.
///
/// Range: within [-1, 1] in 2D, both reached; within 1.03635 in 3D. Zero at every lattice point. Its gradient is exact.
///
/// K. Perlin, "Improving noise", SIGGRAPH 2002; reference code at <https://mrl.cs.nyu.edu/~perlin/noise/>.
///
/// ```
/// let noise = orogen_noise::Classic::default();
/// assert!((noise.sample3(3.14, 42.0, 7.0) - 0.13691995878400012).abs() < 1e-6);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Classic {
    /// 0 is the published noise; others move it. Default 0.
    pub seed: u64,
    /// Distance between lattice points, metres. Default 1.
    pub wavelength: f64,
    /// The gradients in 2D. Default [`ClassicVariant::Diagonal`].
    pub variant: ClassicVariant,
}

impl Default for Classic {
    fn default() -> Classic {
        Classic { seed: 0, wavelength: 1.0, variant: ClassicVariant::Diagonal }
    }
}

impl Classic {
    pub(crate) fn program(&self) -> Program {
        Program::single(Source::Classic(self.variant), self.seed, self.wavelength)
    }
    pub(crate) fn program3(&self) -> Program {
        self.program()
    }
}

crate::methods::noise_methods!(Classic);

/// The greatest size of the 3D reference: three ramps of equal sign meet best at (.3552566, .5185078, .5).
pub(crate) const BOUND_3D: f64 = 1.036_354;

/// By how many cells a seed moves the lattice, per axis.
pub(crate) fn words(seed: u64) -> [[u32; 2]; 3] {
    if seed == 0 { [[0; 2]; 3] } else { seed::lattice_words(seed).map(|[word, _]| [word & 255, 0]) }
}

pub(crate) const DIAGONAL_X: [f32; 8] = [1.0, -1.0, 1.0, -1.0, 1.0, 1.0, -1.0, -1.0];
pub(crate) const DIAGONAL_Y: [f32; 8] = [1.0, 1.0, -1.0, -1.0, 1.0, -1.0, 1.0, -1.0];
pub(crate) const EIGHT_X: [f32; 8] = [1.0, -1.0, 1.0, -1.0, 1.0, -1.0, 0.0, 0.0];
pub(crate) const EIGHT_Y: [f32; 8] = [1.0, 1.0, -1.0, -1.0, 0.0, 0.0, 1.0, -1.0];
pub(crate) const REFERENCE_X: [f32; 16] =
    [1.0, -1.0, 1.0, -1.0, 1.0, -1.0, 1.0, -1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, -1.0, 0.0];
pub(crate) const REFERENCE_Y: [f32; 16] =
    [1.0, 1.0, -1.0, -1.0, 0.0, 0.0, 0.0, 0.0, 1.0, -1.0, 1.0, -1.0, 1.0, -1.0, 1.0, -1.0];
pub(crate) const REFERENCE_Z: [f32; 16] =
    [0.0, 0.0, 0.0, 0.0, 1.0, 1.0, -1.0, -1.0, 1.0, 1.0, -1.0, -1.0, 0.0, 1.0, 0.0, -1.0];

/// The permutation of the 2002 reference.
#[rustfmt::skip]
pub(crate) static TABLE: [u32; 256] = [
    151, 160, 137, 91, 90, 15, 131, 13, 201, 95, 96, 53, 194, 233, 7, 225,
    140, 36, 103, 30, 69, 142, 8, 99, 37, 240, 21, 10, 23, 190, 6, 148,
    247, 120, 234, 75, 0, 26, 197, 62, 94, 252, 219, 203, 117, 35, 11, 32,
    57, 177, 33, 88, 237, 149, 56, 87, 174, 20, 125, 136, 171, 168, 68, 175,
    74, 165, 71, 134, 139, 48, 27, 166, 77, 146, 158, 231, 83, 111, 229, 122,
    60, 211, 133, 230, 220, 105, 92, 41, 55, 46, 245, 40, 244, 102, 143, 54,
    65, 25, 63, 161, 1, 216, 80, 73, 209, 76, 132, 187, 208, 89, 18, 169,
    200, 196, 135, 130, 116, 188, 159, 86, 164, 100, 109, 198, 173, 186, 3, 64,
    52, 217, 226, 250, 124, 123, 5, 202, 38, 147, 118, 126, 255, 82, 85, 212,
    207, 206, 59, 227, 47, 16, 58, 17, 182, 189, 28, 42, 223, 183, 170, 213,
    119, 248, 152, 2, 44, 154, 163, 70, 221, 153, 101, 155, 167, 43, 172, 9,
    129, 22, 39, 253, 19, 98, 108, 110, 79, 113, 224, 232, 178, 185, 112, 104,
    218, 246, 97, 228, 251, 34, 242, 193, 238, 210, 144, 12, 191, 179, 162, 241,
    81, 51, 145, 235, 249, 14, 239, 107, 49, 192, 214, 31, 181, 199, 106, 157,
    184, 84, 204, 176, 115, 121, 50, 45, 127, 4, 150, 254, 138, 236, 205, 93,
    222, 114, 67, 29, 24, 72, 243, 141, 128, 195, 78, 66, 215, 61, 156, 180,
];

/// sqrt 2 times the sine of 256 angles; the cosine stands 64 places on.
#[rustfmt::skip]
pub(crate) static SINE: [f32; 256] = [
    0.0, 0.034706537, 0.06939217, 0.104036, 0.13861717, 0.17311484, 0.20750822, 0.24177662,
    0.27589938, 0.30985594, 0.34362587, 0.3771888, 0.41052452, 0.44361296, 0.4764342, 0.5089684,
    0.5411961, 0.57309777, 0.6046542, 0.63584644, 0.66665566, 0.6970633, 0.7270511, 0.7566009,
    0.78569496, 0.81431574, 0.842446, 0.87006885, 0.89716756, 0.9237259, 0.9497278, 0.9751576,
    1.0, 1.02424, 1.0478631, 1.070855, 1.0932019, 1.1148902, 1.1359069, 1.1562395,
    1.1758755, 1.1948034, 1.2130114, 1.2304888, 1.247225, 1.2632099, 1.2784339, 1.2928878,
    1.306563, 1.3194511, 1.3315444, 1.3428357, 1.353318, 1.3629851, 1.3718313, 1.3798512,
    1.3870399, 1.393393, 1.3989068, 1.403578, 1.4074037, 1.4103817, 1.41251, 1.4137876,
    SQRT_2, 1.4137876, 1.41251, 1.4103817, 1.4074037, 1.403578, 1.3989068, 1.393393,
    1.3870399, 1.3798512, 1.3718313, 1.3629851, 1.353318, 1.3428357, 1.3315444, 1.3194511,
    1.306563, 1.2928878, 1.2784339, 1.2632099, 1.247225, 1.2304888, 1.2130114, 1.1948034,
    1.1758755, 1.1562395, 1.1359069, 1.1148902, 1.0932019, 1.070855, 1.0478631, 1.02424,
    1.0, 0.9751576, 0.9497278, 0.9237259, 0.89716756, 0.87006885, 0.842446, 0.81431574,
    0.78569496, 0.7566009, 0.7270511, 0.6970633, 0.66665566, 0.63584644, 0.6046542, 0.57309777,
    0.5411961, 0.5089684, 0.4764342, 0.44361296, 0.41052452, 0.3771888, 0.34362587, 0.30985594,
    0.27589938, 0.24177662, 0.20750822, 0.17311484, 0.13861717, 0.104036, 0.06939217, 0.034706537,
    0.0, -0.034706537, -0.06939217, -0.104036, -0.13861717, -0.17311484, -0.20750822, -0.24177662,
    -0.27589938, -0.30985594, -0.34362587, -0.3771888, -0.41052452, -0.44361296, -0.4764342, -0.5089684,
    -0.5411961, -0.57309777, -0.6046542, -0.63584644, -0.66665566, -0.6970633, -0.7270511, -0.7566009,
    -0.78569496, -0.81431574, -0.842446, -0.87006885, -0.89716756, -0.9237259, -0.9497278, -0.9751576,
    -1.0, -1.02424, -1.0478631, -1.070855, -1.0932019, -1.1148902, -1.1359069, -1.1562395,
    -1.1758755, -1.1948034, -1.2130114, -1.2304888, -1.247225, -1.2632099, -1.2784339, -1.2928878,
    -1.306563, -1.3194511, -1.3315444, -1.3428357, -1.353318, -1.3629851, -1.3718313, -1.3798512,
    -1.3870399, -1.393393, -1.3989068, -1.403578, -1.4074037, -1.4103817, -1.41251, -1.4137876,
    -SQRT_2, -1.4137876, -1.41251, -1.4103817, -1.4074037, -1.403578, -1.3989068, -1.393393,
    -1.3870399, -1.3798512, -1.3718313, -1.3629851, -1.353318, -1.3428357, -1.3315444, -1.3194511,
    -1.306563, -1.2928878, -1.2784339, -1.2632099, -1.247225, -1.2304888, -1.2130114, -1.1948034,
    -1.1758755, -1.1562395, -1.1359069, -1.1148902, -1.0932019, -1.070855, -1.0478631, -1.02424,
    -1.0, -0.9751576, -0.9497278, -0.9237259, -0.89716756, -0.87006885, -0.842446, -0.81431574,
    -0.78569496, -0.7566009, -0.7270511, -0.6970633, -0.66665566, -0.63584644, -0.6046542, -0.57309777,
    -0.5411961, -0.5089684, -0.4764342, -0.44361296, -0.41052452, -0.3771888, -0.34362587, -0.30985594,
    -0.27589938, -0.24177662, -0.20750822, -0.17311484, -0.13861717, -0.104036, -0.06939217, -0.034706537,
];
