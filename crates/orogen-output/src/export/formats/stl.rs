//! Stereolithography: a solid for printing.

use std::io;

use crate::export::files::Files;
use crate::export::format::Format;
use crate::export::layer_source::LayerSource;
use crate::export::mesh::{EXAGGERATION, HEIGHT_CURVE, MAX_ERROR, Prepared, memory};
use crate::export::options::{OptionSpec, Options, ValueKind};
use crate::mesh::stl::{Print, write as write_solid};
use crate::proportions;
use orogen_io::format::levels::{NO_SAMPLES, extremes};

const PRINT_SIZE: OptionSpec = OptionSpec {
    name: "print-size",
    value: "MM",
    about: "Length of the longer side in millimetres [default: 150]",
    value_kind: ValueKind::Number(1.0, 1e5),
};

const BASE: OptionSpec = OptionSpec {
    name: "base",
    value: "MM",
    about: "Thickness of the base below the lowest sample, in millimetres [default: 3]",
    value_kind: ValueKind::Number(0.1, 1e4),
};

/// The format.
pub static FORMAT: Format = Format {
    name: "stl",
    aliases: &[],
    about: "STL solid for 3D printing (binary), with walls and a base: millimetres, Z up",
    options: &[MAX_ERROR, EXAGGERATION, HEIGHT_CURVE, PRINT_SIZE, BASE],
    channels: 1,
    features: false,
    memory,
    write,
};

fn write(source: &mut LayerSource, options: &Options, files: &mut Files) -> io::Result<String> {
    let mesh = Prepared::new(source, options, 1)?;
    let size = options.number(PRINT_SIZE.name).unwrap_or(150.0);
    let print = Print { size, base: options.number(BASE.name).unwrap_or(3.0) };
    let mut height = 0.0;
    files.write(|out| {
        height = write_solid(out, &mesh.surface(0, false), &print)?;
        Ok(())
    })?;
    let [low, high] = extremes(NO_SAMPLES, mesh.grid.data());
    let window = mesh.grid.window();
    let width = window.width.max(window.height) as f64 * window.cell;
    let warning = proportions::warning(f64::from(high) - f64::from(low), width, f64::from(mesh.exaggeration()));
    let warning = warning.map_or(String::new(), |warning| format!("\nwarning: {warning}"));
    Ok(format!("{} and a base, {size} mm along and {height:.1} mm high{warning}", mesh.words()))
}
