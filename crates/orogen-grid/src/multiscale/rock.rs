//! Soil and rock of detail levels: gentle slopes consist of soil, which creeps, and steep slopes of rock, which is
//! rough.

/// Stable slopes between which soil changes to rock, and the factor of creep of rock.
const SOIL_SLOPE: f32 = 0.5;
const ROCK_SLOPE: f32 = 1.0;
const ROCK_CREEP: f32 = 0.1;

/// Variation of the logarithm of the stable slope that a level adds, relative to that of uplift over erodibility: the
/// part of soil, and the additional part of rock.
const SOIL_VARIATION: f32 = 0.3;
const ROCK_VARIATION: f32 = 0.9;

/// Variation that a detail level adds to the logarithm of the stable slope, relative to the variation of uplift over
/// erodibility. Rock is rougher than soil.
pub fn roughness(logarithm: f32) -> f32 {
    // Stable slopes from 0.7 to 1.1.
    SOIL_VARIATION + ROCK_VARIATION * share(logarithm, [-0.35, 0.1])
}

/// The factor of creep for a stable slope: 1 for soil.
pub fn creep_factor(stable: f32) -> f32 {
    1.0 - (1.0 - ROCK_CREEP) * share(stable, [SOIL_SLOPE, ROCK_SLOPE])
}

/// The position of `value` between the two others, from 0 at `first` to 1 at `second`, clamped.
pub fn share(value: f32, [first, second]: [f32; 2]) -> f32 {
    ((value - first) / (second - first)).clamp(0.0, 1.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn steep_slopes_are_rough_and_keep_their_shape() {
        assert_eq!((creep_factor(0.2), creep_factor(0.5)), (1.0, 1.0));
        assert!(creep_factor(0.8) < 0.5 && (creep_factor(3.0) - ROCK_CREEP).abs() < 1e-6);
        // Slopes of 0.3, 0.8 and 1.2.
        let [gentle, steep, steepest] = [-1.2, -0.2, 0.18].map(roughness);
        assert!(gentle == SOIL_VARIATION && steep > gentle && steepest == SOIL_VARIATION + ROCK_VARIATION);
    }
}
