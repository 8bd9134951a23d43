//! Tone mapping: from light to displayable colours.

use orogen_io::palette::color::Light;

/// Filmic tone mapping of red, green and blue light: shadows keep their colour, highlights roll off to white.
///
/// S. Hill's fit of the ACES reference rendering and output transforms (2014), including its mixing of channels, which
/// desaturates bright light. `light` is 1 for a white sheet in the sun.
pub(super) fn tone_map(light: Light) -> Light {
    let [r, g, b] = light.map(|c| c.max(0.0));
    let mixed = [
        0.597_19 * r + 0.354_58 * g + 0.048_23 * b,
        0.076_00 * r + 0.908_34 * g + 0.015_66 * b,
        0.028_40 * r + 0.133_83 * g + 0.837_77 * b,
    ];
    let [r, g, b] =
        mixed.map(|v| (v * (v + 0.024_578_6) - 0.000_090_537) / (v * (0.983_729 * v + 0.432_951) + 0.238_081));
    [
        1.604_75 * r - 0.531_08 * g - 0.073_67 * b,
        -0.102_08 * r + 1.108_13 * g - 0.006_05 * b,
        -0.003_27 * r - 0.072_76 * g + 1.076_02 * b,
    ]
    .map(|c| c.clamp(0.0, 1.0))
}

#[cfg(test)]
mod tests {
    use super::tone_map;

    #[test]
    fn greys_stay_grey_and_keep_their_order() {
        let mut before = -1.0;
        for step in 0..400 {
            let light = step as f32 * step as f32 / 4000.0;
            let [r, g, b] = tone_map([light; 3]);
            assert!((r - g).abs() < 0.004 && (b - g).abs() < 0.004, "{light}: {r} {g} {b}");
            assert!(g >= before && (0.0..=1.0).contains(&g));
            before = g;
        }
        assert!(before > 0.99, "{before}");
        assert_eq!(tone_map([0.0; 3]), [0.0; 3]);
    }

    #[test]
    fn bright_colours_pale() {
        let [r, g, b] = tone_map([0.2, 0.1, 0.05]);
        let [bright_r, bright_g, bright_b] = tone_map([20.0, 10.0, 5.0]);
        assert!(b / r < bright_b / bright_r && g / r < bright_g / bright_r && bright_b > 0.8);
    }
}
