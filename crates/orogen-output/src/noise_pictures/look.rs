//! The appearance of a noise's samples: gray values, directions or colors.

use std::ops::Range;

use orogen_io::format::levels::Levels;
use orogen_io::format::png::Pixel;

use super::slice::Slice;
use super::texture::{Painter, Texture};

/// Height of the ground of a normal map, in wavelengths; chosen for moderate slopes.
const RELIEF: f64 = 0.25;

/// The kind of drawing.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Look {
    /// Values: -1 is black, 1 is white.
    Grey,
    /// Normals of the slope.
    Normal,
    /// A texture.
    Texture(Texture),
}

/// A noise and its appearance.
#[derive(Debug)]
pub struct Drawing {
    slice: Slice,
    deep: bool,
    look: Look,
    painter: Painter,
}

impl Look {
    /// The slice to draw: a texture changes how octaves are summed, and may stretch the noise.
    #[must_use]
    pub fn made_of(self, slice: &Slice) -> Slice {
        match self {
            Look::Texture(texture) => texture.made_of(slice),
            _ => *slice,
        }
    }
}

impl Drawing {
    /// A drawing of a slice, with 16 bits per component if `deep` is set and it is not a texture.
    #[must_use]
    pub fn new(slice: Slice, look: Look, deep: bool) -> Drawing {
        Drawing { slice, deep, look, painter: Painter::default() }
    }

    /// The type of its pixels.
    #[must_use]
    pub fn pixel(&self) -> Pixel {
        match (self.look, self.deep) {
            (Look::Grey, false) => Pixel::Grey8,
            (Look::Grey, true) => Pixel::Grey16,
            (Look::Normal, false) => Pixel::Data8,
            (Look::Normal, true) => Pixel::Data16,
            (Look::Texture(_), _) => Pixel::Rgb8,
        }
    }

    /// Draws some rows of a slice at `depth`, or of 2D noise if it is `None`.
    pub fn paint(&self, depth: Option<f64>, rows: Range<usize>, bytes: &mut [u8]) {
        let slice = Slice { depth, ..self.slice };
        let mut value = vec![0.0; rows.len() * slice.width];
        match self.look {
            Look::Grey => {
                slice.fill(rows, &mut value);
                self.numbers(&value, bytes);
            }
            Look::Normal => {
                let mut dy = vec![0.0; value.len()];
                slice.fill_slopes(rows, &mut value, &mut dy);
                let relief = (RELIEF * slice.noise.wavelength) as f32;
                let normals: Vec<f32> =
                    value.iter().zip(&dy).flat_map(|(&dx, &dy)| normal(dx * relief, dy * relief)).collect();
                self.numbers(&normals, bytes);
            }
            Look::Texture(texture) => self.painter.paint(texture, &slice, rows, bytes),
        }
    }

    /// Maps numbers from -1 to 1 to all gray levels.
    fn numbers(&self, numbers: &[f32], bytes: &mut [u8]) {
        let levels = Levels::new(-1.0, 1.0);
        match self.deep {
            false => bytes.iter_mut().zip(numbers).for_each(|(byte, &number)| *byte = levels.to_u8(number)),
            true => bytes
                .chunks_exact_mut(2)
                .zip(numbers)
                .for_each(|(pair, &number)| pair.copy_from_slice(&levels.to_u16(number).to_be_bytes())),
        }
    }
}

/// The upward normal of ground that rises by `dx` eastward and by `dy` southward: east, north and up. North is up in
/// the picture, the common convention.
fn normal(dx: f32, dy: f32) -> [f32; 3] {
    let length = (1.0 + dx * dx + dy * dy).sqrt();
    [-dx / length, dy / length, 1.0 / length]
}

#[cfg(test)]
mod tests {
    use super::*;
    use orogen_noise::Fractal;

    #[test]
    fn normals_face_downhill() {
        assert_eq!(normal(0.0, 0.0), [0.0, 0.0, 1.0]);
        let [east, north, up] = normal(-1.0, 0.0);
        assert!(east > 0.7 && north == 0.0 && up > 0.7, "falling eastwards it faces east");
        let [_, north, _] = normal(0.0, 1.0);
        assert!(north > 0.7, "rising southwards it faces north");
    }

    #[test]
    fn greys_span_all_levels() {
        let slice = Slice { noise: Fractal::default(), width: 3, depth: None, stretch: 1.0, repeat: [0.0; 3] };
        let drawing = Drawing::new(slice, Look::Grey, true);
        let mut bytes = [0; 6];
        drawing.numbers(&[-1.0, 0.0, 1.0], &mut bytes);
        assert_eq!(bytes, [0, 0, 0x80, 0, 0xff, 0xff]);
    }
}
