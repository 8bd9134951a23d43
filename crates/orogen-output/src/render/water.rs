//! Water: waves, reflection, and color by depth.

use super::grain::Grain;
use super::vector::Vector;
use orogen_io::palette::color::Light;

/// Absorption of water per metre (after R. M. Pope and E. S. Fry, "Absorption spectrum (380-700 nm) of pure water",
/// 1997, with a little algae).
const TAKES: Light = [0.40, 0.085, 0.060];

/// The albedo of deep water.
pub(super) const DEEP: Light = [0.006, 0.024, 0.036];

/// The albedo of the bottom.
pub(super) const BOTTOM: Light = [0.20, 0.18, 0.125];

/// The absorption of lake water: brown with humus and green with algae, with a Secchi depth of about 4 m (1.7 over the
/// coefficient of green: H. H. Poole and W. R. G. Atkins, "Photo-electric measurements of submarine illumination",
/// 1929), and the albedo of a bottom of mud and dark stones.
pub(super) const LAKE_TAKES: Light = [0.85, 0.42, 0.65];
pub(super) const LAKE_DEEP: Light = [0.009, 0.026, 0.030];
pub(super) const LAKE_BOTTOM: Light = [0.060, 0.056, 0.040];

/// The colors of a section through water: near the surface, and deep below it.
pub(super) const SHALLOW: Light = [0.16, 0.36, 0.40];
pub(super) const DARK: Light = [0.018, 0.075, 0.115];

/// With cells wider than this, in metres, water is drawn clearer; otherwise shores would be thinner than a pixel.
const FINE_CELL: f64 = 10.0;

/// The square of 1 / 1.33, for refraction.
pub(super) const BENDS: f32 = 0.565;

/// Wavelengths of waves in metres, the longest first, with their steepness.
pub(super) const WAVES: [(f32, f32); 4] = [(46.0, 0.012), (19.0, 0.018), (7.0, 0.026), (2.6, 0.030)];

/// Ratio of the wavelengths along x to those along y.
pub(super) const STRETCH: f64 = 1.4;

/// Kinds of water.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Kind {
    /// Clear sea water over sand.
    Sea,
    /// Lake water.
    Lake,
}

/// The appearance of water in a land.
#[derive(Debug, Clone, Copy)]
pub(super) struct Water {
    /// Absorption of the sea per metre.
    pub takes: Light,
    cell: f32,
}

impl Water {
    /// Water for a land with this cell, in metres.
    pub fn new(cell: f64) -> Water {
        let clear = (FINE_CELL / cell.max(FINE_CELL)) as f32;
        Water { takes: TAKES.map(|takes| takes * clear), cell: cell as f32 }
    }

    /// The normal of the waves at a position, for a pixel of `footprint` metres.
    pub fn normal(&self, grain: &Grain, x: f64, y: f64, footprint: f32) -> Vector {
        let mut slope = [0.0f32; 2];
        for (kind, (wavelength, steep)) in WAVES.into_iter().enumerate() {
            let seen = ((wavelength / footprint - 1.0) / 3.0).clamp(0.0, 1.0);
            if seen <= 0.0 {
                continue;
            }
            let scale = f64::from(self.cell / wavelength);
            let bump = grain.at(x * scale, y * scale * STRETCH, kind as u32 + 1);
            slope[0] += bump.slope[0] * steep * seen;
            slope[1] += bump.slope[1] * steep * seen;
        }
        Vector::new(-f64::from(slope[0]), -f64::from(slope[1]), 1.0).unit()
    }

    /// The share of light that water of this depth, in metres, scatters back; `seen` and `lit` are the cosines of the
    /// viewing and lighting angles.
    pub fn body(&self, kind: Kind, depth: f32, seen: f32, lit: f32) -> Light {
        let (takes, deep, bottom) = match kind {
            Kind::Sea => (self.takes, DEEP, BOTTOM),
            Kind::Lake => (LAKE_TAKES, LAKE_DEEP, LAKE_BOTTOM),
        };
        let slanted = |cosine: f32| 1.0 / (1.0 - BENDS * (1.0 - cosine * cosine)).max(0.1).sqrt();
        let way = depth.max(0.0) * (slanted(seen) + slanted(lit));
        std::array::from_fn(|c| {
            let left = libm::expf(-takes[c] * way);
            bottom[c] * left + deep[c] * (1.0 - left)
        })
    }

    /// The color of a section through water, at a depth in metres.
    pub fn section(&self, depth: f32) -> Light {
        let left: Light = self.takes.map(|takes| libm::expf(-takes * depth * 0.12));
        std::array::from_fn(|c| DARK[c] + (SHALLOW[c] - DARK[c]) * left[c].max(left[1] * 0.6))
    }
}

/// The reflectance of water under an angle with this cosine (C. Schlick's approximation of Fresnel's equations, 1994).
pub(super) fn mirrored(cosine: f32) -> f32 {
    let off = 1.0 - cosine.clamp(0.0, 1.0);
    let square = off * off;
    0.02 + 0.98 * square * square * off
}

/// Glitter of the sun: light reflected by waves within a pixel, whose slopes vary by `rough`, relative to the light on
/// a surface that faces the sun.
pub(super) fn glitter(normal: Vector, to_eye: Vector, to_sun: Vector, rough: f32) -> f32 {
    let half = (to_eye + to_sun).unit();
    let cosine = normal.dot(half) as f32;
    let seen = (normal.dot(to_eye) as f32).max(0.05);
    if cosine <= 0.0 {
        return 0.0;
    }
    // P. Beckmann's distribution of slopes.
    let square = cosine * cosine;
    let exponent = (square - 1.0) / (square * rough * rough);
    let facing = libm::expf(exponent) / (std::f32::consts::PI * rough * rough * square * square);
    facing * mirrored(half.dot(to_eye) as f32) / (4.0 * seen)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn it_mirrors_all_when_grazed_and_little_from_above() {
        assert!((mirrored(1.0) - 0.02).abs() < 1e-6 && (mirrored(0.0) - 1.0).abs() < 1e-6);
        // Fresnel's equations for 1.33 at 60 and 80 degrees from the normal: 0.0595 and 0.388.
        assert!((mirrored(0.5) - 0.0595).abs() < 0.01 && (mirrored(0.173_65) - 0.388).abs() < 0.03);
    }

    #[test]
    fn it_darkens_and_turns_blue_with_depth() {
        let water = Water::new(5.0);
        let [shallow, deep] = [0.3, 60.0].map(|depth| water.body(Kind::Sea, depth, 0.7, 0.7));
        assert!(shallow[0] > 0.1 && deep[0] < 0.01 && deep[2] > 3.0 * deep[0]);
        // Beer-Lambert: straight down and up again through one metre.
        let metre = water.body(Kind::Sea, 1.0, 1.0, 1.0)[1];
        let left = libm::expf(-2.0 * TAKES[1]);
        assert!((metre - (BOTTOM[1] * left + DEEP[1] * (1.0 - left))).abs() < 1e-6);
    }

    #[test]
    fn the_shallows_of_lakes_are_dark_whatever_the_cell() {
        let bright = |light: Light| 0.2126 * light[0] + 0.7152 * light[1] + 0.0722 * light[2];
        for cell in [5.0, 60.0, 300.0] {
            let [shore, shallow, deep] =
                [0.0, 2.0, 10.0].map(|depth| bright(Water::new(cell).body(Kind::Lake, depth, 0.4, 0.5)));
            assert!(shallow < 1.5 * deep && shore < 3.0 * deep, "{cell}: {shore} {shallow} {deep}");
        }
    }

    #[test]
    fn the_sun_glitters_where_it_is_mirrored() {
        let sun = Vector::towards(180.0, 40.0);
        let [met, missed] =
            [40.0, 60.0].map(|elevation| glitter(Vector::UP, Vector::towards(0.0, elevation), sun, 0.08));
        assert!(met > 20.0 * missed && missed >= 0.0, "{met} {missed}");
    }
}
