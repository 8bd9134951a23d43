//! Builds of worlds larger than memory, tile by tile, which can be resumed after any interruption.
//!
//! A [`spec::BuildSpec`] states the window, the layers and the form of the result. A [`run::Build`] makes it tile by
//! tile; each tile is written atomically and recorded with its checksum in a journal. After any interruption (a kill, a
//! full disk, a power cut), a resumed build keeps the intact tiles, makes the others and ends with the same bytes as an
//! uninterrupted build.
//!
//! **Files.** Tiles that are files of the result are written to their final place. Temporary files (compressed tiles of
//! a file that is assembled at the end, coarser samples) are in a folder next to the result, `OUT.build`, with the
//! journal and a lock. After completion only the journal remains there; a later resume uses it to check whether the
//! result is still intact, and to make damaged parts again.
//!
//! **Parts.** Processes on several machines can make one result together: each makes the tiles of its
//! [part](BuildSpec::with_part), and the last one finishes the result. Until then, the folder next to the result has a
//! journal and a lock of each part in `parts`.
//!
//! **Safety.** A tile counts as complete only if the journal has an entry for it *and* the file has the length and
//! SHA-256 of that entry. Files therefore need not be synced one by one: files lost in a power cut are detected and
//! made again. All files are synced once before the result is declared complete.

mod blocks;
mod cog;
mod digest;
mod folder;
mod form_window;
mod identity;
mod job;
#[doc(hidden)]
pub mod journal;
mod output_store;
mod part;
mod part_folder;
mod part_run;
mod pmtiles;
#[doc(hidden)]
pub mod run;
mod samples;
#[doc(hidden)]
pub mod spec;
mod target;
#[doc(hidden)]
pub mod tile_grid;
mod work_dir;
#[doc(hidden)]
pub mod xyz;
mod zarr;
#[doc(hidden)]
pub mod zarr_layout;

pub use run::{Build, Report};
pub use spec::{BuildSpec, Form, Samples};

#[cfg(test)]
mod tests;
