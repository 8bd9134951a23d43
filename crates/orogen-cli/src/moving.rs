//! Animations in one file, or as one file per frame.

use std::io;
use std::path::Path;

use orogen::io::file::{self, OutputPolicy, Staged};
use orogen::io::format::gif::{self, Palette};
use orogen::io::format::png::{self, Animation, Picture, Pixel};

use crate::failure::Failure;
use crate::sink::{Sink, is_stdout};

/// The output of an animation.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum AnimationTarget {
    /// An animated PNG (APNG).
    Apng,
    /// A GIF.
    Gif,
    /// One PNG per frame: the text before the number, the minimum number of digits, the text after it.
    Frames(String, usize, String),
}

impl AnimationTarget {
    /// The output for a file name: `.png` and `.gif` are animations, `view-%03d.png` is one file per frame, and
    /// standard output is an APNG; or an error message.
    pub fn of(out: &Path) -> Result<AnimationTarget, String> {
        if is_stdout(out) {
            return Ok(AnimationTarget::Apng);
        }
        let name = out.file_name().map(|name| name.to_string_lossy()).unwrap_or_default();
        let extension = out.extension().map(|extension| extension.to_string_lossy().to_lowercase()).unwrap_or_default();
        let help = "frames are written to an animated .png, a .gif, or one file each, such as view-%03d.png";
        match (name.split_once('%'), extension.as_str()) {
            (Some((before, rest)), "png") => {
                let number = rest.split_once('d').and_then(|(digits, after)| {
                    let digits = if digits.is_empty() { Some(1) } else { digits.parse().ok() };
                    digits.filter(|digits| *digits <= 9).map(|digits| (digits, after))
                });
                match number.filter(|(_, after)| !after.contains('%')) {
                    Some((digits, after)) => Ok(AnimationTarget::Frames(before.into(), digits, after.into())),
                    None => Err(format!("{name} has a % that is not a frame number such as %03d; {help}")),
                }
            }
            (None, "png") => Ok(AnimationTarget::Apng),
            (None, "gif") => Ok(AnimationTarget::Gif),
            (_, "") => Err(format!("{} has no file extension that determines its format; {help}", out.display())),
            (_, other) => Err(format!("frames cannot be written as .{other}; {help}")),
        }
    }

    /// The output files of this many frames, if existing files may be replaced.
    pub fn outputs(&self, out: &Path, frames: u32, policy: &OutputPolicy) -> Result<Vec<Sink>, Failure> {
        match self {
            AnimationTarget::Apng | AnimationTarget::Gif => Ok(vec![Sink::new(out, policy)?]),
            AnimationTarget::Frames(before, digits, after) => (0..frames)
                .map(|frame| Sink::new(&out.with_file_name(format!("{before}{frame:0digits$}{after}")), policy))
                .collect(),
        }
    }

    /// Memory for writing frames of this many pixels, in bytes, without the pixels themselves (three bytes each).
    pub fn reserved(&self, pixels: u64) -> u64 {
        match self {
            // The filtered and the compressed frame.
            AnimationTarget::Apng | AnimationTarget::Frames(..) => pixels.saturating_mul(6),
            // Indices of this and the previous frame, and the tables of the encoder.
            AnimationTarget::Gif => pixels.saturating_mul(2).saturating_add(4 << 20),
        }
    }
}

/// An animation to write.
pub struct Moving<'a> {
    /// The outputs, from [`AnimationTarget::outputs`].
    pub outputs: &'a [Sink],
    /// The kind of output.
    pub target: &'a AnimationTarget,
    /// Description of a frame.
    pub picture: Picture<'a>,
    /// Number and duration of the frames.
    pub animation: Animation,
    /// Pixels for the palette of a GIF, of the picture's type.
    pub sample: &'a dyn Fn() -> io::Result<Vec<u8>>,
}

impl Moving<'_> {
    /// Writes all frames or none. `fill` makes a frame: it gets the frame's number, from 0, and its bytes.
    pub fn write(&self, mut fill: impl FnMut(u32, &mut [u8]) -> io::Result<()>) -> Result<(), Failure> {
        let Picture { width, height, pixel, .. } = self.picture;
        match self.target {
            AnimationTarget::Apng => {
                self.outputs[0].write(|out| png::write_animation(out, &self.picture, self.animation, fill))?;
            }
            AnimationTarget::Gif => self.outputs[0].write(|out| {
                let palette = Palette::of(&colors((self.sample)()?, pixel));
                let mut own = vec![0; if pixel == Pixel::Grey8 { width * height } else { 0 }];
                gif::write_animation(out, [width, height], &palette, self.animation, |frame, bytes| {
                    if pixel != Pixel::Grey8 {
                        return fill(frame, bytes);
                    }
                    fill(frame, &mut own)?;
                    gif::rgb_of_grey(&own, bytes);
                    Ok(())
                })
            })?,
            AnimationTarget::Frames(..) => {
                let mut bytes = vec![0; width * height * pixel.bytes()];
                let mut staged: Vec<Staged> = Vec::new();
                for (frame, sink) in (0..).zip(self.outputs) {
                    let Sink::File(output) = sink else { continue };
                    staged.push(file::stage(output, |out| {
                        fill(frame, &mut bytes)?;
                        png::write(out, &self.picture, |rows, part| {
                            let row = width * pixel.bytes();
                            part.copy_from_slice(&bytes[rows.start * row..rows.end * row]);
                            Ok(())
                        })
                    })?);
                }
                file::commit(staged)?;
            }
        }
        Ok(())
    }
}

/// The pixels as three bytes each.
fn colors(sample: Vec<u8>, pixel: Pixel) -> Vec<u8> {
    if pixel != Pixel::Grey8 {
        return sample;
    }
    let mut rgb = vec![0; 3 * sample.len()];
    gif::rgb_of_grey(&sample, &mut rgb);
    rgb
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_tell_what_is_written() {
        let frames = |before: &str, digits, after: &str| AnimationTarget::Frames(before.into(), digits, after.into());
        for (name, expect) in [
            ("a.png", AnimationTarget::Apng),
            ("a.GIF", AnimationTarget::Gif),
            ("x/view-%03d.png", frames("view-", 3, ".png")),
            ("%d.png", frames("", 1, ".png")),
        ] {
            assert_eq!(AnimationTarget::of(Path::new(name)), Ok(expect), "{name}");
        }
        for (name, message) in [
            ("a", "no file extension"),
            ("a.mp4", ".mp4"),
            ("a%.png", "not a frame number"),
            ("a%03x.png", "not a frame number"),
            ("a%d%d.png", "not a frame number"),
            ("a%99d.png", "not a frame number"),
            ("a%03d.gif", ".gif"),
        ] {
            let error = AnimationTarget::of(Path::new(name)).unwrap_err();
            assert!(error.contains(message), "{name}: {error}");
        }
    }
}
