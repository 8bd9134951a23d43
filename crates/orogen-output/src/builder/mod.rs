//! Worlds larger than memory, built tile by tile into files, and never lost.
//!
//! An [`spec::BuildSpec`] says what is wanted: which window, which layers, as what. A [`run::Build`] makes it: tile after tile, each
//! written whole and entered with its checksum into a journal. Whatever interrupts it (a kill, a full disk, a power cut), the same
//! order resumed keeps the tiles that are sound, makes the others and ends with the same bytes as if nothing had happened.
//!
//! **What lies where.** Tiles that are files of the result go to their place at once. What is needed only on the way (packed tiles of
//! a file that is put together at the end, coarser samples) lies in a folder beside the result, `OUT.build`, together with the
//! journal and a lock. When all is done, only the journal is left there: with it a later resume can tell whether the result is
//! still sound, and make again what is not.
//!
//! **What makes it safe.** Nothing is believed that was not checked: a tile counts as made if the journal has an entry for it *and* the
//! file has the length and SHA-256 of that entry. So files need not be synced one by one; what a power cut has taken is found and made
//! again. All is synced once, before the result is declared finished.

mod blocks;
mod cog;
mod digest;
mod folder;
mod identity;
mod job;
mod journal;
mod output_store;
pub mod run;
mod samples;
pub mod spec;
mod target;
mod work_dir;
pub mod xyz;
mod zarr;

#[cfg(test)]
mod tests;
