//! The light of a picture: the sun, the sky, and the exposure.

use super::sky::{SUN_RADIUS, Sky};
use orogen_io::palette::color::Light;
use serde::{Deserialize, Serialize};

/// The light of a picture, wherever its land is.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct Lighting {
    pub(super) sky: Sky,
    /// The horizontal direction to the sun, and the tangents of the elevations of its lower and upper limb.
    pub(super) sunwards: [f64; 2],
    pub(super) rims: [f64; 2],
    /// The light of the sun and of the whole sky on level ground.
    pub(super) level_sun: Light,
    pub(super) level_sky: Light,
    /// Factor from light to exposure.
    pub(super) exposure: Light,
}

impl Lighting {
    /// A clear day with the sun at an azimuth, clockwise from north, and an elevation, in degrees.
    #[must_use]
    pub fn new([azimuth, elevation]: [f64; 2]) -> Lighting {
        // At the zenith, the two limbs would coincide.
        let rims = [-SUN_RADIUS, SUN_RADIUS].map(|off| libm::tan((elevation.min(88.0) + off).to_radians()));
        Lighting::of(Sky::new(azimuth, elevation), rims)
    }

    /// The same day with the sun at another azimuth. This is much faster than [`Lighting::new`].
    #[must_use]
    pub fn turned(&self, azimuth: f64) -> Lighting {
        Lighting::of(self.sky.turned(azimuth), self.rims)
    }

    fn of(sky: Sky, rims: [f64; 2]) -> Lighting {
        let sunwards = sky.ahead;
        let level_sun = sky.sunlight().map(|c| c * sky.sun().z.max(0.0) as f32);
        let level_sky = sky.dome();
        let exposure = exposure(&sky, level_sky);
        Lighting { sky, sunwards, rims, level_sun, level_sky, exposure }
    }
}

/// The exposure: factors that light is multiplied by before tone mapping. Sunlit, slightly inclined ground is exposed
/// correctly, and the color of the light is partly compensated (white balance).
fn exposure(sky: &Sky, level_sky: Light) -> Light {
    let facing = (sky.sun().z.max(0.0) as f32).max(0.45);
    let light: Light = std::array::from_fn(|c| sky.sunlight()[c] * facing + level_sky[c]);
    let bright = 0.2126 * light[0] + 0.7152 * light[1] + 0.0722 * light[2];
    // Nights stay dark.
    let scale = BRIGHT * std::f32::consts::PI / bright.max(0.004);
    light.map(|c| scale * libm::powf(bright.max(1e-6) / c.max(1e-6), BALANCE).clamp(0.5, 2.0))
}

/// The exposed brightness of a white sheet in the sun, and the share of the white balance.
const BRIGHT: f32 = 2.1;
const BALANCE: f32 = 0.55;
