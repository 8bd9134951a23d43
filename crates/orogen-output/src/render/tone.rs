//! Tone mapping: from light to displayable colors.

use orogen_io::palette::color::Light;

/// Channels are mixed before the curve, and after it.
pub(super) const INPUT: [Light; 3] =
    [[0.597_19, 0.354_58, 0.048_23], [0.076_00, 0.908_34, 0.015_66], [0.028_40, 0.133_83, 0.837_77]];
pub(super) const OUTPUT: [Light; 3] =
    [[1.604_75, -0.531_08, -0.073_67], [-0.102_08, 1.108_13, -0.006_05], [-0.003_27, -0.072_76, 1.076_02]];

/// The coefficients a to e of the curve (v (v + a) - b) / (v (c v + d) + e).
pub(super) const CURVE: [f32; 5] = [0.024_578_6, 0.000_090_537, 0.983_729, 0.432_951, 0.238_081];

/// Filmic tone mapping of red, green and blue light: shadows keep their color, highlights roll off to white.
///
/// S. Hill's fit of the ACES reference rendering and output transforms (2014), including its mixing of channels, which
/// desaturates bright light. `light` is 1 for a white sheet in the sun.
pub(super) fn tone_map(light: Light) -> Light {
    let [r, g, b] = light.map(|c| c.max(0.0));
    let [above, less, square, linear, rest] = CURVE;
    let [r, g, b] = INPUT
        .map(|mix| mix[0] * r + mix[1] * g + mix[2] * b)
        .map(|v| (v * (v + above) - less) / (v * (square * v + linear) + rest));
    OUTPUT.map(|mix| (mix[0] * r + mix[1] * g + mix[2] * b).clamp(0.0, 1.0))
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
    fn bright_colors_pale() {
        let [r, g, b] = tone_map([0.2, 0.1, 0.05]);
        let [bright_r, bright_g, bright_b] = tone_map([20.0, 10.0, 5.0]);
        assert!(b / r < bright_b / bright_r && g / r < bright_g / bright_r && bright_b > 0.8);
    }
}
