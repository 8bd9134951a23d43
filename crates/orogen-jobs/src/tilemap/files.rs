//! The files of a tilemap, in one folder.

use std::io::{self, Write as _};
use std::path::{Path, PathBuf};

use orogen_grid::parallel;

use super::job::TilemapJob;
use super::map::Tilemap;
use super::{godot, tiled};
use orogen_engine::World;
use orogen_grid::error::{Error, ErrorKind, Result};
use orogen_grid::grid::Window;
use orogen_grid::progress::Progress;
use orogen_grid::words::{count, number};
use orogen_io::file::cancellable::CancellableWriter;
use orogen_io::file::{self, Output, OutputFolder, OutputPolicy, Staged};
use orogen_io::format::notes::SOFTWARE;

/// The files, in the order in which they are put in place: the summary is last, so its presence means that all files
/// are complete.
pub const NAMES: [&str; 10] =
    ["tiles.png", "tiles.tsx", "map.tmx", "map.tmj", LDTK, "tiles.tres", GODOT, "classes.csv", "preview.png", SUMMARY];

const SUMMARY: &str = "tilemap.json";

/// The files that some maps do not have.
const LDTK: &str = "map.ldtk";
const GODOT: &str = "map.tscn";

/// Memory for writing the files, in bytes.
const ENCODERS: u64 = 12 << 20;

/// A tilemap that was written.
#[derive(Debug)]
pub struct WrittenMap {
    /// The map.
    pub map: Tilemap,
    /// The folder.
    pub folder: PathBuf,
    /// Files that this map does not have.
    pub missing: Vec<&'static str>,
    /// A message about samples that are NaN or infinite.
    pub warning: Option<String>,
}

impl TilemapJob {
    /// Makes a map like [`TilemapJob::stream`] and writes either all its files into a folder, which is created if
    /// needed, or none. `source` is the layer that classes are made from, for messages.
    ///
    /// # Errors
    /// The errors of [`TilemapJob::stream`]; if a file may not be replaced or cannot be written; or if no sample is
    /// finite.
    pub fn to_folder(
        &self,
        world: &World,
        window: &Window,
        source: &str,
        (folder, policy): (&Path, &OutputPolicy),
        progress: &Progress,
    ) -> Result<WrittenMap> {
        let outputs: Vec<Output> = NAMES.iter().map(|name| policy.output(folder.join(name))).collect::<Result<_>>()?;
        let ready = OutputFolder::ready(folder)?;
        self.afford(world, window, ENCODERS)?;
        let _writing = world.budget().reserve(ENCODERS)?;
        let [making, writing] = progress.parts([3.0, 1.0]);
        let map = self.stream(world, window, &folder.join(SUMMARY), &making)?;
        let warning = map.finite.check(&format!("the layer `{source}`"))?;
        world.install(|| write(&map, &outputs, &writing))?;
        ready.keep();
        let missing = NAMES.into_iter().filter(|name| is_missing(&map, name)).collect();
        Ok(WrittenMap { map, folder: folder.to_path_buf(), missing, warning })
    }
}

fn is_missing(map: &Tilemap, name: &str) -> bool {
    name == LDTK && !map.fits_ldtk() || name == GODOT && !map.fits_godot()
}

/// Writes all files, or none of them.
fn write(map: &Tilemap, outputs: &[Output], progress: &Progress) -> Result<()> {
    let json = serde_json::to_string_pretty(&map.summary(SOFTWARE))
        .map_err(|e| Error::new(ErrorKind::Internal, e.to_string()))?;
    progress.expect(NAMES.len() as f64);
    let stage = |(name, output): (&&str, &Output)| {
        progress.step(1.0)?;
        match is_missing(map, name) {
            true => Ok(None),
            false => file::stage(output, |out| write_file(map, name, &json, &mut CancellableWriter { out, progress }))
                .map(Some),
        }
    };
    let staged: Vec<Result<Option<Staged>>> = parallel::map(NAMES.iter().zip(outputs), stage);
    let staged: Vec<Option<Staged>> = staged.into_iter().collect::<Result<_>>()?;
    file::commit(staged.into_iter().flatten().collect())
}

/// Writes the file of this name.
fn write_file(map: &Tilemap, name: &str, json: &str, out: &mut CancellableWriter) -> io::Result<()> {
    let notes = [("Software", SOFTWARE)];
    let [image, tsx, tres] = [NAMES[0], NAMES[1], NAMES[5]];
    match name {
        "tiles.png" => map.tileset.write_png(out, &notes),
        "tiles.tsx" => tiled::write_tsx(&map.tileset, out, image, SOFTWARE),
        "map.tmx" => map.write_tmx(out, tsx, SOFTWARE),
        "map.tmj" => map.write_tmj(out, image, SOFTWARE),
        LDTK => map.write_ldtk(out, image, SOFTWARE),
        "tiles.tres" => godot::write_tileset(&map.tileset, out, image, SOFTWARE),
        GODOT => map.write_tscn(out, tres, SOFTWARE),
        "classes.csv" => map.write_csv(out),
        "preview.png" => map.write_png(out, &notes),
        _ => writeln!(out, "{json}"),
    }
}

impl WrittenMap {
    /// A description: files, tiles, classes, and positions without a tile.
    #[must_use]
    pub fn words(&self) -> String {
        let WrittenMap { map, folder, missing, .. } = self;
        let cells = map.classes.len().max(1) as f64;
        let shares = map.tileset.terrains.iter().zip(&map.class_counts).filter(|(_, cells)| **cells > 0);
        let shares: Vec<String> =
            shares.map(|(terrain, of)| format!("{:.0} % {}", 100.0 * *of as f64 / cells, terrain.name)).collect();
        let gaps = match map.gap_count {
            0 => "every place has a tile".to_string(),
            gaps => format!("{} without a tile; tilemap.json lists {}", count(gaps as usize, "place"), listed(map)),
        };
        let written: Vec<&str> = NAMES.into_iter().filter(|name| !missing.contains(name)).collect();
        let why = missing.iter().map(|name| match *name {
            LDTK => "\nno map.ldtk: LDtk has no quarter turns, and a project lists each of up to 2^20 tiles",
            _ => "\nno map.tscn: a scene lists each of up to 2^24 tiles, and up to 32767 along a side",
        });
        let objects = match map.objects.len() {
            0 => String::new(),
            objects => format!(", {}", count(objects as usize, "object")),
        };
        format!(
            "{}: {}\n{} x {} tiles of {} ({}), {} m a cell, seed {}\n{}{objects}\n{gaps}{}\n",
            folder.display(),
            written.join("  "),
            map.width,
            map.height,
            map.tileset.name,
            map.tileset.layout.name(),
            number(map.window.cell),
            map.seed,
            shares.join(", "),
            why.collect::<String>(),
        )
    }
}

/// The text about the positions without a tile that the summary lists.
fn listed(map: &Tilemap) -> String {
    match map.gaps.len() as u64 == map.gap_count {
        true => "them".into(),
        false => format!("the first {}", map.gaps.len()),
    }
}
