//! A real place prepared for use.

use std::path::Path;

use sha2::{Digest, Sha256};

use super::fill::fill;
use super::open;
use super::square::{Layout, steps};
use crate::format::dem::{Dem, Georeference, Placement, Request, afford, afford_beside, refused};
use crate::format::import;
use crate::format::sidecar::Sidecar;
use crate::open::regular;
use crate::samples;
use orogen_grid::error::Result;
use orogen_grid::grid::Grid;
use orogen_grid::words::{count, percent};

/// Default memory limit for heights, in bytes.
pub const DEFAULT_MEMORY: u64 = 4 << 30;

/// Heights of a real place on a lattice of square cells in metres, without holes.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct PreparedDem {
    /// The heights; the north-west corner of the place is at the origin.
    pub grid: Grid,
    /// Columns and rows of the whole place; the heights may be a part of it ([`PreparedDem::part`]).
    pub size: [usize; 2],
    /// Number of samples that were read without a height; they were filled.
    pub missing: usize,
    /// Number of samples that were read.
    pub samples: usize,
    /// The position on a map, if the file states it.
    pub georeference: Option<Georeference>,
    /// Messages about the preparation.
    pub notes: Vec<String>,
    /// SHA-256 of size, cell and heights.
    pub hash: [u8; 32],
}

impl PreparedDem {
    /// Reads heights by path ([`open::read`]), fills holes ([`fill`]) and resamples degrees and oblong cells to square
    /// cells in metres ([`Layout`]). `cell` is the distance between samples in metres; it replaces the file's own, and
    /// is required if the file has none. `request` limits the memory of the heights.
    ///
    /// # Errors
    /// If the file cannot be read, is too large, or the distance between its samples is unknown.
    pub fn read(path: &Path, cell: Option<f64>, request: impl Into<Request>) -> Result<PreparedDem> {
        let (name, request) = (path.display().to_string(), request.into());
        let dem = open::read(path, request)?;
        PreparedDem::of(dem, cell, request.allowed).map_err(|why| refused(&name, why))
    }

    /// Reads a grayscale picture: 0 for black, 1 for white, pixels one metre apart. Takes at most `allowed` bytes of
    /// memory.
    ///
    /// # Errors
    /// If the file cannot be read, is not a grayscale .png, or is too large.
    pub fn picture(path: &Path, allowed: u64) -> Result<PreparedDem> {
        let name = path.display().to_string();
        if !path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("png")) {
            return Err(refused(
                &name,
                "the op `image` only reads .png; use the op `dem` for heights in other formats",
            ));
        }
        let mut file = regular(path, "read")?;
        let greys = Sidecar { low: Some(0.0), high: Some(1.0), cell: Some(1.0), ..Sidecar::default() };
        let dem = import::parse(&mut file, &name, "png", Some(greys), allowed)?;
        PreparedDem::of(dem, None, allowed).map_err(|why| refused(&name, why))
    }

    /// Prepares a DEM in memory, like [`PreparedDem::read`].
    ///
    /// # Errors
    /// The errors of [`PreparedDem::read`], as a message.
    pub fn of(mut dem: Dem, cell: Option<f64>, allowed: u64) -> std::result::Result<PreparedDem, String> {
        let (steps, layout) = lattice([dem.width, dem.height], dem.place.as_ref(), cell)?;
        afford(layout.size[0] as u64, layout.size[1] as u64, allowed)?;
        let samples = dem.heights.len();
        // Memory of the pyramid for filling holes; during resampling, the samples before and after.
        let holes = if dem.missing() > 0 { samples as u64 / 3 * 4 } else { 0 };
        let laid = if layout.is_square() { 0 } else { 4 * (layout.size[0] * layout.size[1]) as u64 };
        afford_beside(samples, holes.max(laid), allowed)?;
        let mut notes = std::mem::take(&mut dem.notes);
        let missing = fill(&mut dem.heights, dem.width, dem.height);
        if missing > 0 {
            notes.push(filled(missing, samples));
        }
        let degrees = dem.place.as_ref().is_some_and(|place| place.unit.degrees().is_some()) && cell.is_none();
        notes.extend(layout.note(steps, degrees));
        let georeference = dem.place.as_ref().map(|place| layout.georeference(place, steps));
        let grid = layout.apply(dem).ok_or("its number of samples differs from its header")?;
        let hash = hash(&grid);
        Ok(PreparedDem { grid, size: layout.size, missing, samples, georeference, notes, hash })
    }

    /// Whether the heights are only a part of the place.
    #[must_use]
    pub fn is_part(&self) -> bool {
        [self.grid.width(), self.grid.height()] != self.size
    }

    /// Memory of the heights, in bytes.
    #[must_use]
    pub fn memory(&self) -> u64 {
        self.grid.data().len() as u64 * 4
    }
}

/// The distances between the samples of a raster in metres, and the lattice of its heights.
pub(super) fn lattice(
    size: [usize; 2],
    place: Option<&Placement>,
    cell: Option<f64>,
) -> std::result::Result<([f64; 2], Layout), String> {
    let steps = match (cell, place) {
        (Some(cell), _) => [cell; 2],
        (None, Some(place)) => steps(place, size[1]),
        (None, None) => return Err("its cell size is unknown; set `cell`, in metres".into()),
    };
    match steps.iter().all(|step| (1e-3..=1e6).contains(step)) {
        true => Ok((steps, Layout::new(size, steps))),
        false => Err(format!("its cell size of {} x {} m is out of range", steps[0], steps[1])),
    }
}

/// The message that holes were filled.
pub(super) fn filled(missing: usize, samples: usize) -> String {
    let (holes, share) = (count(missing, "sample"), percent(missing as u64, samples as u64));
    format!("filled {holes} without height ({share}) from the surrounding heights")
}

pub(super) fn hash(grid: &Grid) -> [u8; 32] {
    let mut hash = Sha256::new();
    hash.update((grid.width() as u64).to_le_bytes());
    hash.update((grid.height() as u64).to_le_bytes());
    hash.update(grid.window().cell.to_bits().to_le_bytes());
    let mut bytes = Vec::with_capacity(1 << 16);
    for piece in grid.data().chunks(1 << 14) {
        bytes.clear();
        samples::append_bytes(&mut bytes, piece);
        hash.update(&bytes);
    }
    hash.finalize().into()
}
