//! Writing a layer over a window to one file, with a message about it.

use std::path::Path;

use orogen::export::ExportJob;
use orogen::export::job::Written;
use orogen::grid::words::number;
use orogen::{Window, World};

use crate::bar::Bar;
use crate::failure::Failure;
use crate::sink::Sink;
use crate::{finite, interrupt};

/// Writes the layer of `job` over a window to `sink`, the output for `out`. `origin` follows the size in the message.
///
/// # Errors
/// If making or writing fails, or no sample is finite.
pub fn write(
    job: ExportJob,
    world: &World,
    window: Window,
    (out, sink): (&Path, &Sink),
    origin: &str,
    quiet: bool,
) -> Result<(), Failure> {
    let job = job.with_window(window);
    let (bar, progress) = Bar::new(quiet);
    let Written { words, count, .. } = match sink {
        Sink::Stdout => sink.write(|out| job.to_stream(world, out, &progress))?,
        // Includes sidecars.
        Sink::File(output) => job
            .to_file(world, output, &progress)
            .map_err(|error| interrupt::explain(error.into(), "nothing was written"))?,
    };
    progress.finish();
    drop(bar);
    finite::tell(&job.layer, count)?;
    let size = format!("{} x {} samples of {} m", window.width, window.height, number(window.cell));
    sink.tell(quiet, &format!("{}: {}, {size}{origin}, {words}\n", out.display(), job.layer))
}
