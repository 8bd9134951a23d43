//! A drawn map sheet, and its file.

use std::io::{self, Write};

use super::sheet_format::SheetFormat;
use crate::export::place;
use orogen_engine::budget::Reservation;
use orogen_grid::error::Result;
use orogen_grid::grid::Window;
use orogen_grid::progress::Progress;
use orogen_grid::words::number;
use orogen_io::file::cancellable::CancellableWriter;
use orogen_io::file::{self, Output};
use orogen_io::format::affine::Affine;
use orogen_io::format::dem::Georeference;
use orogen_io::format::notes::SOFTWARE;
use orogen_output::sheet::draw::Sheet;
use orogen_output::sheet::geometry::{Rect, Size};
use orogen_output::sheet::{pdf, raster, vector};

/// A drawn map sheet.
pub struct DrawnMap {
    pub(super) format: SheetFormat,
    /// What the colors show, for the final message.
    pub(super) what: String,
    pub(super) title: String,
    /// The position on a map, if it is written beside a picture.
    pub(super) map: Option<Georeference>,
    pub(super) window: Window,
    pub(super) sheet: Sheet,
    pub(super) warnings: Vec<String>,
    pub(super) writing: Progress,
    pub(super) _reserved: Reservation,
}

impl DrawnMap {
    /// Messages about samples that are NaN or infinite.
    #[must_use]
    pub fn warnings(&self) -> &[String] {
        &self.warnings
    }

    /// Characters of its texts that no installed font has; they are left out.
    #[must_use]
    pub fn lacking(&self) -> &[char] {
        &self.sheet.lacking
    }

    /// A description: its layer, its size, its samples, and its contours.
    #[must_use]
    pub fn words(&self) -> String {
        let Size { width, height } = self.sheet.scene.size;
        let size = match self.format {
            SheetFormat::Png => {
                let [width, height] = raster::pixels(&self.sheet.scene, self.sheet.dpi);
                format!("{width} x {height} pixels")
            }
            _ => format!("{width:.0} x {height:.0} mm"),
        };
        let contours = match (self.sheet.interval, self.sheet.levels.as_slice()) {
            (Some(interval), _) => format!(", contours {} m apart", number(interval)),
            (None, []) => String::new(),
            (None, levels) => format!(", contours at {} m", numbers(levels)),
        };
        let Window { width, height, cell, .. } = self.window;
        format!("{}{size}, {width} x {height} samples of {} m{contours}", self.what, number(cell))
    }

    /// Writes the sheet to a file, with georeferencing files beside a picture, atomically.
    ///
    /// # Errors
    /// If a file cannot be written, or the work was cancelled.
    pub fn to_file(&self, output: &Output) -> Result<()> {
        let beside = match (self.format, &self.map) {
            (SheetFormat::Png, Some(map)) => place::stage(output, map, self.on_page(&map.affine(&self.window, false)))?,
            _ => Vec::new(),
        };
        file::write_whole(output, |out| self.to_stream(out))?;
        file::commit(beside)
    }

    /// Writes the sheet to a stream.
    ///
    /// # Errors
    /// If the stream fails, or the work was cancelled.
    pub fn to_stream(&self, out: &mut dyn Write) -> io::Result<()> {
        let out = &mut CancellableWriter { out, progress: &self.writing };
        let scene = &self.sheet.scene;
        match self.format {
            SheetFormat::Png => {
                let mut notes = vec![("Software", SOFTWARE)];
                // PNG text chunks contain Latin-1 only.
                if self.title.chars().all(|letter| letter <= '\u{ff}' && !letter.is_control()) {
                    notes.push(("Title", &self.title));
                }
                raster::draw(scene, self.sheet.dpi).write_png(out, &notes)?;
            }
            SheetFormat::Svg => vector::write(out, scene)?,
            SheetFormat::Pdf => pdf::write(out, scene)?,
        }
        self.writing.finish();
        Ok(())
    }

    /// The transform from pixels of the page to map coordinates, from that of the ground on it.
    fn on_page(&self, samples: &Affine) -> Affine {
        let Rect { left, top, width, height } = self.sheet.ground;
        let [left, top, width, height] =
            [left, top, width, height].map(|millimetres| f64::from(millimetres) * self.sheet.dpi / 25.4);
        let scale = [(self.window.width - 1) as f64 / width, (self.window.height - 1) as f64 / height];
        samples.resampled(scale, [(0.5 - left) * scale[0], (0.5 - top) * scale[1]])
    }
}

/// The first numbers of a list, and how many more there are.
pub(super) fn numbers(list: &[f64]) -> String {
    const SHOWN: usize = 8;
    let shown: Vec<String> = list.iter().take(SHOWN).map(|value| number(*value)).collect();
    match list.len().saturating_sub(SHOWN) {
        0 => shown.join(", "),
        more => format!("{} and {more} more", shown.join(", ")),
    }
}
