//! The sky, sunlight and haze.
//!
//! Single scattering of sunlight in the atmosphere: by molecules (Rayleigh) and by droplets and dust (Mie, forward),
//! with absorption by ozone (T. Nishita, T. Sirai, K. Tadamura, E. Nakamae, "Display of the Earth taking into account
//! atmospheric scattering", 1993; coefficients of E. Bruneton, "A qualitative and quantitative evaluation of 8 clear
//! sky models", 2017). The light of this sky is scattered once more, isotropically, which whitens the horizon. The
//! result is computed once for a table of directions.

use super::vector::Vector;
use orogen_io::palette::color::Light;
use serde::{Deserialize, Serialize};

/// Radii in metres: the Earth, the top of the atmosphere, the observer.
const EARTH: f32 = 6_360_000.0;
const TOP: f32 = 6_440_000.0;
const OBSERVER: f32 = EARTH + 800.0;

/// Rayleigh scattering at sea level, per metre; it halves every 5.5 km.
const RAYLEIGH: Light = [5.802e-6, 13.558e-6, 33.1e-6];
const RAYLEIGH_HEIGHT: f32 = 8000.0;
/// Mie scattering and extinction in clear air.
const MIE: f32 = 9.0e-6;
const MIE_DIMS: f32 = 10.0e-6;
const MIE_HEIGHT: f32 = 1200.0;
/// Asymmetry of Mie scattering.
const FORWARDS: f32 = 0.78;
/// Absorption by ozone at its maximum, at 25 km.
const OZONE: Light = [0.650e-6, 1.881e-6, 0.085e-6];

/// The share of light from the whole sky and the ground that is scattered again, isotropically.
const AGAIN: f32 = 1.6;

/// The desaturation of the light on the ground relative to the clear sky.
const PALE: f32 = 0.45;

/// Angular radius of the sun, in degrees.
pub(super) const SUN_RADIUS: f64 = 0.267;

/// Directions in the table: from the sun's azimuth to the opposite one, and up from the horizon.
pub(super) const AROUND: usize = 48;
pub(super) const UP: usize = 40;

/// Steps along a view ray, and along a ray to the sun.
const STEPS: usize = 24;
const SUN_STEPS: usize = 8;

/// A clear sky with the sun at one position. Light is relative to the sunlight above the atmosphere on a surface that
/// faces the sun.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub struct Sky {
    sun: Vector,
    /// The horizontal direction to the sun.
    pub(super) ahead: [f64; 2],
    /// Direct sunlight on a surface that faces the sun.
    sunlight: Light,
    pub(super) table: Vec<Light>,
}

impl Sky {
    /// The sky with the sun at an azimuth and elevation in degrees.
    pub fn new(azimuth: f64, elevation: f64) -> Sky {
        let sun = Vector::towards(azimuth, elevation);
        let (sin, cos) = libm::sincos(azimuth.to_radians());
        let height = sun.z as f32;
        let level = (1.0 - height * height).max(0.0).sqrt();
        let sunlight = dimmed(depths(OBSERVER, height));
        let rows = |shed: Light| {
            let mut table = Vec::with_capacity(AROUND * UP);
            for k in 0..UP {
                let up = k as f32 / (UP - 1) as f32;
                // Fine near the horizon, where most variation is.
                let up = (up * up).max(0.002);
                for i in 0..AROUND {
                    // The sine of half the horizontal angle from the sun.
                    let half = i as f32 / (AROUND - 1) as f32;
                    let cosine = 1.0 - 2.0 * half * half;
                    let across = (1.0 - up * up).max(0.0).sqrt();
                    let towards_sun = up * height + across * level * cosine;
                    table.push(scattered(up, height, [towards_sun, cosine], shed));
                }
            }
            table
        };
        let once = Sky { sun, ahead: [sin, -cos], sunlight, table: rows([0.0; 3]) };
        let dome = once.dome();
        // The ground reflects a fifth of the light.
        let shed = std::array::from_fn(|c| dome[c] + 0.2 * (dome[c] + sunlight[c] * height.max(0.0)));
        Sky { table: rows(shed), ..once }
    }

    /// The same sky with the sun at another azimuth in degrees.
    pub fn turned(&self, azimuth: f64) -> Sky {
        let (sin, cos) = libm::sincos(azimuth.to_radians());
        let level = (1.0 - self.sun.z * self.sun.z).max(0.0).sqrt();
        let sun = Vector::new(sin * level, -cos * level, self.sun.z);
        Sky { sun, ahead: [sin, -cos], ..self.clone() }
    }

    /// The light of the whole sky on level ground.
    pub fn dome(&self) -> Light {
        let mut sum = [0.0f32; 3];
        const RINGS: usize = 24;
        const SECTORS: usize = 24;
        for k in 0..RINGS {
            // Rings of equal parts of sin^2: each contributes equally to level ground.
            let sin = ((k as f64 + 0.5) / RINGS as f64).sqrt();
            let elevation = libm::asin(sin).to_degrees();
            for a in 0..SECTORS {
                let light = self.falling(Vector::towards((a as f64 + 0.5) * 360.0 / SECTORS as f64, elevation));
                sum.iter_mut().zip(light).for_each(|(sum, light)| *sum += light);
            }
        }
        sum.map(|sum| sum * std::f32::consts::PI / (RINGS * SECTORS) as f32)
    }

    /// Unit vector to the sun.
    pub fn sun(&self) -> Vector {
        self.sun
    }

    /// Direct sunlight on a surface that faces the sun.
    pub fn sunlight(&self) -> Light {
        self.sunlight
    }

    /// The light from a direction, without the sun; below the horizon, the light of the horizon above it.
    pub fn light(&self, along: Vector) -> Light {
        let up = along.z.max(0.0).sqrt() as f32 * (UP - 1) as f32;
        let level = (along.x * along.x + along.y * along.y).sqrt();
        let cosine = if level > 1e-9 { (along.x * self.ahead[0] + along.y * self.ahead[1]) / level } else { 0.0 };
        let around = (0.5 - 0.5 * cosine).max(0.0).sqrt() as f32 * (AROUND - 1) as f32;
        let (i, k) = ((around as usize).min(AROUND - 2), (up as usize).min(UP - 2));
        let (s, t) = ((around - i as f32).min(1.0), (up - k as f32).min(1.0));
        let row = &self.table[k * AROUND + i..];
        let (low, high) = ([row[0], row[1]], [row[AROUND], row[AROUND + 1]]);
        std::array::from_fn(|c| {
            let low = low[0][c] + (low[1][c] - low[0][c]) * s;
            low + (high[0][c] + (high[1][c] - high[0][c]) * s - low) * t
        })
    }

    /// The light from a direction for lighting the ground: less saturated, because real skies are rarely quite clear.
    pub(super) fn falling(&self, along: Vector) -> Light {
        let light = self.light(along);
        let grey = 0.2126 * light[0] + 0.7152 * light[1] + 0.0722 * light[2];
        light.map(|c| c + (grey - c) * PALE)
    }

    /// The light from a direction, including the sun's disc.
    pub fn seen(&self, along: Vector) -> Light {
        let sky = self.light(along);
        let radius = SUN_RADIUS.to_radians();
        // 1 - cos of the angle to the center of the sun, relative to the value at its limb.
        let away = (1.0 - along.dot(self.sun)) / (0.5 * radius * radius);
        if away >= 1.5 || along.z < 0.0 {
            return sky;
        }
        // The disc with limb darkening and a soft edge.
        let edge = ((1.5 - away) / 0.6).clamp(0.0, 1.0) as f32;
        let rim = 1.0 - 0.6 * (1.0 - (1.0 - away).max(0.0).sqrt() as f32);
        let disc = 1.0 / (std::f64::consts::PI * radius * radius) as f32;
        std::array::from_fn(|c| sky[c] + self.sunlight[c] * (disc * edge * rim).min(4000.0))
    }
}

/// Air masses from a height (metres from the Earth's center) to space in a direction, for molecules, droplets and
/// ozone; `None` if the Earth is in the way.
fn depths(from: f32, up: f32) -> Option<[f32; 3]> {
    let grazing = from * (1.0 - up * up).max(0.0).sqrt();
    if up < 0.0 && grazing < EARTH {
        return None;
    }
    let length = out(from, up);
    let step = length / SUN_STEPS as f32;
    let mut depth = [0.0; 3];
    for k in 0..SUN_STEPS {
        let density = densities(risen(from, up, (k as f32 + 0.5) * step));
        depth.iter_mut().zip(density).for_each(|(depth, density)| *depth += density * step);
    }
    Some(depth)
}

/// The distance to the top of the atmosphere.
fn out(from: f32, up: f32) -> f32 {
    let b = from * up;
    (b * b + (TOP - from) * (TOP + from)).max(0.0).sqrt() - b
}

/// The distance from the Earth's center after moving by `way`.
fn risen(from: f32, up: f32, way: f32) -> f32 {
    (from * from + way * (way + 2.0 * from * up)).max(0.0).sqrt()
}

/// Relative densities at a distance from the Earth's center; 1 at the maximum.
fn densities(at: f32) -> [f32; 3] {
    let height = (at - EARTH).max(0.0);
    let ozone = (1.0 - (height - 25_000.0).abs() / 15_000.0).max(0.0);
    [libm::expf(-height / RAYLEIGH_HEIGHT), libm::expf(-height / MIE_HEIGHT), ozone]
}

/// The transmittance of an air mass.
fn dimmed(depth: Option<[f32; 3]>) -> Light {
    let Some([molecules, droplets, ozone]) = depth else {
        return [0.0; 3];
    };
    std::array::from_fn(|c| libm::expf(-(RAYLEIGH[c] * molecules + MIE_DIMS * droplets + OZONE[c] * ozone)))
}

/// The light from a direction that rises by `up`, with `sun_up`, the sine of the sun's elevation. `towards_sun` and
/// `cosine` are the cosines of the angle to the sun and of its horizontal component. `shed` is the light of sky and
/// ground that is scattered again.
fn scattered(up: f32, sun_up: f32, [towards_sun, cosine]: [f32; 2], shed: Light) -> Light {
    use std::f32::consts::PI;
    let rayleigh = 3.0 / (16.0 * PI) * (1.0 + towards_sun * towards_sun);
    let g = FORWARDS;
    let base = 1.0 + g * g - 2.0 * g * towards_sun;
    let mie =
        3.0 / (8.0 * PI) * ((1.0 - g * g) * (1.0 + towards_sun * towards_sun)) / ((2.0 + g * g) * base * base.sqrt());
    let (across, sun_across) = ((1.0 - up * up).max(0.0).sqrt(), (1.0 - sun_up * sun_up).max(0.0).sqrt());
    let length = out(OBSERVER, up);
    let (mut before, mut depth, mut light) = (0.0, [0.0f32; 3], [0.0f32; 3]);
    for k in 0..STEPS {
        // Short steps first: the air is densest here.
        let share = (k + 1) as f32 / STEPS as f32;
        let end = length * share * share;
        let (step, way) = (end - before, 0.5 * (before + end));
        before = end;
        let at = risen(OBSERVER, up, way);
        let density = densities(at);
        let half = density.map(|density| density * step * 0.5);
        depth.iter_mut().zip(half).for_each(|(depth, half)| *depth += half);
        // The sun's elevation there differs because the Earth is round.
        let (height, along) = (OBSERVER + way * up, way * across);
        let sun_there = (height * sun_up + along * sun_across * cosine) / at;
        let (seen, lit) = (dimmed(Some(depth)), dimmed(depths(at, sun_there)));
        for c in 0..3 {
            let (molecules, droplets) = (RAYLEIGH[c] * density[0], MIE * density[1]);
            let again = AGAIN * shed[c] * (molecules + droplets) / (4.0 * PI);
            light[c] += seen[c] * (lit[c] * (molecules * rayleigh + droplets * mie) + again) * step;
        }
        depth.iter_mut().zip(half).for_each(|(depth, half)| *depth += half);
    }
    light
}

/// Haze over the land: air that is densest above the lowest ground.
#[derive(Debug, Clone, Copy)]
pub(super) struct Haze {
    /// Extinction of red, green and blue per cell at z = 0.
    pub dims: Light,
    /// Scale height, in cells.
    pub thins: f32,
}

/// Optical depth of green light over the diagonal of a block at a density of 1.
const BLOCK: f64 = 0.30;

impl Haze {
    /// Haze of this density over a block: 0 is none, 1 is a clear day. `across` is the diagonal of the block, and
    /// `highest` is the height of its highest ground above the lowest.
    pub fn of_block(density: f64, across: f64, highest: f64) -> Haze {
        Haze::new(BLOCK * density, across, (1.2 * highest).max(0.02 * across))
    }

    /// Haze with the optical depth `amount` of green light over `way` cells along the lowest ground, and a scale height
    /// of `thins` cells.
    pub fn new(amount: f64, way: f64, thins: f64) -> Haze {
        // Between clean air, which absorbs blue, and mist, which absorbs all colors equally.
        const COLOUR: Light = [0.62, 1.0, 1.75];
        let green = (amount / way) as f32;
        Haze { dims: COLOUR.map(|c| c * green), thins: thins as f32 }
    }

    /// The transmittance over `distance` cells between two values of z.
    pub fn left(&self, eye: f64, place: f64, distance: f64) -> Light {
        let (from, to) = ((eye as f32 / self.thins).max(0.0), (place as f32 / self.thins).max(0.0));
        let (low, high) = (from.min(to), from.max(to));
        let rise = high - low;
        // The mean density on the way.
        let thick = match rise < 1e-3 {
            true => libm::expf(-low),
            false => (libm::expf(-low) - libm::expf(-high)) / rise,
        };
        let way = thick * distance as f32;
        self.dims.map(|dims| libm::expf(-dims * way))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sum(light: Light) -> f32 {
        light.iter().sum()
    }

    #[test]
    fn a_clear_noon_is_blue_above_and_paler_at_the_horizon() {
        let sky = Sky::new(180.0, 60.0);
        let (zenith, horizon) = (sky.light(Vector::UP), sky.light(Vector::towards(0.0, 1.0)));
        assert!(zenith[2] > 2.0 * zenith[0] && sum(horizon) > 1.5 * sum(zenith), "{zenith:?} {horizon:?}");
        assert!(horizon[2] / horizon[0] < zenith[2] / zenith[0]);
        // The sky is brighter around the sun.
        assert!(sum(sky.light(Vector::towards(180.0, 50.0))) > sum(sky.light(Vector::towards(0.0, 50.0))));
        // On level ground the sun gives several times the light of the sky; real skies 4 to 10 times.
        let ratio = sum(sky.sunlight()) * sky.sun().z as f32 / sum(sky.dome());
        assert!((4.0..14.0).contains(&ratio), "{ratio}");
    }

    #[test]
    fn the_setting_sun_is_red_and_dim() {
        let [noon, evening] = [60.0, 2.0].map(|elevation| Sky::new(250.0, elevation).sunlight());
        assert!(evening[0] > 3.0 * evening[2] && sum(evening) < 0.5 * sum(noon), "{evening:?}");
        let night = Sky::new(250.0, -8.0);
        assert_eq!(night.sunlight(), [0.0; 3]);
        assert!(sum(night.light(Vector::UP)) < 0.02 * sum(Sky::new(250.0, 60.0).light(Vector::UP)));
    }

    #[test]
    fn the_sun_is_where_it_should_be() {
        let sky = Sky::new(120.0, 30.0);
        let at = |azimuth: f64, elevation: f64| sum(sky.seen(Vector::towards(azimuth, elevation)));
        assert!(at(120.0, 30.0) > 1000.0 * at(120.0, 31.0));
        assert!(at(120.0, 30.2) > 1000.0 * at(122.0, 30.0));
    }

    #[test]
    fn haze_takes_as_much_both_ways_and_less_above() {
        let haze = Haze::new(1.0, 1000.0, 40.0);
        let along = haze.left(0.0, 0.0, 1000.0);
        assert!((along[1] - libm::expf(-1.0)).abs() < 1e-6 && along[2] < along[1] && along[1] < along[0]);
        assert_eq!(haze.left(5.0, 60.0, 300.0), haze.left(60.0, 5.0, 300.0));
        assert!(haze.left(80.0, 80.0, 1000.0)[1] > along[1] + 0.3);
        assert_eq!(Haze::new(0.0, 1000.0, 40.0).left(0.0, 0.0, 5000.0), [1.0; 3]);
        // In one piece and in two.
        let whole = haze.left(0.0, 50.0, 200.0)[1];
        let halves = haze.left(0.0, 25.0, 100.0)[1] * haze.left(25.0, 50.0, 100.0)[1];
        assert!((whole - halves).abs() < 1e-5);
    }
}
