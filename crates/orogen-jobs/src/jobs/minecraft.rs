//! Saves of Minecraft, made region by region.

use std::path::Path;
use std::sync::OnceLock;

use orogen_engine::world::{HEIGHT, World};
use orogen_grid::analysis::finite::FiniteCount;
use orogen_grid::error::Result;
use orogen_grid::grid::Window;
use orogen_grid::parallel;
use orogen_grid::progress::Progress;
use orogen_io::file::cancellable::CancellableWriter;
use orogen_io::file::{self, Output, Staged};
use orogen_io::format::anvil::{CHUNKS, COLUMNS, PackedChunk, SIDE, region_name, write_region};
use orogen_output::blocks::density::DENSITY;
use orogen_output::blocks::kind::KINDS;
use orogen_output::blocks::land::{COLUMN_BYTES, HALO, Land, ROOM};
use orogen_output::blocks::levels::Extent;
use orogen_output::blocks::minecraft::chunk::{CHUNK_BYTES, MinecraftChunk};
use orogen_output::blocks::minecraft::level::{LevelSettings, write_level};
use orogen_output::blocks::minecraft::placement::{HeightExtent, Placement};
use orogen_output::blocks::minecraft::spawn::Spawn;

/// The folder of the region files.
pub(super) const REGIONS: &str = "region";

/// The file with the settings, which is put in place last.
pub(super) const LEVEL: &str = "level.dat";

/// Rows of chunks whose columns are computed together.
const STRIP: i64 = 8;

/// Usual size of a stored chunk, in bytes.
const STORED: u64 = 12 << 10;

/// A save that is planned.
pub(super) struct MinecraftSave {
    /// How many of the heights are finite.
    pub finite: FiniteCount,
    /// Where its levels are.
    pub placement: Placement,
    window: Window,
    exaggeration: f64,
    sea_y: i32,
    written: OnceLock<WrittenSave>,
}

/// What was written.
#[derive(Debug, Clone, Default)]
pub(super) struct WrittenSave {
    /// Number of blocks of each kind.
    pub counts: [u64; KINDS.len()],
    /// Number of blocks of air in caves and below overhangs.
    pub enclosed: u64,
    spawn: Option<Spawn>,
    position: [i32; 3],
    regions: usize,
    sea_y: i32,
}

impl WrittenSave {
    /// The end of a description.
    pub fn words(&self) -> String {
        let [x, y, z] = self.position;
        let regions = orogen_grid::words::count(self.regions, "region");
        format!("\n{regions}, the sea up to y = {}, players start at {x} {y} {z}", self.sea_y)
    }
}

/// The first and the last index of parts of `side` columns that a window has along x and z.
fn parts(window: &Window, side: i64) -> [[i64; 2]; 2] {
    let ends = |start: i64, length: usize| [start, start + length as i64 - 1].map(|at| at.div_euclid(side));
    [ends(window.x, window.width), ends(window.y, window.height)]
}

/// The positions of parts of `side` columns that a window has, row by row from the north.
fn places(window: &Window, side: i64) -> Vec<[i64; 2]> {
    let [[west, east], [north, south]] = parts(window, side);
    (north..=south).flat_map(|z| (west..=east).map(move |x| [x, z])).collect()
}

/// The names of the region files of a window, row by row from the north.
pub(super) fn region_names(window: &Window) -> Vec<String> {
    places(window, SIDE as i64).into_iter().map(region_name).collect()
}

/// The part of a window from column `x` and row `z` on.
fn cut(window: &Window, [x, z]: [i64; 2], [width, height]: [usize; 2]) -> Option<Window> {
    let part = window.intersection(&Window { x, y: z, width, height, cell: window.cell });
    (!part.is_empty()).then_some(part)
}

impl MinecraftSave {
    /// Plans a save of the blocks of a window, for which it computes the heights.
    pub fn new(
        world: &World,
        window: &Window,
        exaggeration: f64,
        sea_y: i32,
        progress: &Progress,
    ) -> Result<MinecraftSave> {
        Placement::check_window(window)?;
        let mut heights = HeightExtent::default();
        for band in world.bands(&[HEIGHT], window, 0, progress)? {
            for grid in band? {
                heights = heights.with(grid.data());
            }
        }
        let placement = Placement::new(world.recipe().world.sea_level * exaggeration, window.cell, sea_y);
        if let Some(range) = heights.altitudes(exaggeration) {
            let has_density = world.recipe().outputs().any(|name| name == DENSITY);
            let room = if has_density { ROOM } else { 0 };
            placement.check(range, room, window.cell, exaggeration, sea_y)?;
        }
        let written = OnceLock::new();
        Ok(MinecraftSave { finite: heights.finite, placement, window: *window, exaggeration, sea_y, written })
    }

    /// What was written; `None` before.
    pub fn written(&self) -> Option<&WrittenSave> {
        self.written.get()
    }

    /// Makes the chunks and writes all files, which are not yet in place: those of the regions, then the settings.
    pub fn stage(&self, world: &World, outputs: &[Output], progress: &Progress) -> Result<Vec<Staged>> {
        let threads = world.install(parallel::threads) as u64;
        let strip = [SIDE, STRIP as usize * COLUMNS].map(|side| (side + 2 * HALO) as u64);
        let columns = strip[0].saturating_mul(strip[1]).saturating_mul(COLUMN_BYTES);
        let _making = world.budget().reserve(columns.saturating_add(threads.saturating_mul(CHUNK_BYTES)))?;
        let regions = places(&self.window, SIDE as i64);
        let mut done = WrittenSave { regions: regions.len(), sea_y: self.sea_y, ..WrittenSave::default() };
        // Columns are about as much work as their blocks.
        progress.expect(2.0 * places(&self.window, COLUMNS as i64).len() as f64);
        let mut staged = Vec::with_capacity(outputs.len());
        for (region, output) in regions.iter().zip(outputs) {
            staged.push(self.stage_region(world, *region, output, &mut done, progress)?);
        }
        done.position = Spawn::position(done.spawn, self.middle());
        if let Some(output) = outputs.last() {
            let folder = output.path().parent().and_then(Path::file_name).and_then(|name| name.to_str());
            let level = LevelSettings {
                name: folder.unwrap_or("Orogen"),
                seed: world.recipe().world.seed,
                spawn: done.position,
            };
            staged.push(file::stage(output, |out| write_level(out, &level))?);
        }
        let _ = self.written.set(done);
        Ok(staged)
    }

    fn middle(&self) -> [i64; 2] {
        let Window { x, y, width, height, .. } = self.window;
        [x + width as i64 / 2, y + height as i64 / 2]
    }

    fn stage_region(
        &self,
        world: &World,
        [x, z]: [i64; 2],
        output: &Output,
        done: &mut WrittenSave,
        progress: &Progress,
    ) -> Result<Staged> {
        let corner = [x, z].map(|at| at * SIDE as i64);
        let mut chunks = vec![PackedChunk::default(); CHUNKS * CHUNKS];
        let mut reserved = Vec::new();
        let strip = [SIDE, STRIP as usize * COLUMNS];
        for first in (0..CHUNKS as i64).step_by(STRIP as usize) {
            let start = [corner[0], corner[1] + first * COLUMNS as i64];
            let Some(part) = cut(&self.window, start, strip) else { continue };
            let places = places(&part, COLUMNS as i64);
            reserved.push(world.budget().reserve(STORED * places.len() as u64)?);
            let reading = progress.part(places.len() as f64);
            let levels = Extent::Levels(self.placement.levels());
            let land = Land::of(world, &part, levels, self.exaggeration, &|_| Ok(()), &reading)?;
            reading.finish();
            let make = |place: &[i64; 2]| {
                progress.step(1.0)?;
                MinecraftChunk::of(&land, *place, self.middle())?
                    .map_err(|cause| file::explain("write", output.path(), &cause))
            };
            let made = world.install(|| parallel::try_map(&places, make))?;
            let stored: u64 = made.iter().map(|chunk| chunk.packed.size()).sum();
            reserved.push(world.budget().reserve(stored.saturating_sub(STORED * places.len() as u64))?);
            for ([x, z], chunk) in places.into_iter().zip(made) {
                done.counts.iter_mut().zip(chunk.counts).for_each(|(all, count)| *all += count);
                done.enclosed += chunk.enclosed;
                done.spawn = [done.spawn, chunk.spawn].into_iter().flatten().min();
                let [across, down] = [x, z].map(|at| at.rem_euclid(CHUNKS as i64) as usize);
                chunks[down * CHUNKS + across] = chunk.packed;
            }
        }
        file::stage(output, |out| write_region(&mut CancellableWriter { out, progress }, &chunks))
    }
}
