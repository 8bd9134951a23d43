//! Pictures of pages: what the commands of the page drew, small enough to be kept in the repository.

use std::path::Path;

use anyhow::{Context as _, Result, bail};
use image::codecs::jpeg::JpegEncoder;
use image::{Rgb, RgbImage};

/// Qualities of pictures; the first that is small enough is taken.
const QUALITIES: [u8; 4] = [80, 72, 64, 56];

/// Maximum size of a picture in bytes.
const MAX_BYTES: usize = 40_000;

/// Times that a picture is halved at most.
const MAX_HALVINGS: usize = 2;

/// A picture that a command drew, as it is kept: halved while it is too large. All is computed with integers, so the
/// bytes are the same everywhere.
pub fn encoded(drawn: &Path) -> Result<Vec<u8>> {
    let mut picture = image::open(drawn).with_context(|| format!("cannot read {}", drawn.display()))?.to_rgb8();
    for _ in 0..=MAX_HALVINGS {
        for quality in QUALITIES {
            let mut bytes = Vec::new();
            picture.write_with_encoder(JpegEncoder::new_with_quality(&mut bytes, quality))?;
            if bytes.len() <= MAX_BYTES {
                return Ok(bytes);
            }
        }
        picture = halved(&picture);
    }
    bail!("{} needs more than {MAX_BYTES} bytes: draw it smaller", drawn.display())
}

/// The picture at half its size: each pixel is the mean of four.
fn halved(picture: &RgbImage) -> RgbImage {
    RgbImage::from_fn(picture.width() / 2, picture.height() / 2, |x, y| {
        let four = [(0, 0), (1, 0), (0, 1), (1, 1)].map(|(i, j)| picture.get_pixel(2 * x + i, 2 * y + j).0);
        let mean = |channel: usize| (four.iter().map(|pixel| u32::from(pixel[channel])).sum::<u32>() + 2) / 4;
        Rgb([0, 1, 2].map(|channel| u8::try_from(mean(channel)).unwrap_or(u8::MAX)))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_pixel_is_the_mean_of_four() {
        let picture = RgbImage::from_fn(5, 2, |x, y| Rgb([u8::try_from(10 * x + y).unwrap_or(0), 255, 0]));
        let half = halved(&picture);
        assert_eq!(half.dimensions(), (2, 1));
        assert_eq!([half.get_pixel(0, 0).0, half.get_pixel(1, 0).0], [[6, 255, 0], [26, 255, 0]]);
    }
}
