//! Albedos of the ground, and wavelengths of its noise.

use orogen_io::palette::color::Light;

/// A dark and a light variant of a color.
pub(super) type Tones = [Light; 2];

/// Albedos of land in a temperate climate.
pub(super) const ROCK: Tones = [[0.070, 0.065, 0.061], [0.215, 0.195, 0.170]];
pub(super) const SCREE: Tones = [[0.155, 0.142, 0.125], [0.245, 0.227, 0.200]];
pub(super) const LUSH: Tones = [[0.070, 0.088, 0.034], [0.120, 0.122, 0.050]];
pub(super) const TUNDRA: Tones = [[0.135, 0.125, 0.060], [0.185, 0.160, 0.095]];
pub(super) const TREES: Tones = [[0.016, 0.028, 0.012], [0.034, 0.048, 0.020]];
pub(super) const FARMLAND: Tones = [[0.15, 0.16, 0.055], [0.22, 0.19, 0.085]];
pub(super) const GRAVEL: Light = [0.26, 0.245, 0.22];
pub(super) const SHORE: Light = [0.40, 0.345, 0.25];
pub(super) const SNOW: Light = [0.80, 0.83, 0.88];

/// Albedos of land with little vegetation.
pub(super) const BEDS: [Light; 6] = [
    [0.27, 0.105, 0.055],
    [0.33, 0.165, 0.088],
    [0.21, 0.072, 0.040],
    [0.37, 0.225, 0.130],
    [0.29, 0.130, 0.068],
    [0.42, 0.305, 0.200],
];
pub(super) const SAND: Tones = [[0.31, 0.175, 0.092], [0.37, 0.240, 0.140]];
pub(super) const SCRUB: Light = [0.125, 0.125, 0.062];

/// Albedo of the coloring `Clay`.
pub(super) const CLAY: Light = [0.30, 0.265, 0.235];

/// Albedo of the soil on top of a block's side.
pub(super) const SOIL: Light = [0.085, 0.060, 0.040];

/// Wavelengths in metres of the noises 0 to 3 of each climate.
pub(super) const NATURAL_WAVES: [f32; 4] = [1800.0, 420.0, 95.0, 24.0];
pub(super) const DESERT_WAVES: [f32; 4] = [1500.0, 300.0, 70.0, 18.0];

/// Maximum number of octaves of detail smaller than a cell.
pub(super) const OCTAVES: u8 = 8;
