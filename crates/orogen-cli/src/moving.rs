//! Moving pictures: animations in one file, or frames in files of their own.

use std::io;
use std::path::Path;

use orogen::file::{self, OutputPolicy, Staged};
use orogen::format::gif::{self, Palette};
use orogen::format::png::{self, Animation, Picture, Pixel};

use crate::failure::Failure;
use crate::sink::{Sink, is_stdout};

/// What frames are written to.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum AnimationTarget {
    /// One PNG that moves (APNG).
    Apng,
    /// One GIF.
    Gif,
    /// A PNG for each frame: what stands before the number, how many digits it has at least, and what stands behind it.
    Frames(String, usize, String),
}

impl AnimationTarget {
    /// What a file's name tells: `.png` and `.gif` are animations, `view-%03d.png` is a file for each frame, and standard output gets an
    /// APNG; or a message that says why it tells nothing.
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

    /// The files that so many frames go into, if what is there may be replaced.
    pub fn outputs(&self, out: &Path, frames: u32, policy: &OutputPolicy) -> Result<Vec<Sink>, Failure> {
        match self {
            AnimationTarget::Apng | AnimationTarget::Gif => Ok(vec![Sink::new(out, policy)?]),
            AnimationTarget::Frames(before, digits, after) => (0..frames)
                .map(|frame| Sink::new(&out.with_file_name(format!("{before}{frame:0digits$}{after}")), policy))
                .collect(),
        }
    }

    /// Bytes that writing frames of so many pixels takes, their own three a pixel not counted.
    pub fn reserved(&self, pixels: u64) -> u64 {
        match self {
            // What is filtered and what is packed.
            AnimationTarget::Apng | AnimationTarget::Frames(..) => pixels.saturating_mul(6),
            // Indices, those before them, and the tables of the packer.
            AnimationTarget::Gif => pixels.saturating_mul(2).saturating_add(4 << 20),
        }
    }
}

/// A moving picture about to be written.
pub struct Moving<'a> {
    /// Where to: what [`AnimationTarget::outputs`] made.
    pub outputs: &'a [Sink],
    /// As what.
    pub target: &'a AnimationTarget,
    /// What each frame is.
    pub picture: Picture<'a>,
    /// How many there are, and how long each is shown.
    pub animation: Animation,
    /// Pixels in whose colours a GIF is shown, of the picture's kind.
    pub sample: &'a dyn Fn() -> io::Result<Vec<u8>>,
}

impl Moving<'_> {
    /// Writes all frames as `fill` makes them, or none: it is given the frame's number, from 0, and its bytes.
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
                    bytes.chunks_exact_mut(3).zip(&own).for_each(|(rgb, grey)| rgb.fill(*grey));
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

/// Three bytes a pixel.
fn colors(sample: Vec<u8>, pixel: Pixel) -> Vec<u8> {
    if pixel == Pixel::Grey8 { sample.iter().flat_map(|grey| [*grey; 3]).collect() } else { sample }
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
