//! Unreal Engine landscapes.
//!
//! "Landscape Technical Guide" (dev.epicgames.com): sizes that use whole components; 16 bits, where 32768 is height 0
//! of the actor; height = (value - 32768) / 128 x the actor's Z scale / 100, in metres.

use super::target::EngineTarget;
use crate::export::formats::{png, r16};
use crate::export::quantizer::RANGE;
use orogen_io::format::levels::Levels;

/// The target.
pub static TARGET: EngineTarget = EngineTarget {
    name: "unreal",
    about: "Unreal Engine landscapes: 16-bit PNG or r16 (32768 is 0 m), tiles _x0_y0",
    sides: &[127, 253, 505, 1009, 2017, 4033, 8129],
    formats: &[png::FORMAT.name, r16::FORMAT.name],
    tile: Some(|column, row, _| format!("_x{column}_y{row}")),
    weights_less: 0,
    weights: "layers",
    normal: "directx",
    heights: |levels, options| {
        let metres = f64::from(z_scale(levels)) / 100.0;
        // The heights of 0 and 65535.
        options.give(&RANGE, &format!("{},{}", -256.0 * metres, 32767.0 / 128.0 * metres))
    },
    import,
    objects: None,
};

/// The actor's Z scale that fits all heights: 100 spans 256 m on both sides of 0.
fn z_scale(levels: &Levels) -> f32 {
    let most = levels.low().abs().max(levels.high().abs());
    // The upper end is one step less than 256 m.
    (most / 2.5599).ceil().max(1.0)
}

fn import(side: usize, cell: f64, levels: &Levels) -> Vec<String> {
    let sections = match side {
        127 => "section size 63 x 63 quads, 1 x 1 sections, 2 x 2 components",
        253 => "section size 63 x 63 quads, 2 x 2 sections, 2 x 2 components",
        505 => "section size 63 x 63 quads, 2 x 2 sections, 4 x 4 components",
        1009 => "section size 63 x 63 quads, 2 x 2 sections, 8 x 8 components",
        2017 => "section size 63 x 63 quads, 2 x 2 sections, 16 x 16 components",
        4033 => "section size 63 x 63 quads, 2 x 2 sections, 32 x 32 components",
        _ => "section size 127 x 127 quads, 2 x 2 sections, 32 x 32 components",
    };
    let scale = cell * 100.0;
    vec![
        format!("Landscape > Import from File: {0} x {0}, {sections}", side),
        format!("Scale X {scale}, Y {scale}, Z {} (centimetres; Location Z 0: height 0 m is at Z 0)", z_scale(levels)),
        "Y grows south: the first row is the northern one, do not flip it".to_string(),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::options::Options;

    #[test]
    fn heights_come_back_by_the_engines_formula() {
        for (low, high) in [(-50.0, 200.0), (0.0, 4000.0), (-11000.0, 8848.0), (0.0, 0.5), (300.0, 300.0)] {
            let found = Levels::new(low, high);
            let mut options = Options::default();
            (TARGET.heights)(&found, &mut options).unwrap();
            let [least, greatest] = options.pair("range").unwrap();
            let levels = Levels::new(least as f32, greatest as f32);
            let scale = f64::from(z_scale(&found));
            assert_eq!(levels.to_u16(0.0), 32768);
            for height in [low, high, 0.25 * low + 0.75 * high] {
                let metres = (f64::from(levels.to_u16(height)) - 32768.0) / 128.0 * scale / 100.0;
                assert!((metres - f64::from(height)).abs() <= 0.51 * scale / 12800.0, "{height}: {metres}");
            }
        }
    }
}
