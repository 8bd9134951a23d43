//! What covers the ground: weights of layers by slope, height, curvature and flow, as painters of terrain mix textures.
//!
//! Grass lies on all land and sand on the floor of the sea; each of the others is laid over what is there as far as its rule says, 0 to 1 with soft borders,
//! in this order. So the weights add up to 1 wherever there is a height.
//!
//! | layer | where | soft over |
//! |---|---|---|
//! | scree | 30 to 40 degrees, in hollows wholly, on convex ground by half | 6 degrees below, 4 above; curvature of 0.01 1/m |
//! | rock | above 40 degrees, and on brows (curvature above 0.02 1/m) from 25 degrees | 8 degrees; 0.01 1/m |
//! | snow | above the snow line, not where it is steeper than 45 degrees | 400 m below; 10 degrees |
//! | sand | up to 3 m above the sea, not where it is steeper than 15 degrees | 5 m; 10 degrees |
//! | bed | where more than 1 km^2 drains, on land, not where it is steeper than 35 degrees | down to 0.2 km^2; 2 m; 10 degrees |

use super::selection::Selection;

/// The layers, in the order of their weights.
pub const LAYERS: [&str; 6] = ["grass", "scree", "rock", "snow", "sand", "bed"];

/// Where snow begins, in metres above the sea, if nobody says: about the Alps'.
pub const SNOW_LINE: f64 = 2600.0;

/// What is known of a sample.
#[derive(Debug, Clone, Copy)]
pub struct Ground {
    /// How steep it is, in degrees.
    pub slope: f32,
    /// Its height above the sea, in metres.
    pub above_sea: f32,
    /// Its total curvature in 1/m: above 0 on tops, below 0 in hollows.
    pub curvature: f32,
    /// How much ground drains through it, in m^2; 0 where that is not known.
    pub flow: f32,
}

/// The rules, with their borders.
#[derive(Debug, Clone, Copy)]
pub struct Cover {
    scree: Selection,
    hollow: Selection,
    rock: Selection,
    brow: Selection,
    brow_slope: Selection,
    snow: Selection,
    snow_slope: Selection,
    sand: Selection,
    sand_slope: Selection,
    bed: Selection,
    bed_slope: Selection,
    land: Selection,
}

impl Cover {
    /// The rules with snow from so many metres above the sea on.
    pub fn new(snow_line: f64) -> Cover {
        let from = |low: f64, below: f64| Selection::new([low, f64::INFINITY], [below, 0.0]);
        let up_to = |high: f64, above: f64| Selection::new([f64::NEG_INFINITY, high], [0.0, above]);
        Cover {
            scree: Selection::new([30.0, 40.0], [6.0, 4.0]),
            hollow: up_to(0.0, 0.01),
            rock: from(40.0, 8.0),
            brow: from(0.02, 0.01),
            brow_slope: from(25.0, 8.0),
            snow: from(snow_line, 400.0),
            snow_slope: up_to(45.0, 10.0),
            sand: up_to(3.0, 5.0),
            sand_slope: up_to(15.0, 10.0),
            bed: from(6.0, 0.7),
            bed_slope: up_to(35.0, 10.0),
            land: from(0.0, 2.0),
        }
    }

    /// The weight of each layer, 0 to 1; all of them 0 where there is no height.
    pub fn weights(&self, ground: &Ground) -> [f32; 6] {
        let Ground { slope, above_sea, curvature, flow } = *ground;
        if !(slope.is_finite() && above_sea.is_finite()) {
            return [0.0; 6];
        }
        // A curvature that is not known is that of a plane.
        let curvature = if curvature.is_finite() { curvature } else { 0.0 };
        let flow = if flow > 0.0 { libm::log10f(flow) } else { f32::NEG_INFINITY };
        let land = self.land.of(above_sea);
        let over = [
            self.scree.of(slope) * (0.5 + 0.5 * self.hollow.of(curvature)),
            self.rock.of(slope).max(self.brow.of(curvature) * self.brow_slope.of(slope)),
            self.snow.of(above_sea) * self.snow_slope.of(slope),
            self.sand.of(above_sea) * self.sand_slope.of(slope),
            self.bed.of(flow) * self.bed_slope.of(slope) * land,
        ];
        let mut weights = [land, 0.0, 0.0, 0.0, 1.0 - land, 0.0];
        for (k, share) in over.into_iter().enumerate() {
            weights.iter_mut().for_each(|weight| *weight *= 1.0 - share);
            weights[k + 1] += share;
        }
        weights
    }
}

/// Weights as bytes that add up to exactly 255: each rounded down, what is left given to those that lost most, the first of equals first. All 0 if
/// no weight is above 0.
pub fn to_bytes(weights: &[f32], bytes: &mut [u8]) {
    let total: f64 = weights.iter().map(|weight| f64::from(weight.max(0.0))).sum();
    bytes.fill(0);
    if !(total > 0.0 && total.is_finite()) {
        return;
    }
    let exact = |k: usize| f64::from(weights[k].max(0.0)) * 255.0 / total;
    let mut left = 255u32;
    for (k, byte) in bytes.iter_mut().enumerate() {
        *byte = exact(k).floor().min(f64::from(left)) as u8;
        left -= u32::from(*byte);
    }
    while left > 0 {
        let lost = |k: usize| exact(k) - f64::from(bytes[k]);
        let most = (0..bytes.len()).fold(0, |most, k| if lost(k) > lost(most) { k } else { most });
        bytes[most] += 1;
        left -= 1;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn weights(slope: f32, above_sea: f32, curvature: f32, flow: f32) -> [f32; 6] {
        Cover::new(SNOW_LINE).weights(&Ground { slope, above_sea, curvature, flow })
    }

    #[test]
    fn each_layer_has_its_place() {
        for (layer, slope, above_sea, curvature, flow) in [
            ("grass", 10.0, 500.0, 0.0, 100.0),
            ("scree", 32.0, 500.0, -0.01, 100.0),
            ("rock", 60.0, 500.0, 0.0, 100.0),
            ("rock", 26.0, 500.0, 0.04, 100.0),
            ("snow", 20.0, 3000.0, 0.0, 100.0),
            ("sand", 3.0, 1.0, 0.0, 100.0),
            ("sand", 3.0, -80.0, 0.0, 1e9),
            ("sand", 22.0, -80.0, 0.0, 100.0),
            ("bed", 3.0, 500.0, 0.0, 1e7),
        ] {
            let weights = weights(slope, above_sea, curvature, flow);
            let most = (0..6).fold(0, |most, k| if weights[k] > weights[most] { k } else { most });
            assert!(LAYERS[most] == layer && weights[most] > 0.9, "{layer}: {weights:?}");
        }
        assert_eq!(weights(f32::NAN, 1.0, 0.0, 0.0), [0.0; 6]);
    }

    #[test]
    fn weights_add_up_and_change_softly() {
        let mut before: Option<[f32; 6]> = None;
        for k in 0..900 {
            let now = weights(k as f32 * 0.1, 2400.0, 0.005, 3e5);
            assert!((now.iter().sum::<f32>() - 1.0).abs() < 1e-5, "{now:?}");
            if let Some(before) = before {
                assert!(now.iter().zip(before).all(|(a, b)| (a - b).abs() < 0.05), "at {k}");
            }
            before = Some(now);
        }
    }

    #[test]
    fn bytes_add_up_to_255() {
        let mut bytes = [0; 6];
        for slope in 0..90 {
            for height in [-50.0, 2.0, 5.0, 700.0, 2450.0, 4000.0] {
                to_bytes(&weights(slope as f32, height, 0.013, 4e5), &mut bytes);
                assert_eq!(bytes.iter().map(|byte| u32::from(*byte)).sum::<u32>(), 255);
            }
        }
        to_bytes(&[1.0, 1.0, 1.0, 0.0, 0.0, 0.0], &mut bytes);
        assert_eq!(bytes, [85, 85, 85, 0, 0, 0]);
        to_bytes(&[0.5, 0.5], &mut bytes[..2]);
        assert_eq!(bytes[..2], [128, 127]);
        to_bytes(&[0.0; 6], &mut bytes);
        assert_eq!(bytes, [0; 6]);
    }
}
