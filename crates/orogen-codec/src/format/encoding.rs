//! Heights encoded in the red, green and blue channels of a picture, for web maps.

/// The encoding of a height in three bytes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum Encoding {
    /// height = 256 R + G + B / 256 - 32768: steps of 1/256 m (Mapzen).
    Terrarium,
    /// height = (65536 R + 256 G + B) / 10 - 10000: steps of 0.1 m (Mapbox).
    TerrainRgb,
}

impl Encoding {
    /// All encodings.
    pub const ALL: [Encoding; 2] = [Encoding::Terrarium, Encoding::TerrainRgb];

    /// The name that users see.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Encoding::Terrarium => "terrarium",
            Encoding::TerrainRgb => "terrain-rgb",
        }
    }

    /// The name in TileJSON and MapLibre.
    #[must_use]
    pub fn tilejson(self) -> &'static str {
        match self {
            Encoding::Terrarium => "terrarium",
            Encoding::TerrainRgb => "mapbox",
        }
    }

    /// The height of the bytes 0, 0, 0, and the number of steps per metre.
    fn scale(self) -> (f64, f64) {
        match self {
            Encoding::Terrarium => (-32768.0, 256.0),
            Encoding::TerrainRgb => (-10000.0, 10.0),
        }
    }

    /// The distance between heights that can be encoded, in metres.
    #[must_use]
    pub fn step(self) -> f64 {
        1.0 / self.scale().1
    }

    /// The red, green and blue of a height, to the nearest step. Heights outside the range of the encoding are clamped;
    /// NaN becomes 0, 0, 0.
    #[must_use]
    pub fn bytes(self, height: f32) -> [u8; 3] {
        const MOST: f64 = ((1 << 24) - 1) as f64;
        if height.is_nan() {
            return [0; 3];
        }
        let (base, steps) = self.scale();
        let steps = ((f64::from(height) - base) * steps).round().clamp(0.0, MOST) as u32;
        [(steps >> 16) as u8, (steps >> 8) as u8, steps as u8]
    }

    /// Fills pixels of three bytes from heights.
    pub fn fill(self, pixels: &mut [u8], heights: &[f32]) {
        for (pixel, height) in pixels.chunks_exact_mut(3).zip(heights) {
            pixel.copy_from_slice(&self.bytes(*height));
        }
    }

    /// The height that three bytes encode, in metres.
    #[must_use]
    pub fn height(self, bytes: [u8; 3]) -> f64 {
        let (base, steps) = self.scale();
        f64::from(u32::from_be_bytes([0, bytes[0], bytes[1], bytes[2]])) / steps + base
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn heights_come_back_to_half_a_step() {
        for encoding in Encoding::ALL {
            let (base, steps) = encoding.scale();
            for height in [0.0f32, -0.001, 1234.567, -9999.0, 8848.86, 32767.99] {
                let back = encoding.height(encoding.bytes(height));
                assert!((back - f64::from(height)).abs() <= 0.5001 / steps, "{height}: {back}");
            }
            assert_eq!(encoding.bytes(f32::NAN), [0; 3]);
            assert_eq!((encoding.bytes(-1e9), encoding.bytes(f32::INFINITY)), ([0; 3], [255; 3]));
            assert_eq!(encoding.height([0; 3]), base);
        }
    }

    #[test]
    fn the_published_examples_hold() {
        // Mapbox's documentation: 65536 R + 256 G + B tenths above -10000.
        assert_eq!(Encoding::TerrainRgb.height([1, 134, 160]), 0.0);
        assert_eq!(Encoding::TerrainRgb.bytes(0.0), [1, 134, 160]);
        // Mapzen's documentation: sea level is 128, 0, 0.
        assert_eq!(Encoding::Terrarium.bytes(0.0), [128, 0, 0]);
    }
}
