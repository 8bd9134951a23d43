//! Parts of a real place: reads a window of a large file without the rest of it, with bit-identical heights.

use std::path::Path;

use super::fill::fill;
use sha2::{Digest, Sha256};

use super::open;
use super::prepared::{PreparedDem, filled, hash, lattice};
use super::square::Layout;
use crate::format::dem::{Dem, Part, Placement, Request, afford_beside, refused};
use crate::format::import;
use crate::samples;
use orogen_grid::error::Result;
use orogen_grid::grid::{Grid, Window};

/// Sides of the blocks around which holes are filled, as powers of two: the smallest, and the step to larger ones.
const BLOCK: u32 = 6;
const NEXT: u32 = 2;

/// Properties of a file that are known without its samples.
#[derive(Debug)]
pub(super) struct Outline {
    /// Columns and rows of the file.
    size: [usize; 2],
    place: Placement,
    steps: [f64; 2],
    layout: Layout,
}

impl Outline {
    /// `None` if the file cannot be read in parts.
    pub fn read(path: &Path, band: Option<u32>) -> Result<Option<Outline>> {
        let name = path.display().to_string();
        let (path, own) = open::split(path);
        let band = own.or(band);
        if !import::reads_parts(&path) || crate::fs::is_dir(&path) {
            return Ok(None);
        }
        let (size, Some(place)) = import::head(&path, band)? else { return Ok(None) };
        let (steps, layout) = lattice(size, Some(&place), None).map_err(|why| refused(&name, why))?;
        Ok(Some(Outline { size, place, steps, layout }))
    }

    fn prepared(&self, grid: Grid) -> PreparedDem {
        PreparedDem {
            grid,
            size: self.layout.size,
            missing: 0,
            samples: 0,
            georeference: Some(self.layout.georeference(&self.place, self.steps)),
            notes: Vec::new(),
            hash: [0; 32],
        }
    }

    /// The place without its heights.
    pub fn empty(&self) -> PreparedDem {
        self.prepared(Grid::filled(Window::new(1, 1, self.layout.cell), f32::NAN))
    }

    /// The message that samples are resampled; `None` if they are not.
    pub fn note(&self) -> Option<String> {
        self.layout.note(self.steps, self.place.unit.degrees().is_some())
    }

    /// The samples of the lattice inside `window`, and the samples of the file that they are computed from. `None` if
    /// there are none.
    fn parts(&self, window: &Window) -> Option<[Part; 2]> {
        let [width, height] = self.layout.size;
        let inside = window.intersection(&Window::new(width, height, window.cell));
        let part = Part { from: [inside.x as usize, inside.y as usize], size: [inside.width, inside.height] };
        (!inside.is_empty()).then(|| [part, self.layout.sources(self.size, part)])
    }

    /// Memory of heights while they are prepared, in bytes: `read` samples of the file, and `laid` on the lattice.
    fn preparing(&self, read: [usize; 2], laid: [usize; 2]) -> u64 {
        let laid = if self.layout.is_square() { [0; 2] } else { laid };
        [read, laid].iter().fold(0, |sum: u64, [width, height]| {
            sum.saturating_add((*width as u64).saturating_mul(*height as u64).saturating_mul(4))
        })
    }

    /// Memory for reading the whole file, in bytes.
    pub fn whole_memory(&self) -> u64 {
        self.preparing(self.size, self.layout.size)
    }

    /// Memory for reading a window, in bytes, with small holes.
    pub fn memory(&self, window: &Window) -> u64 {
        let Some([part, sources]) = self.parts(window) else { return 0 };
        let around = around(sources, self.size, 1 << BLOCK).size;
        let heights = self.preparing(around, [0; 2]);
        heights.saturating_add(heights / 3).max(self.preparing(sources.size, part.size))
    }

    /// [`PreparedDem::part`] of the file of this outline. `None` also if the heights that fill its holes need more than
    /// `most` bytes.
    pub fn part(&self, path: &Path, window: &Window, request: Request, most: u64) -> Result<Option<PreparedDem>> {
        let Some([part, sources]) = self.parts(window) else { return Ok(None) };
        let refuse = |why: String| refused(&path.display().to_string(), why);
        let Some((mut dem, missing)) = complete(path, self.size, sources, request, most)? else { return Ok(None) };
        let samples = dem.heights.len();
        let laid = if self.layout.is_square() { 0 } else { 4 * (part.size[0] * part.size[1]) as u64 };
        afford_beside(samples, laid, request.allowed).map_err(refuse)?;
        let mut notes = std::mem::take(&mut dem.notes);
        notes.extend((missing > 0).then(|| filled(missing, samples)));
        notes.extend(self.note());
        let grid = self.layout.apply_part(dem, sources.from, part);
        let grid = grid.ok_or_else(|| refuse("its number of samples differs from its header".into()))?;
        let hash = part_hash(&grid);
        Ok(Some(PreparedDem { missing, samples, notes, hash, ..self.prepared(grid) }))
    }
}

impl PreparedDem {
    /// The size and position of a file without its heights; `None` if it cannot be read in parts.
    ///
    /// # Errors
    /// If the file cannot be read, or the distance between its samples is out of range.
    pub fn outline(path: &Path) -> Result<Option<PreparedDem>> {
        Ok(Outline::read(path, None)?.map(|outline| outline.empty()))
    }

    /// The part of a file inside `window`, whose cell must be that of the file's lattice. Heights are bit-identical to
    /// those of the whole file ([`PreparedDem::read`]). Only blocks of the file that overlap the window are read, and
    /// around holes as many more as filling them needs. `None` if the file cannot be read in parts, or has no samples
    /// in the window.
    ///
    /// # Errors
    /// The errors of [`PreparedDem::read`].
    pub fn part(path: &Path, window: &Window, request: impl Into<Request>) -> Result<Option<PreparedDem>> {
        let request = request.into();
        match Outline::read(path, request.band)? {
            Some(outline) => outline.part(path, window, request, u64::MAX),
            None => Ok(None),
        }
    }
}

/// The hash of a part. It differs from the hash of a whole place with the same heights.
fn part_hash(grid: &Grid) -> [u8; 32] {
    let mut digest = Sha256::new();
    digest.update(hash(grid));
    [grid.window().x, grid.window().y].iter().for_each(|at| digest.update(at.to_le_bytes()));
    digest.finalize().into()
}

/// The samples of a part of a file with holes filled as in the whole file, and the number of holes. `None` if the
/// heights that fill them need more than `most` bytes.
fn complete(path: &Path, size: [usize; 2], part: Part, request: Request, most: u64) -> Result<Option<(Dem, usize)>> {
    let read = |part: Part| open::read(path, request.with_part(Some(part)));
    let dem = read(part)?;
    let missing = dem.missing();
    if missing == 0 {
        return Ok(Some((dem, 0)));
    }
    drop(dem);
    let mut power = BLOCK;
    loop {
        let around = around(part, size, 1 << power);
        if 4 * (around.size[0] * around.size[1]) as u64 > most {
            return Ok(None);
        }
        let whole = around == Part::whole(size);
        let mut wide = if whole { open::read(path, request)? } else { read(around)? };
        if whole || every_block_has_a_height(&wide, 1 << power) {
            let refuse = |why: String| refused(&path.display().to_string(), why);
            afford_beside(wide.heights.len(), wide.heights.len() as u64 / 3 * 4, request.allowed).map_err(refuse)?;
            fill(&mut wide.heights, wide.width, wide.height);
            let from = [part.from[0] - around.from[0], part.from[1] - around.from[1]];
            return Ok(Some((wide.cropped(Part { from, ..part }).map_err(refuse)?, missing)));
        }
        power += NEXT;
    }
}

/// The blocks of `side` by `side` samples of a raster that a part overlaps, and one more on each side.
///
/// [`fill`] fills a missing sample from the means of blocks. If all blocks around have a height, a sample at least one
/// block from the edge does not depend on blocks further away: each level of the pyramid reads one mean further than
/// the next coarser one, which adds up to less than a block.
fn around(part: Part, size: [usize; 2], side: usize) -> Part {
    let from = part.from.map(|at| (at / side).saturating_sub(1) * side);
    let end = |k: usize| ((part.end()[k].div_ceil(side) + 1) * side).min(size[k]);
    Part { from, size: [end(0) - from[0], end(1) - from[1]] }
}

fn every_block_has_a_height(dem: &Dem, side: usize) -> bool {
    let across = dem.width.div_ceil(side);
    dem.heights.chunks(dem.width * side).all(|rows| {
        let mut found = vec![false; across];
        for row in rows.chunks(dem.width) {
            for (found, piece) in found.iter_mut().zip(row.chunks(side)) {
                *found = *found || samples::has_height(piece);
            }
        }
        found.iter().all(|found| *found)
    })
}
