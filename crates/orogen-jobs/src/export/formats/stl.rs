//! Stereolithography: a solid for printing.

use std::io;

use crate::export::files::Files;
use crate::export::format::Format;
use crate::export::layer_source::LayerSource;
use crate::export::solid::{OPTIONS, PrintJob, memory};
use crate::options::Options;
use orogen_output::mesh::stl::write as write_solid;

/// The format.
pub static FORMAT: Format = Format {
    name: "stl",
    aliases: &[],
    about: "STL solid for 3D printing (binary), with walls and a base: millimetres, Z up",
    options: OPTIONS,
    channels: 1,
    features: false,
    memory,
    write,
};

fn write(source: &mut LayerSource, options: &Options, files: &mut Files) -> io::Result<String> {
    let job = PrintJob::new(source, options)?;
    files.write(|out| write_solid(out, &job.solid, &job.writing))?;
    Ok(job.words())
}
