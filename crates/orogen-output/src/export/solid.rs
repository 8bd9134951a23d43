//! Common parts of the formats for 3D printing: options, and the solid that they define.

use std::io;

use super::layer_source::LayerSource;
use super::memory::whole;
use super::mesh::{self, EXAGGERATION, HEIGHT_CURVE, MAX_ERROR, Prepared};
use super::options::{OptionSpec, Options, ValueKind};
use crate::mesh::solid::{Print, Solid};
use crate::proportions;
use orogen_grid::grid::Window;
use orogen_grid::progress::Progress;
use orogen_grid::words::number;
use orogen_io::format::levels::{NO_SAMPLES, extremes};

/// `--print-size`.
pub const PRINT_SIZE: OptionSpec = OptionSpec {
    name: "print-size",
    value: "MM",
    about: "Length of the longer side in millimetres [default: 150]",
    value_kind: ValueKind::Number(1.0, 1e5),
};

/// `--base`.
pub const BASE: OptionSpec = OptionSpec {
    name: "base",
    value: "MM",
    about: "Thickness of the base below the lowest sample, in millimetres [default: 3]",
    value_kind: ValueKind::Number(0.1, 1e4),
};

/// The options of solids.
pub const OPTIONS: &[OptionSpec] = &[MAX_ERROR, EXAGGERATION, HEIGHT_CURVE, PRINT_SIZE, BASE];

/// Memory of the solid of a window, in bytes, beside that of writing the file: the mesh, and 12 bytes for each vertex and triangle.
#[must_use]
pub fn memory(window: &Window, options: &Options) -> u64 {
    // Of an adaptive mesh, one sample in five becomes a vertex.
    let corners = if options.has(MAX_ERROR.name) { whole(window) / 5 } else { whole(window) };
    mesh::memory(window, options).saturating_add(corners.saturating_mul(9))
}

/// A solid that is ready to be written.
pub struct PrintJob {
    /// The solid.
    pub solid: Solid,
    /// Progress of writing it.
    pub writing: Progress,
    words: String,
}

impl PrintJob {
    /// The solid of the source's samples.
    ///
    /// Fails if the source fails, or if no solid can be made of it.
    pub fn new(source: &mut LayerSource, options: &Options) -> io::Result<PrintJob> {
        let mesh = Prepared::new(source, options, 1)?;
        let print = Print::new(options.number(PRINT_SIZE.name).unwrap_or(150.0))
            .with_base(options.number(BASE.name).unwrap_or(3.0));
        let surface = mesh.surface(0, false);
        let solid = Solid::new(&surface, &print)?;
        let [low, high] = extremes(NO_SAMPLES, mesh.grid.data());
        let window = mesh.grid.window();
        let width = window.width.max(window.height) as f64 * window.cell;
        let warning = proportions::warning(f64::from(high) - f64::from(low), width, f64::from(mesh.exaggeration()));
        let warning = warning.map_or(String::new(), |warning| format!("\nwarning: {warning}"));
        let size = solid.size().map(|side| number((side * 10.0).round() / 10.0)).join(" x ");
        let words = format!("{} and a base, {size} mm{warning}", mesh.words());
        Ok(PrintJob { solid, writing: surface.progress.cloned().unwrap_or_else(Progress::none), words })
    }

    /// The end of the message about it.
    #[must_use]
    pub fn words(self) -> String {
        self.words
    }
}
