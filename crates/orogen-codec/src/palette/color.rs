//! Colors in linear light, in sRGB bytes, and in Oklab for mixing.

/// A color in linear light: red, green, blue, 0 to 1.
pub type Light = [f32; 3];

/// A color in sRGB bytes: red, green, blue.
pub type Rgb = [u8; 3];

/// A lookup table that converts linear light to sRGB bytes.
#[derive(Debug, Clone)]
pub struct Encoder {
    table: Vec<u8>,
}

/// Number of table entries, enough to reach all dark byte values.
const LEVELS: usize = 1 << 13;

impl Default for Encoder {
    fn default() -> Encoder {
        Encoder::new()
    }
}

impl Encoder {
    /// Computes the table.
    #[must_use]
    pub fn new() -> Encoder {
        Encoder { table: (0..=LEVELS).map(|level| encode(level as f32 / LEVELS as f32)).collect() }
    }

    /// The sRGB bytes of a color, clamped to the range of a byte.
    #[must_use]
    pub fn bytes(&self, color: Light) -> [u8; 3] {
        color.map(|c| self.table[(c.clamp(0.0, 1.0) * LEVELS as f32 + 0.5) as usize])
    }

    /// Appends the sRGB bytes of samples of red, green and blue, pixel by pixel.
    pub fn append_bytes(&self, bytes: &mut Vec<u8>, [red, green, blue]: [&[f32]; 3]) {
        let light = red.iter().zip(green).zip(blue);
        bytes.extend(light.flat_map(|((red, green), blue)| self.bytes([*red, *green, *blue])));
    }
}

/// The linear light of an sRGB byte (IEC 61966-2-1).
#[must_use]
pub fn decode(byte: u8) -> f32 {
    let c = f32::from(byte) / 255.0;
    if c <= 0.04045 { c / 12.92 } else { libm::powf((c + 0.055) / 1.055, 2.4) }
}

/// The nearest sRGB byte of linear light.
#[must_use]
pub fn encode(light: f32) -> u8 {
    let c = if light <= 0.003_130_8 { light * 12.92 } else { 1.055 * libm::powf(light, 1.0 / 2.4) - 0.055 };
    (c.clamp(0.0, 1.0) * 255.0 + 0.5) as u8
}

/// Converts linear light to Oklab: lightness, green to red, blue to yellow.
#[must_use]
pub fn oklab([r, g, b]: Light) -> [f32; 3] {
    let l = libm::cbrtf(0.412_221_46 * r + 0.536_332_55 * g + 0.051_445_995 * b);
    let m = libm::cbrtf(0.211_903_5 * r + 0.680_699_5 * g + 0.107_396_96 * b);
    let s = libm::cbrtf(0.088_302_46 * r + 0.281_718_85 * g + 0.629_978_7 * b);
    [
        0.210_454_26 * l + 0.793_617_8 * m - 0.004_072_047 * s,
        1.977_998_5 * l - 2.428_592_2 * m + 0.450_593_7 * s,
        0.025_904_037 * l + 0.782_771_77 * m - 0.808_675_77 * s,
    ]
}

/// Converts Oklab to linear light.
#[must_use]
pub fn linear([lightness, a, b]: [f32; 3]) -> Light {
    let l = lightness + 0.396_337_78 * a + 0.215_803_76 * b;
    let m = lightness - 0.105_561_346 * a - 0.063_854_17 * b;
    let s = lightness - 0.089_484_18 * a - 1.291_485_5 * b;
    let (l, m, s) = (l * l * l, m * m * m, s * s * s);
    [
        4.076_741_7 * l - 3.307_711_6 * m + 0.230_969_94 * s,
        -1.268_438 * l + 2.609_757_4 * m - 0.341_319_38 * s,
        -0.004_196_086_3 * l - 0.703_418_6 * m + 1.707_614_7 * s,
    ]
}

/// The color of a hexadecimal number 0xrrggbb.
#[must_use]
pub const fn rgb(hex: u32) -> Rgb {
    [(hex >> 16) as u8, (hex >> 8) as u8, hex as u8]
}

/// A color as `#rrggbb`, for SVG, TOML and DOT.
#[must_use]
pub fn hex([red, green, blue]: Rgb) -> String {
    format!("#{red:02x}{green:02x}{blue:02x}")
}

/// Linear interpolation of each component.
#[must_use]
pub fn mix(from: [f32; 3], to: [f32; 3], share: f32) -> [f32; 3] {
    std::array::from_fn(|i| from[i] + (to[i] - from[i]) * share)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_byte_comes_back_through_light_and_oklab() {
        let encoder = Encoder::new();
        for byte in 0..=255u8 {
            assert_eq!(encode(decode(byte)), byte);
            assert_eq!(encoder.bytes([decode(byte); 3]), [byte; 3]);
            let color = [decode(byte), decode(255 - byte), decode(byte / 2)];
            let back = linear(oklab(color));
            assert!(color.iter().zip(back).all(|(c, b)| (c - b).abs() < 1e-5), "{byte}");
        }
    }
}
