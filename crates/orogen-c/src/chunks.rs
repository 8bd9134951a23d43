//! The chunks of terrain around a viewer.

use engine::{ChunkId, Chunks, LodConfig};

use crate::handle::{borrowed, borrowed_mut, buffer, free};
use crate::status::{OrogenStatus, guarded, made};
use crate::world::{OrogenWindow, OrogenWorld};

/// The chunks around a viewer: which to make, nearest first, and which to drop. One thread at a time may use it; the
/// chunks themselves are made from samplers on any thread.
pub struct OrogenChunks {
    chunks: Chunks,
}

/// A chunk: a square of terrain at a level of detail. It is always the same terrain.
#[repr(C)]
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct OrogenChunk {
    /// Column among the chunks of its level.
    pub x: i64,
    /// Row among the chunks of its level.
    pub y: i64,
    /// Level of detail; 0 is the finest.
    pub level: u8,
}

impl From<ChunkId> for OrogenChunk {
    fn from(ChunkId { level, y, x }: ChunkId) -> OrogenChunk {
        OrogenChunk { x, y, level }
    }
}

impl From<OrogenChunk> for ChunkId {
    fn from(OrogenChunk { x, y, level }: OrogenChunk) -> ChunkId {
        ChunkId { level, y, x }
    }
}

/// How the terrain around a viewer is divided. `orogen_lod_default` has the defaults.
#[repr(C)]
#[derive(Debug, Clone, Copy)]
pub struct OrogenLod {
    /// Cells along a side of a chunk: an even number from 2 to 4096. A chunk has one sample more.
    pub cells: usize,
    /// Distance between samples at level 0, in metres.
    pub cell: f64,
    /// Number of levels, 1 to 24; each has cells twice as large as the one before.
    pub levels: u8,
    /// Distance to the viewer below which a chunk is replaced by four finer ones, in sides of the chunk.
    pub detail: f64,
    /// Range of sight, in metres.
    pub range: f64,
    /// How much farther than that a chunk is kept, in sides of chunks, 0 to 1.
    pub slack: f64,
}

/// The default division.
#[unsafe(no_mangle)]
pub extern "C" fn orogen_lod_default() -> OrogenLod {
    let LodConfig { cells, cell, levels, detail, range, slack, .. } = LodConfig::new();
    OrogenLod { cells, cell, levels, detail, range, slack }
}

/// The chunks of a world around a viewer, initially none. Null after an error. Free it by `orogen_chunks_free`.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn orogen_chunks_new(world: *const OrogenWorld, lod: OrogenLod) -> *mut OrogenChunks {
    made(|| {
        // SAFETY: the contract of the header.
        let world = unsafe { borrowed(world, "world") }?;
        let lod = LodConfig::new()
            .with_cells(lod.cells)
            .with_cell(lod.cell)
            .with_levels(lod.levels)
            .with_detail(lod.detail)
            .with_range(lod.range)
            .with_slack(lod.slack);
        Ok(OrogenChunks { chunks: world.world.chunks(lod)? })
    })
}

/// Frees chunks. Null does nothing.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn orogen_chunks_free(chunks: *mut OrogenChunks) {
    // SAFETY: the contract of the header.
    unsafe { free(chunks) }
}

/// Sets the position of the viewer, in metres east and south of the origin.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn orogen_chunks_set_viewer(chunks: *mut OrogenChunks, x: f64, y: f64) -> OrogenStatus {
    guarded(|| {
        // SAFETY: the contract of the header.
        unsafe { borrowed_mut(chunks, "chunks") }?.chunks.set_viewer(x, y)
    })
}

/// The nearest chunk that is to be made and was not yet taken. `has` is false if there is none.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn orogen_chunks_take(
    chunks: *mut OrogenChunks,
    chunk: *mut OrogenChunk,
    has: *mut bool,
) -> OrogenStatus {
    // SAFETY: the contract of the header.
    unsafe { next(chunks, chunk, has, Chunks::take) }
}

/// A chunk that is to be dropped, because what replaces it has been made. `has` is false if there is none.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn orogen_chunks_evict(
    chunks: *mut OrogenChunks,
    chunk: *mut OrogenChunk,
    has: *mut bool,
) -> OrogenStatus {
    // SAFETY: the contract of the header.
    unsafe { next(chunks, chunk, has, Chunks::evict) }
}

/// # Safety
/// As for the calls above.
unsafe fn next(
    chunks: *mut OrogenChunks,
    chunk: *mut OrogenChunk,
    has: *mut bool,
    ask: fn(&mut Chunks) -> Option<ChunkId>,
) -> OrogenStatus {
    guarded(|| {
        // SAFETY: the contract of the header.
        let (chunks, chunk, has) =
            unsafe { (borrowed_mut(chunks, "chunks")?, buffer(chunk, 1, "chunk")?, buffer(has, 1, "has")?) };
        let found = ask(&mut chunks.chunks);
        has[0] = found.is_some();
        if let Some(id) = found {
            chunk[0] = id.into();
        }
        Ok(())
    })
}

/// Says that a chunk that was taken has been made.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn orogen_chunks_done(chunks: *mut OrogenChunks, chunk: OrogenChunk) -> OrogenStatus {
    guarded(|| {
        // SAFETY: the contract of the header.
        unsafe { borrowed_mut(chunks, "chunks") }?.chunks.done(chunk.into());
        Ok(())
    })
}

/// Says that a chunk that was taken could not be made; it is taken again after all others.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn orogen_chunks_forget(chunks: *mut OrogenChunks, chunk: OrogenChunk) -> OrogenStatus {
    guarded(|| {
        // SAFETY: the contract of the header.
        unsafe { borrowed_mut(chunks, "chunks") }?.chunks.forget(chunk.into());
        Ok(())
    })
}

/// The samples of a chunk, including those on its far edges, which are its neighbors' first.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn orogen_chunks_window(
    chunks: *const OrogenChunks,
    chunk: OrogenChunk,
    window: *mut OrogenWindow,
) -> OrogenStatus {
    guarded(|| {
        // SAFETY: the contract of the header.
        let (chunks, window) = unsafe { (borrowed(chunks, "chunks")?, buffer(window, 1, "window")?) };
        window[0] = chunks.chunks.window(chunk.into()).into();
        Ok(())
    })
}
