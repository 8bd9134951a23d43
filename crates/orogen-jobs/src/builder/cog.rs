//! A Cloud-Optimized GeoTIFF. Compressed tiles and coarser samples are kept in temporary files until all exist.
//!
//! Its bytes equal those of [`orogen_io::format::geotiff::writer`] for the same samples.

use std::io;
use std::ops::Range;
use std::path::PathBuf;

use super::digest::FileDigest;
use super::identity::Identity;
use super::job::{Job, JobFile, Made, Stage};
use super::output_store::OutputStore;
use super::samples;
use super::target::{BuildTarget, Disk};
use orogen_grid::error::{Error, ErrorKind, Result};
use orogen_grid::grid::{Grid, Window};
use orogen_io::format::geotiff::options::Options;
use orogen_io::format::geotiff::overview::{Below, Span, half, reduce};
use orogen_io::format::geotiff::pyramid::Pyramid;
use orogen_io::format::geotiff::tile::pack;
use orogen_io::samples::to_bytes;

/// The file. Each level is a stage; a job compresses its tile and computes its part of the next level.
pub struct Cog {
    window: Window,
    pyramid: Pyramid,
}

/// One side of a level's raster: a number of samples, split into tiles.
#[derive(Debug, Clone, Copy)]
struct Side {
    samples: usize,
    tile: usize,
}

impl Side {
    /// The samples of tile `n`.
    fn tile(self, n: usize) -> Range<usize> {
        n * self.tile..((n + 1) * self.tile).min(self.samples)
    }

    /// The samples of the next level that a tile computes: those whose first source sample belongs to the tile.
    fn makes(self, n: usize) -> Range<usize> {
        let Range { start, end } = self.tile(n);
        let first = |sample: usize| (sample * half(self.samples)).div_ceil(self.samples);
        first(start)..first(end)
    }

    /// The samples that a tile needs: its own and, for odd sides, a few more for the next level.
    fn needs(self, n: usize) -> Range<usize> {
        let (own, makes) = (self.tile(n), self.makes(n));
        let end = makes.clone().last().map_or(own.end, |last| Span::of(last, self.samples).end().max(own.end));
        own.start..end
    }

    /// The tiles that compute these samples of the next level.
    fn makers(self, next: &Range<usize>) -> Range<usize> {
        let maker = |sample: usize| Span::of(sample, self.samples).first / self.tile;
        maker(next.start)..maker(next.end - 1) + 1
    }
}

/// A part of a level's raster: columns and rows.
struct Part {
    columns: Range<usize>,
    rows: Range<usize>,
    samples: Vec<f32>,
}

impl Part {
    fn crop(&self, columns: &Range<usize>, rows: &Range<usize>) -> Vec<f32> {
        let mut out = Vec::with_capacity(columns.len() * rows.len());
        for row in rows.clone() {
            let start = (row - self.rows.start) * self.columns.len() + columns.start - self.columns.start;
            out.extend_from_slice(&self.samples[start..start + columns.len()]);
        }
        out
    }

    /// Copies the overlapping part of `other`.
    fn paste(&mut self, other: &Part) {
        let within =
            |ours: &Range<usize>, theirs: &Range<usize>| ours.start.max(theirs.start)..ours.end.min(theirs.end);
        let columns = within(&self.columns, &other.columns);
        for row in within(&self.rows, &other.rows) {
            if columns.is_empty() {
                return;
            }
            let from = (row - other.rows.start) * other.columns.len() + columns.start - other.columns.start;
            let to = (row - self.rows.start) * self.columns.len() + columns.start - self.columns.start;
            self.samples[to..to + columns.len()].copy_from_slice(&other.samples[from..from + columns.len()]);
        }
    }
}

impl Cog {
    /// Creates the target of a build.
    ///
    /// # Errors
    /// If a GeoTIFF cannot have these sides or tiles.
    pub fn new(identity: &Identity) -> Result<Cog> {
        let unit = identity.units.first().map_or("", String::as_str);
        let options = Options::of_unit(unit).with_tile(Some(identity.tile)).with_map(identity.map.clone());
        Ok(Cog { window: identity.window, pyramid: pyramid(&identity.window, &options)? })
    }

    /// The default side of a tile.
    ///
    /// # Errors
    /// If a GeoTIFF cannot have these sides.
    pub fn usual_tile(window: &Window) -> Result<usize> {
        Ok(pyramid(window, &Options::default())?.tile())
    }

    /// The sides of a level, across and down.
    fn sides(&self, level: usize) -> [Side; 2] {
        self.pyramid.sizes()[level].map(|samples| Side { samples, tile: self.pyramid.tile() })
    }

    fn is_last(&self, level: usize) -> bool {
        level + 1 == self.pyramid.sizes().len()
    }

    fn needs(&self, job: Job) -> [Range<usize>; 2] {
        let [across, down] = self.sides(job.stage);
        match self.is_last(job.stage) {
            true => [across.tile(job.column), down.tile(job.row)],
            false => [across.needs(job.column), down.needs(job.row)],
        }
    }

    fn packed(job: Job) -> JobFile {
        JobFile::Scratch(format!("packed/{}/{}/{}", job.stage, job.row, job.column).into())
    }

    fn coarser(job: Job) -> JobFile {
        JobFile::Scratch(format!("coarser/{}/{}/{}", job.stage, job.row, job.column).into())
    }

    /// The part of a level that a job needs, collected from the jobs of the previous level.
    fn gather(&self, job: Job, store: &OutputStore) -> Result<Part> {
        let [columns, rows] = self.needs(job);
        let mut part = Part { samples: vec![0.0; columns.len() * rows.len()], columns, rows };
        let [across, down] = self.sides(job.stage - 1);
        for maker in self.reads(job) {
            let (columns, rows) = (across.makes(maker.column), down.makes(maker.row));
            let samples = samples::read(store, &Cog::coarser(maker), columns.len() * rows.len())?;
            part.paste(&Part { columns, rows, samples });
        }
        Ok(part)
    }

    /// The part of the next level that a job computes.
    fn reduce(&self, job: Job, part: &Part) -> Vec<f32> {
        let [across, down] = self.sides(job.stage);
        let (columns, rows) = (across.makes(job.column), down.makes(job.row));
        if columns.is_empty() || rows.is_empty() {
            return Vec::new();
        }
        let spans: Vec<Span> = columns.map(|i| Span::of(i, across.samples)).collect();
        let below = Below {
            rows: &part.samples,
            left: part.columns.start,
            first: part.rows.start,
            width: part.columns.len(),
            height: down.samples,
        };
        reduce(&below, &spans, rows.start, rows.end, self.pyramid.nodata())
    }
}

fn pyramid(window: &Window, options: &Options) -> Result<Pyramid> {
    Pyramid::new(window, options).map_err(|cause| Error::new(ErrorKind::Request, cause.to_string()))
}

impl BuildTarget for Cog {
    fn stages(&self) -> Vec<Stage> {
        let stage = |level| {
            let [columns, rows] = self.pyramid.tiles(level);
            Stage { rows, columns, samples: self.pyramid.tile() * self.pyramid.tile() }
        };
        (0..self.pyramid.sizes().len()).map(stage).collect()
    }

    fn window(&self, row: usize, column: usize) -> Window {
        let [columns, rows] = self.needs(Job { stage: 0, row, column });
        Window {
            x: self.window.x + columns.start as i64,
            y: self.window.y + rows.start as i64,
            width: columns.len(),
            height: rows.len(),
            cell: self.window.cell,
        }
    }

    fn places(&self, job: Job) -> Vec<JobFile> {
        match self.is_last(job.stage) {
            true => vec![Cog::packed(job)],
            false => vec![Cog::packed(job), Cog::coarser(job)],
        }
    }

    fn reads(&self, job: Job) -> Vec<Job> {
        let Some(stage) = job.stage.checked_sub(1) else { return Vec::new() };
        let ([across, down], [columns, rows]) = (self.sides(stage), self.needs(job));
        let columns = across.makers(&columns);
        down.makers(&rows).flat_map(|row| columns.clone().map(move |column| Job { stage, row, column })).collect()
    }

    fn make(&self, job: Job, grids: &[Grid], store: &OutputStore) -> Result<Made> {
        let part = match grids.first() {
            Some(grid) => {
                let [columns, rows] = self.needs(job);
                Part { columns, rows, samples: grid.data().to_vec() }
            }
            None => self.gather(job, store)?,
        };
        let [across, down] = self.sides(job.stage);
        let columns = across.tile(job.column);
        let tile = part.crop(&columns, &down.tile(job.row));
        let mut files = vec![pack(&tile, columns.len(), 0, self.pyramid.tile())];
        if !self.is_last(job.stage) {
            files.push(to_bytes(&self.reduce(job, &part)));
        }
        Ok(Made { files, ranges: Vec::new() })
    }

    fn assembles(&self) -> bool {
        true
    }

    fn finish(&self, store: &OutputStore) -> Result<Vec<(PathBuf, FileDigest)>> {
        let job = |level: usize, tile: usize| {
            let [columns, _] = self.pyramid.tiles(level);
            Job { stage: level, row: tile / columns, column: tile % columns }
        };
        let length = |level, tile| {
            let record = store.record(job(level, tile));
            record.and_then(|record| record.digests.first().map(|digest| digest.length as u32)).unwrap_or(0)
        };
        let lengths = (0..self.pyramid.sizes().len())
            .map(|level| {
                let [columns, rows] = self.pyramid.tiles(level);
                (0..columns * rows).map(|tile| length(level, tile)).collect()
            })
            .collect();
        let file = store.assemble(|out| {
            self.pyramid.write(out, lengths, |level, tile, bytes| {
                let (place, length) = (Cog::packed(job(level, tile)), bytes.len());
                store.read(&place, bytes)?;
                match bytes.len() == length && length > 4 {
                    true => Ok(()),
                    false => Err(io::Error::from(samples::changed(store, &place))),
                }
            })
        })?;
        Ok(vec![(PathBuf::new(), file)])
    }

    fn scratch_memory(&self) -> u64 {
        // The part with its margin, the tile, the filtered and the compressed tile, and the part of the next level.
        24 * (self.pyramid.tile() * self.pyramid.tile()) as u64
    }

    fn disk(&self) -> Disk {
        let tile = 4 * (self.pyramid.tile() * self.pyramid.tile()) as u64;
        let tiles: u64 = self.stages().iter().map(|stage| stage.len() as u64).sum();
        let coarser: u64 = self.pyramid.sizes().iter().skip(1).map(|[w, h]| 4 * (w * h) as u64).sum();
        // Incompressible data is stored by deflate in blocks with a small overhead.
        let packed = tiles * (tile + tile / 1024 + 64);
        Disk { result: packed + 24 * tiles + (1 << 16), scratch: packed + coarser }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_sample_of_the_next_level_is_made_once_by_who_is_asked_for_it() {
        for tile in [16, 48] {
            for samples in 17..400 {
                let side = Side { samples, tile };
                let tiles = samples.div_ceil(tile);
                let mut next = 0;
                for n in 0..tiles {
                    let (makes, needs) = (side.makes(n), side.needs(n));
                    assert_eq!(makes.start, next);
                    next = makes.end;
                    for sample in makes {
                        let span = Span::of(sample, samples);
                        assert!(needs.contains(&span.first) && needs.end >= span.end(), "{samples} {tile}");
                        assert!(side.makers(&(sample..sample + 1)) == (n..n + 1));
                    }
                    assert!(needs.len() <= tile + 2);
                }
                assert_eq!(next, half(samples));
            }
        }
    }
}
