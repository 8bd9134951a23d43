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
struct Outline {
    /// Columns and rows of the file.
    size: [usize; 2],
    place: Placement,
    steps: [f64; 2],
    layout: Layout,
}

impl Outline {
    /// `None` if the file cannot be read in parts.
    fn read(path: &Path) -> Result<Option<Outline>> {
        let name = path.display().to_string();
        let (path, band) = open::split(path);
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
}

impl PreparedDem {
    /// The size and position of a file without its heights; `None` if it cannot be read in parts.
    ///
    /// # Errors
    /// If the file cannot be read, or the distance between its samples is out of range.
    pub fn outline(path: &Path) -> Result<Option<PreparedDem>> {
        Ok(Outline::read(path)?.map(|outline| {
            let window = Window::new(1, 1, outline.layout.cell);
            outline.prepared(Grid::filled(window, f32::NAN))
        }))
    }

    /// The part of a file inside `window`, whose cell must be that of the file's lattice. Heights are bit-identical to
    /// those of the whole file ([`PreparedDem::read`]). Only blocks of the file that overlap the window are read, and
    /// around holes as many more as filling them needs. `None` if the file cannot be read in parts, or has no samples
    /// in the window.
    ///
    /// # Errors
    /// The errors of [`PreparedDem::read`].
    pub fn part(path: &Path, window: &Window, request: impl Into<Request>) -> Result<Option<PreparedDem>> {
        let Some(outline) = Outline::read(path)? else { return Ok(None) };
        let (layout, request) = (&outline.layout, request.into());
        let [width, height] = layout.size;
        let inside = window.intersection(&Window::new(width, height, window.cell));
        if inside.is_empty() {
            return Ok(None);
        }
        let part = Part { from: [inside.x as usize, inside.y as usize], size: [inside.width, inside.height] };
        let sources = layout.sources(outline.size, part);
        let refuse = |why: String| refused(&path.display().to_string(), why);
        let (mut dem, missing) = complete(path, outline.size, sources, request)?;
        let samples = dem.heights.len();
        let laid = if layout.is_square() { 0 } else { 4 * (part.size[0] * part.size[1]) as u64 };
        afford_beside(samples, laid, request.allowed).map_err(refuse)?;
        let mut notes = std::mem::take(&mut dem.notes);
        notes.extend((missing > 0).then(|| filled(missing, samples)));
        notes.extend(layout.note(outline.steps, outline.place.unit.degrees().is_some()));
        let grid = layout.apply_part(dem, sources.from, part);
        let grid = grid.ok_or_else(|| refuse("its number of samples differs from its header".into()))?;
        let hash = part_hash(&grid);
        Ok(Some(PreparedDem { missing, samples, notes, hash, ..outline.prepared(grid) }))
    }
}

/// The hash of a part. It differs from the hash of a whole place with the same heights.
fn part_hash(grid: &Grid) -> [u8; 32] {
    let mut digest = Sha256::new();
    digest.update(hash(grid));
    [grid.window().x, grid.window().y].iter().for_each(|at| digest.update(at.to_le_bytes()));
    digest.finalize().into()
}

/// The samples of a part of a file with holes filled as in the whole file, and the number of holes.
fn complete(path: &Path, size: [usize; 2], part: Part, request: Request) -> Result<(Dem, usize)> {
    let read = |part: Part| open::read(path, request.with_part(Some(part)));
    let dem = read(part)?;
    let missing = dem.missing();
    if missing == 0 {
        return Ok((dem, 0));
    }
    drop(dem);
    let mut power = BLOCK;
    loop {
        let around = around(part, size, 1 << power);
        let whole = around == Part::whole(size);
        let mut wide = if whole { open::read(path, request)? } else { read(around)? };
        if whole || every_block_has_a_height(&wide, 1 << power) {
            let refuse = |why: String| refused(&path.display().to_string(), why);
            afford_beside(wide.heights.len(), wide.heights.len() as u64 / 3 * 4, request.allowed).map_err(refuse)?;
            fill(&mut wide.heights, wide.width, wide.height);
            let from = [part.from[0] - around.from[0], part.from[1] - around.from[1]];
            return Ok((wide.cropped(Part { from, ..part }).map_err(refuse)?, missing));
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
