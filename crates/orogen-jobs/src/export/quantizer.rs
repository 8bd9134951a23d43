//! Conversion of samples to integers, with a range that is known before the first one is written.

use std::io::{self, Write};

use super::files::Files;
use super::format::refuse;
use super::layer_source::LayerSource;
use crate::options::{OptionSpec, Options, ValueKind};
use orogen_engine::layer::LayerKind;
use orogen_io::format::levels::Levels;
use orogen_io::format::npy;
use orogen_io::samples;
use orogen_io::spool::Spool;

/// The option for the range.
pub const RANGE: OptionSpec = OptionSpec::new("range", "LOW,HIGH", ValueKind::Range).with_about(
    "Values of the lowest and the highest level, to use the same scale for several windows [default: minimum \
             and maximum of this window]",
);

/// The option for the order of rows.
pub const FIRST_ROW: OptionSpec = OptionSpec::new("first-row", "SIDE", ValueKind::Word(&["north", "south"]))
    .with_about("Side of the first row, north or south [default: north]");

/// The option for 8 or 16 bits.
pub const BITS: OptionSpec = OptionSpec::new("bits", "N", ValueKind::Word(&["8", "16"]))
    .with_about("Bits per sample, 8 or 16 [default: 16, for normals 8]");

/// The largest level for the given options.
#[must_use]
pub fn most(options: &Options) -> u16 {
    if options.word("bits") == Some("8") { 255 } else { 65535 }
}

/// Whether the rows start in the south.
#[must_use]
pub fn from_south(options: &Options) -> bool {
    options.word("first-row") == Some("south")
}

/// The rows of a layer of plain numbers, and the range of the levels.
pub struct Quantizer<'s, 'w> {
    source: &'s mut LayerSource<'w>,
    levels: Levels,
    /// The samples, if they had to be computed in advance for their range or the order of rows.
    kept: Option<Spool>,
    from_south: bool,
}

/// Number of samples that are read back at a time.
const PIECE: usize = 1 << 20;

impl<'s, 'w> Quantizer<'s, 'w> {
    /// Determines the range: the requested one; for labels, the labels themselves; for a layer without a unit and with
    /// all samples within 0 to 1 (a mask), 0 to 1; otherwise the minimum and maximum of the window.
    ///
    /// Fails if the source fails, or if labels exceed the largest level `most`.
    pub fn new(source: &'s mut LayerSource<'w>, options: &Options, most: u16, files: &Files) -> io::Result<Self> {
        let asked = options.pair("range").map(|[low, high]| Levels::new(low as f32, high as f32));
        let from_south = from_south(options);
        let kept = match asked.is_none() || from_south {
            true => Some(keep(source, files)?),
            false => None,
        };
        let levels = match asked {
            Some(levels) => levels,
            None => natural(source, most)?,
        };
        Ok(Quantizer { source, levels, kept, from_south })
    }

    /// The rows without conversion; they are spooled only to reverse their order.
    ///
    /// Fails if the source fails.
    pub fn plain(source: &'s mut LayerSource<'w>, options: &Options, files: &Files) -> io::Result<Self> {
        let from_south = from_south(options);
        let kept = if from_south { Some(keep(source, files)?) } else { None };
        Ok(Quantizer { source, levels: Levels::new(0.0, 0.0), kept, from_south })
    }

    /// The range of the levels.
    #[must_use]
    pub fn levels(&self) -> Levels {
        self.levels
    }

    /// Calls `visit` with all samples, in whole rows, in the requested order.
    ///
    /// Fails if `visit`, the source or the spool fails.
    pub fn rows(&mut self, mut visit: impl FnMut(&[f32]) -> io::Result<()>) -> io::Result<()> {
        let Some(spool) = &mut self.kept else {
            return self.source.rows(|band| visit(band[0].data()));
        };
        let (width, height) = (self.source.window().width, self.source.window().height);
        let at_once = (PIECE / width.max(1)).max(1);
        let most = at_once.min(height) * width;
        let (mut bytes, mut samples) = (vec![0; 4 * most], vec![0.0; most]);
        for first in (0..height).step_by(at_once) {
            let rows = at_once.min(height - first);
            let start = if self.from_south { height - first - rows } else { first };
            let (bytes, samples) = (&mut bytes[..4 * rows * width], &mut samples[..rows * width]);
            spool.read(4 * (start * width) as u64, bytes)?;
            match self.from_south {
                true => {
                    let rows = samples.chunks_exact_mut(width).zip(bytes.rchunks_exact(4 * width));
                    rows.for_each(|(samples, bytes)| samples::read_bytes(samples, bytes));
                }
                false => samples::read_bytes(samples, bytes),
            }
            visit(samples)?;
        }
        Ok(())
    }
}

/// Computes the samples and spools them.
fn keep(source: &mut LayerSource, files: &Files) -> io::Result<Spool> {
    let mut spool = files.spool();
    source.rows(|band| npy::write_rows(&mut spool, band[0].data()))?;
    Ok(spool)
}

/// The default range of a layer, for a source whose rows were computed.
///
/// Fails if labels exceed the largest level `most`.
pub fn natural(source: &LayerSource, most: u16) -> io::Result<Levels> {
    let levels = source.levels();
    match source.kind() {
        LayerKind::Label if levels.low() < 0.0 || levels.high() > f32::from(most) => refuse(format!(
            "the numbers of `{}`, {} to {}, do not fit in 0 to {most}; use npy, r32, exr or tif, or set --range",
            source.layer(),
            levels.low(),
            levels.high()
        )),
        LayerKind::Label => Ok(Levels::new(0.0, f32::from(most))),
        _ if is_mask(source, &levels) => Ok(Levels::new(0.0, 1.0)),
        _ => Ok(levels),
    }
}

fn is_mask(source: &LayerSource, levels: &Levels) -> bool {
    source.unit().is_empty() && levels.low() >= 0.0 && levels.high() <= 1.0 && levels.high() > 0.0
}

/// Writes samples as levels of one byte, or of two in big-endian order.
pub fn write_levels(out: &mut dyn Write, samples: &[f32], levels: &Levels, most: u16) -> io::Result<()> {
    let mut bytes = Vec::new();
    levels.append_bytes(&mut bytes, samples, most);
    out.write_all(&bytes)
}

/// A description of the range of levels.
#[must_use]
pub fn words(levels: &Levels, most: u16) -> String {
    match levels.is_flat() {
        true => format!("flat at {} and so all 0", levels.low()),
        false => format!("0 is {} and {most} is {}", levels.low(), levels.high()),
    }
}
