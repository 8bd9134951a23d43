//! Sidecars of formats that do not store all properties: NAME.json, which [`orogen_io::format::sidecar`] reads.

use std::io::{self, Read};
use std::path::{Path, PathBuf};

use serde::Serialize;

use super::files::Files;
use super::layer_source::LayerSource;
use crate::options::{OptionSpec, Options};
use orogen_grid::hex;
use orogen_io::format::dem::Georeference;
use orogen_io::format::levels::Levels;
use orogen_io::format::notes::SOFTWARE;
use orogen_io::format::sidecar::own;
use orogen_io::fs::{self, File};

/// The option that omits the sidecar.
pub const NO_SIDECAR: OptionSpec = OptionSpec::switch("no-sidecar").with_about(
    "Do not write files beside the output: no NAME.json (size, cell size, range, seed and other metadata), no \
             .prj, no world file and no .aux.xml",
);

/// The encoding of samples in a file.
#[derive(Debug, Clone, Default)]
pub struct SampleEncoding {
    /// The type of a sample: "u8", "u16", "f32".
    pub sample: &'static str,
    /// "little" or "big", for samples of several bytes.
    pub byte_order: Option<&'static str>,
    /// The range of the levels, if samples are levels.
    pub levels: Option<Levels>,
    /// Whether the rows start in the south.
    pub from_south: bool,
    /// The files, with the names of their channels where they need description.
    pub channels: Vec<(PathBuf, Vec<String>)>,
}

impl SampleEncoding {
    /// The encoding of integers up to `most`; integers of two bytes have `byte_order`.
    pub fn of_levels(levels: Levels, most: u16, byte_order: &'static str, from_south: bool) -> SampleEncoding {
        let (sample, byte_order) = if most == 255 { ("u8", None) } else { ("u16", Some(byte_order)) };
        SampleEncoding { sample, byte_order, levels: Some(levels), from_south, ..SampleEncoding::default() }
    }
}

/// A file and its channels.
#[derive(Debug, Serialize)]
struct Channels<'a> {
    file: String,
    channels: &'a [String],
}

/// The content of the sidecar. Keys are in this order; keys that the reader knows have the reader's names.
#[derive(Debug, Serialize)]
struct Text<'a> {
    made_by: &'static str,
    file: String,
    layer: &'a str,
    #[serde(skip_serializing_if = "str::is_empty")]
    unit: &'a str,
    width: usize,
    height: usize,
    cell: f64,
    sample: &'a str,
    #[serde(skip_serializing_if = "Option::is_none")]
    byte_order: Option<&'a str>,
    first_row: &'a str,
    #[serde(skip_serializing_if = "Option::is_none")]
    low: Option<f32>,
    #[serde(skip_serializing_if = "Option::is_none")]
    high: Option<f32>,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    files: Vec<Channels<'a>>,
    min: f32,
    max: f32,
    sea_level: f64,
    seed: u64,
    east: f64,
    south: f64,
    #[serde(skip_serializing_if = "Option::is_none")]
    geotransform: Option<[f64; 6]>,
    #[serde(skip_serializing_if = "Option::is_none")]
    crs: Option<String>,
    #[serde(skip_serializing_if = "Option::is_none")]
    wkt: Option<String>,
    #[serde(skip_serializing_if = "Option::is_none")]
    crs_missing: Option<String>,
    layer_sha256: String,
    #[serde(skip_serializing_if = "str::is_empty")]
    about: &'a str,
}

/// Writes the sidecar, unless it was switched off; returns its part of the final message.
///
/// The name is NAME.json, or NAME.EXT.json if NAME.json belongs to another file or is not an Orogen sidecar, such as a
/// recipe.
///
/// Fails if the files fail, or both names are taken.
pub fn write(files: &mut Files, source: &LayerSource, options: &Options, held: &SampleEncoding) -> io::Result<String> {
    let Some(path) = files.path().map(Path::to_path_buf) else { return Ok(String::new()) };
    if options.has(NO_SIDECAR.name) || fs::is_present(&path) && !fs::is_file(&path) {
        return Ok(String::new());
    }
    let name = |path: &Path| path.file_name().unwrap_or_default().to_string_lossy().into_owned();
    let place = place(&path, &name(&path));
    let (window, world) = (source.window(), source.world().recipe());
    let range = source.levels();
    let map = source.map();
    let wkt = map.as_ref().map(Georeference::wkt);
    let text = Text {
        made_by: SOFTWARE,
        file: name(&path),
        layer: source.layer(),
        unit: source.unit(),
        width: window.width,
        height: window.height,
        cell: window.cell,
        sample: held.sample,
        byte_order: held.byte_order,
        first_row: if held.from_south { "south" } else { "north" },
        low: held.levels.map(|levels| levels.low()),
        high: held.levels.map(|levels| levels.high()),
        files: (held.channels.iter()).map(|(path, channels)| Channels { file: name(path), channels }).collect(),
        min: range.low(),
        max: range.high(),
        sea_level: world.world.sea_level,
        seed: world.world.seed,
        east: window.east(0),
        south: window.south(0),
        geotransform: map.as_ref().map(|map| map.affine(window, held.from_south).geotransform()),
        crs: map.as_ref().and_then(Georeference::epsg).map(|code| format!("EPSG:{code}")),
        wkt: wkt.clone().and_then(Result::ok),
        crs_missing: wkt.and_then(Result::err),
        layer_sha256: hex::encode(&source.key()),
        about: &world.about,
    };
    let json = serde_json::to_string_pretty(&text).map_err(io::Error::other)?;
    files.write_beside(|_| place.clone(), |out| writeln!(out, "{json}"))?;
    Ok(format!("; {} describes it", name(&place)))
}

/// The path of the sidecar: NAME.json if that does not exist or belongs to this file, otherwise NAME.EXT.json.
fn place(path: &Path, name: &str) -> PathBuf {
    let short = path.with_extension("json");
    match belongs_to(&short).as_deref() {
        None if !fs::is_present(&short) => short,
        Some(file) if file == name || !fs::is_present(&path.with_file_name(file)) => short,
        _ => own(path),
    }
}

/// The file that an Orogen sidecar describes; `None` if the file is not a sidecar.
pub(super) fn belongs_to(sidecar: &Path) -> Option<String> {
    let mut text = String::new();
    File::open(sidecar).ok()?.take(1 << 16).read_to_string(&mut text).ok()?;
    let value: serde_json::Value = serde_json::from_str(&text).ok()?;
    let ours = value.get("made_by")?.as_str()?.starts_with("Orogen ");
    let file = value.get("file")?.as_str()?;
    ours.then(|| file.to_string())
}
