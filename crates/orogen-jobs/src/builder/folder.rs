//! A folder of tiles that share their edges, with a manifest of their positions and scale.

use std::io;
use std::path::PathBuf;

use serde_json::{Map, Value, json};

use super::digest::FileDigest;
use super::identity::Identity;
use super::job::{Job, JobFile, Made, Stage};
use super::output_store::OutputStore;
use super::samples::{self, range, square_repeated};
use super::spec::{Form, Samples};
use super::target::{BuildTarget, Disk};
use orogen_engine::tiles::Tiling;
use orogen_grid::error::{Error, ErrorKind, Result};
use orogen_grid::grid::{Grid, Window};
use orogen_io::format::levels::Levels;
use orogen_io::format::png::{self, Picture, Pixel};
use orogen_io::format::raw;
use orogen_io::samples::to_bytes;

/// The manifest.
const MANIFEST: &str = "manifest.json";

/// Maximum side of a tile, in samples.
const LARGEST: usize = 16_384;

/// The target. Integer formats need the range of the whole window first, so one stage stores the samples as floats and
/// a second one converts them.
pub struct Folder {
    identity: Identity,
    samples: Samples,
    about: String,
    sea_level: f64,
    tiling: Tiling,
}

impl Folder {
    /// Creates the target of a build.
    ///
    /// # Errors
    /// If tiles cannot have this side.
    pub fn new(identity: &Identity, samples: Samples, about: &str, sea_level: f64) -> Result<Folder> {
        if !(2..=LARGEST).contains(&identity.tile) {
            let message = format!(
                "tiles that share their edges must have 2 to {LARGEST} samples per side, not {}; 513 and 1025 are typical",
                identity.tile
            );
            return Err(Error::new(ErrorKind::Request, message));
        }
        let tiling = Tiling { overlap: 1, ..Tiling::of(identity.tile - 1) };
        Ok(Folder { identity: identity.clone(), samples, about: about.to_string(), sea_level, tiling })
    }

    fn stage(&self) -> Stage {
        let [columns, rows] = self.tiling.layout(&self.identity.window);
        Stage { rows, columns, samples: self.identity.tile * self.identity.tile * self.identity.layers.len() }
    }

    fn name(&self, layer: &str, row: usize, column: usize) -> String {
        format!("{layer}_x{column}_y{row}.{}", Form::Tiles(self.samples).name())
    }

    /// Whether samples are converted to integers over the range of the whole window.
    fn scales(&self) -> bool {
        self.samples != Samples::R32
    }

    fn waiting(&self, job: Job) -> impl Iterator<Item = JobFile> {
        let layers = 0..self.identity.layers.len();
        layers.map(move |layer| JobFile::Scratch(format!("samples/{layer}/{}/{}", job.row, job.column).into()))
    }

    /// The range of a layer that is mapped to all integer levels.
    fn levels(store: &OutputStore, layer: usize) -> Levels {
        let [low, high] = store.range(layer).unwrap_or([0.0; 2]);
        Levels::new(low, high)
    }

    fn encode(&self, samples: &[f32], levels: &Levels) -> Result<Vec<u8>> {
        let side = self.identity.tile;
        let not_written = |cause: io::Error| Error::new(ErrorKind::Request, cause.to_string());
        let mut bytes = Vec::new();
        match self.samples {
            Samples::R32 => bytes = to_bytes(samples),
            Samples::R16 => raw::write_u16(&mut bytes, samples, levels).map_err(not_written)?,
            Samples::Png => {
                let picture = Picture::new(side, side, Pixel::Grey16);
                let fill = |rows: std::ops::Range<usize>, out: &mut [u8]| {
                    let mut bytes = Vec::with_capacity(out.len());
                    levels.append_bytes(&mut bytes, &samples[rows.start * side..rows.end * side], u16::MAX);
                    out.copy_from_slice(&bytes);
                    Ok(())
                };
                png::write(&mut bytes, &picture, fill).map_err(not_written)?;
            }
        }
        Ok(bytes)
    }

    fn layer(&self, store: &OutputStore, layer: usize) -> Value {
        let name = &self.identity.layers[layer];
        let [low, high] = store.range(layer).unwrap_or([0.0; 2]);
        let mut about = json!({
            "name": name,
            "unit": self.identity.units[layer],
            "files": format!("{name}_x{{column}}_y{{row}}.{}", Form::Tiles(self.samples).name()),
            "lowest": low,
            "highest": high,
        });
        if self.scales() {
            let levels = Folder::levels(store, layer);
            about["value"] = json!("low + number / 65535 * (high - low)");
            about["low"] = json!(levels.low());
            about["high"] = json!(levels.high());
        }
        about
    }

    fn tile(&self, store: &OutputStore, row: usize, column: usize) -> Value {
        let window = self.tiling.tile(&self.identity.window, column, row);
        let job = Job { stage: usize::from(self.scales()), row, column };
        let mut files = Map::new();
        if let Some(record) = store.record(job) {
            for (layer, digest) in self.identity.layers.iter().zip(&record.digests) {
                let name = self.name(layer, row, column);
                files.insert(layer.clone(), json!({ "name": name, "bytes": digest.length, "sha256": digest.sha256 }));
            }
        }
        json!({
            "column": column,
            "row": row,
            "x": window.x,
            "y": window.y,
            "east": window.east(0),
            "south": window.south(0),
            "inside": [window.width, window.height],
            "files": files,
        })
    }
}

impl BuildTarget for Folder {
    fn stages(&self) -> Vec<Stage> {
        vec![self.stage(); 1 + usize::from(self.scales())]
    }

    fn window(&self, row: usize, column: usize) -> Window {
        self.tiling.tile(&self.identity.window, column, row)
    }

    fn places(&self, job: Job) -> Vec<JobFile> {
        match job.stage {
            0 if self.scales() => self.waiting(job).collect(),
            _ => {
                let name = |layer: &String| JobFile::Result(self.name(layer, job.row, job.column).into());
                self.identity.layers.iter().map(name).collect()
            }
        }
    }

    fn reads(&self, job: Job) -> Vec<Job> {
        match job.stage {
            0 => Vec::new(),
            _ => vec![Job { stage: 0, ..job }],
        }
    }

    fn make(&self, job: Job, grids: &[Grid], store: &OutputStore) -> Result<Made> {
        let side = self.identity.tile;
        if job.stage > 0 {
            let samples = self.waiting(job).enumerate().map(|(layer, place)| {
                let samples = samples::read(store, &place, side * side)?;
                self.encode(&samples, &Folder::levels(store, layer))
            });
            return Ok(Made { files: samples.collect::<Result<_>>()?, ranges: Vec::new() });
        }
        let files = grids.iter().map(|grid| to_bytes(&square_repeated(grid, side))).collect();
        Ok(Made { files, ranges: grids.iter().map(range).collect() })
    }

    fn finish(&self, store: &OutputStore) -> Result<Vec<(PathBuf, FileDigest)>> {
        let Window { x, y, width, height, cell } = self.identity.window;
        let stage = self.stage();
        let layers: Vec<Value> = (0..self.identity.layers.len()).map(|layer| self.layer(store, layer)).collect();
        let all = (0..stage.rows).flat_map(|row| (0..stage.columns).map(move |column| (row, column)));
        let tiles: Vec<Value> = all.map(|(row, column)| self.tile(store, row, column)).collect();
        let (number, order) = match self.samples {
            Samples::Png => ("16-bit grey PNG", Value::Null),
            Samples::R16 => ("u16", json!("little")),
            Samples::R32 => ("f32", json!("little")),
        };
        let manifest = json!({
            "about": self.about,
            "made_by": format!("Orogen {}", self.identity.version),
            "recipe_sha256": self.identity.recipe,
            "cell": cell,
            "window": { "x": x, "y": y, "width": width, "height": height },
            "sea_level": self.sea_level,
            "order": "rows from north to south, each from west to east",
            "number": number,
            "byte_order": order,
            "tile": { "samples": self.identity.tile, "step": self.tiling.side, "columns": stage.columns, "rows": stage.rows },
            "layers": layers,
            "tiles": tiles,
        });
        Ok(vec![store.json(MANIFEST, &manifest)?])
    }

    fn extras(&self) -> Vec<PathBuf> {
        vec![MANIFEST.into()]
    }

    fn scratch_memory(&self) -> u64 {
        // The square, its bytes, and the encoded file.
        12 * (self.identity.tile * self.identity.tile) as u64
    }

    fn disk(&self) -> Disk {
        let stage = self.stage();
        let samples = (stage.len() * stage.samples) as u64;
        let tiles = (stage.len() * self.identity.layers.len()) as u64;
        let manifest = 512 * tiles + (1 << 16);
        match self.samples {
            Samples::R32 => Disk { result: 4 * samples + manifest, scratch: 0 },
            // Incompressible data takes one more byte per row in PNG, and a small overhead.
            _ => Disk {
                result: 2 * samples + tiles * (2 * self.identity.tile as u64 + 1024) + manifest,
                scratch: 4 * samples,
            },
        }
    }
}
