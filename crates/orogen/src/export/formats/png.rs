//! Grey pictures.

use std::io;

use crate::export::files::Files;
use crate::export::format::{Format, aside, whole};
use crate::export::notes;
use crate::export::options::Options;
use crate::export::subject::Subject;
use crate::format::npy;
use crate::format::png::{self, Picture, Pixel};

/// The format.
pub static FORMAT: Format = Format {
    name: "png",
    aliases: &[],
    about: "16-bit grey picture, black the lowest and white the highest of the window",
    options: &[],
    channels: 1,
    memory: |window, _| aside(whole(window)),
    write,
};

fn write(subject: &mut Subject, _: &Options, files: &mut Files) -> io::Result<String> {
    let window = *subject.window();
    let mut spool = files.spool();
    files.write(|out| {
        // Which height is white is known at the end: the heights wait for it.
        subject.rows(|band| npy::write_rows(&mut spool, band[0].data()))?;
        let levels = subject.levels();
        let notes = notes::of_heights(window.cell, &levels);
        let notes: Vec<(&str, &str)> = notes.iter().map(|(keyword, text)| (*keyword, text.as_str())).collect();
        let picture = Picture { width: window.width, height: window.height, pixel: Pixel::Grey16, notes: &notes };
        let mut heights = Vec::new();
        png::write(out, &picture, |rows, pixels| {
            heights.resize(2 * pixels.len(), 0);
            spool.read(4 * (rows.start * window.width) as u64, &mut heights)?;
            for (pixel, height) in pixels.chunks_exact_mut(2).zip(heights.chunks_exact(4)) {
                let height = f32::from_le_bytes([height[0], height[1], height[2], height[3]]);
                pixel.copy_from_slice(&levels.to_u16(height).to_be_bytes());
            }
            Ok(())
        })
    })?;
    let levels = subject.levels();
    Ok(match levels.is_flat() {
        true => format!("flat at {} and so all black", levels.low()),
        false => format!("0 is {} and 65535 is {}", levels.low(), levels.high()),
    })
}
