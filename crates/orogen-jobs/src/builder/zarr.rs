//! A Zarr group: one array per layer, one chunk per tile.

use std::path::{Path, PathBuf};

use serde_json::{Value, json};

use super::digest::FileDigest;
use super::identity::Identity;
use super::job::{Job, JobFile, Made, Stage};
use super::output_store::OutputStore;
use super::samples::square;
use super::target::{BuildTarget, Disk};
use orogen_engine::tiles::Tiling;
use orogen_grid::error::{Error, ErrorKind, Result};
use orogen_grid::grid::{Grid, Window};
use orogen_io::format::dem::Georeference;
use orogen_io::format::zarr::blosc;
use orogen_io::format::zarr::metadata::{self, Array, Number};
use orogen_io::samples::to_bytes;

/// Maximum number of coordinates per chunk.
const COORDINATES: usize = 1 << 16;

/// Maximum side of a chunk; with larger chunks readers run out of memory.
const LARGEST: usize = 8192;

/// The group.
pub struct Zarr {
    identity: Identity,
    about: String,
    tiling: Tiling,
}

impl Zarr {
    /// Creates the target of a build.
    ///
    /// # Errors
    /// If a chunk cannot have this side.
    pub fn new(identity: &Identity, about: &str) -> Result<Zarr> {
        if !(1..=LARGEST).contains(&identity.tile) {
            let message =
                format!("the tiles of a .zarr must have 1 to {LARGEST} samples per side, not {}", identity.tile);
            return Err(Error::new(ErrorKind::Request, message));
        }
        let tiling = Tiling::of(identity.tile);
        Ok(Zarr { identity: identity.clone(), about: about.to_string(), tiling })
    }

    fn stage(&self) -> Stage {
        let [columns, rows] = self.tiling.layout(&self.identity.window);
        Stage { rows, columns, samples: self.identity.tile * self.identity.tile * self.identity.layers.len() }
    }

    fn array(&self, layer: &str, unit: &str) -> Value {
        let (Window { width, height, .. }, side) = (self.identity.window, self.identity.tile);
        let mut attributes = json!({ "long_name": layer });
        if !unit.is_empty() {
            attributes["units"] = json!(unit);
        }
        // The attributes that GDAL reads, and those that xarray's extensions read.
        if let Some(map) = &self.identity.map {
            if let Some(code) = map.epsg() {
                attributes["_CRS"] = json!({ "url": format!("http://www.opengis.net/def/crs/EPSG/0/{code}") });
            }
            if let Ok(wkt) = map.wkt() {
                attributes["crs_wkt"] = json!(wkt);
            }
        }
        metadata::array(&Array {
            shape: &[height, width],
            chunk: &[side, side],
            sides: &["y", "x"],
            number: Number::F32,
            attributes,
        })
    }
}

/// A coordinate array: name, values and attributes.
struct Coordinate {
    name: &'static str,
    values: Vec<f64>,
    attributes: Value,
}

fn coordinates(window: &Window, map: Option<&Georeference>) -> [Coordinate; 2] {
    let side = |unit: &str, long: &str, standard: &str, axis: &str| json!({ "units": unit, "long_name": long, "standard_name": standard, "axis": axis });
    // Subtraction from 0.0 avoids a -0.
    let (eastings, northings) = (window.eastings(), window.southings().into_iter().map(|south| 0.0 - south));
    let Some(map) = map else {
        let east = side("m", "metres east of the origin", "projection_x_coordinate", "X");
        let north = side("m", "metres north of the origin", "projection_y_coordinate", "Y");
        return [
            Coordinate { name: "x", values: eastings, attributes: east },
            Coordinate { name: "y", values: northings.collect(), attributes: north },
        ];
    };
    let (east, north) = match map.is_degrees() {
        true => {
            (side("degrees_east", "longitude", "longitude", "X"), side("degrees_north", "latitude", "latitude", "Y"))
        }
        false => (
            side("m", "easting", "projection_x_coordinate", "X"),
            side("m", "northing", "projection_y_coordinate", "Y"),
        ),
    };
    [
        Coordinate { name: "x", values: eastings.iter().map(|x| map.at(*x, 0.0)[0]).collect(), attributes: east },
        Coordinate { name: "y", values: northings.map(|north| map.at(0.0, -north)[1]).collect(), attributes: north },
    ]
}

impl BuildTarget for Zarr {
    fn stages(&self) -> Vec<Stage> {
        vec![self.stage()]
    }

    fn window(&self, row: usize, column: usize) -> Window {
        self.tiling.tile(&self.identity.window, column, row)
    }

    fn places(&self, job: Job) -> Vec<JobFile> {
        let chunk = |layer: &String| JobFile::Result(format!("{layer}/c/{}/{}", job.row, job.column).into());
        self.identity.layers.iter().map(chunk).collect()
    }

    fn reads(&self, _: Job) -> Vec<Job> {
        Vec::new()
    }

    fn make(&self, _: Job, grids: &[Grid], _: &OutputStore) -> Result<Made> {
        let files = grids.iter().map(|grid| pack(&to_bytes(&square(grid, self.identity.tile, f32::NAN)), 4));
        Ok(Made { files: files.collect::<Result<_>>()?, ranges: Vec::new() })
    }

    fn finish(&self, store: &OutputStore) -> Result<Vec<(PathBuf, FileDigest)>> {
        let mut written = Vec::new();
        let mut put = |path: PathBuf, bytes: &[u8]| {
            let digest = store.file(&JobFile::Result(path.clone()), bytes)?;
            written.push((path, digest));
            Ok::<(), Error>(())
        };
        let mut arrays = Vec::new();
        for coordinate in coordinates(&self.identity.window, self.identity.map.as_ref()) {
            let folder = Path::new(coordinate.name);
            let chunk = coordinate.values.len().min(COORDINATES);
            for (n, values) in coordinate.values.chunks(chunk).enumerate() {
                // Chunks are complete; values beyond the side are never read.
                let beyond = std::iter::repeat_n(0.0, chunk - values.len());
                let bytes =
                    pack(&values.iter().copied().chain(beyond).flat_map(f64::to_le_bytes).collect::<Vec<u8>>(), 8)?;
                put(folder.join(format!("c/{n}")), &bytes)?;
            }
            let array = metadata::array(&Array {
                shape: &[coordinate.values.len()],
                chunk: &[chunk],
                sides: &[coordinate.name],
                number: Number::F64,
                attributes: coordinate.attributes,
            });
            arrays.push((coordinate.name.to_string(), array));
        }
        let layers = self.identity.layers.iter().zip(&self.identity.units);
        arrays.extend(layers.map(|(layer, unit)| (layer.clone(), self.array(layer, unit))));
        for (name, array) in &arrays {
            put(Path::new(name).join("zarr.json"), format!("{array:#}\n").as_bytes())?;
        }
        let attributes = json!({
            "title": self.about,
            "source": format!("Orogen {}", self.identity.version),
            "recipe_sha256": self.identity.recipe,
            "cell": self.identity.window.cell,
        });
        // Written last: without this file there is no group, so a partial group does not exist.
        put("zarr.json".into(), format!("{:#}\n", metadata::group(&arrays, attributes)).as_bytes())?;
        Ok(written)
    }

    fn extras(&self) -> Vec<PathBuf> {
        let mut paths = vec![PathBuf::from("zarr.json")];
        for coordinate in coordinates(&self.identity.window, self.identity.map.as_ref()) {
            let chunks = coordinate.values.len().div_ceil(COORDINATES);
            paths.extend((0..chunks).map(|n| Path::new(coordinate.name).join(format!("c/{n}"))));
            paths.push(Path::new(coordinate.name).join("zarr.json"));
        }
        paths.extend(self.identity.layers.iter().map(|layer| Path::new(layer).join("zarr.json")));
        paths
    }

    fn scratch_memory(&self) -> u64 {
        // The padded chunk, its bytes, the shuffled bytes, and the compressed ones.
        16 * (self.identity.tile * self.identity.tile) as u64
    }

    fn disk(&self) -> Disk {
        let stage = self.stage();
        // A chunk takes at most its uncompressed size plus a frame.
        let (samples, chunks) = (stage.samples as u64, self.identity.layers.len() as u64);
        let sides = 8 * (self.identity.window.width + self.identity.window.height + 2 * COORDINATES) as u64;
        Disk { result: stage.len() as u64 * (4 * samples + 64 * chunks) + sides + (1 << 16), scratch: 0 }
    }
}

/// A chunk of encoded numbers.
fn pack(bytes: &[u8], size: u8) -> Result<Vec<u8>> {
    blosc::pack(bytes, size)
        .ok_or_else(|| Error::new(ErrorKind::Request, "a chunk would be larger than 2 GiB; use smaller tiles"))
}
