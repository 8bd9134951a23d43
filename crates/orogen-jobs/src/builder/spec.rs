//! The specification of a build.

use std::path::Path;

use crate::options::{Choice, OptionSpec, Options, ValueKind};
use orogen_engine::world::HEIGHT;
use orogen_grid::error::{Error, ErrorKind, Result};
use orogen_grid::grid::Window;
use orogen_io::format::encoding::Encoding;

/// The form of a result.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Form {
    /// One Cloud-Optimized GeoTIFF.
    Cog,
    /// A Zarr v3 group, one array per layer.
    Zarr,
    /// A folder of tiles that share their edges.
    Tiles(Samples),
    /// An XYZ tree of PNG tiles with encoded heights, with TileJSON.
    Xyz(Encoding),
    /// The tiles of such a tree in one PMTiles file, with heights rounded by the zoom.
    Pmtiles(Encoding),
}

/// The sample format of a folder's tiles.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Samples {
    /// 16-bit gray PNG, over the range of the whole window.
    Png,
    /// Headerless u16, little-endian, over the range of the whole window.
    R16,
    /// Headerless f32, little-endian.
    R32,
}

impl Form {
    /// The name in journals and messages.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Form::Cog => "cog",
            Form::Zarr => "zarr",
            Form::Tiles(Samples::Png) => "png",
            Form::Tiles(Samples::R16) => "r16",
            Form::Tiles(Samples::R32) => "r32",
            Form::Xyz(encoding) => encoding.name(),
            Form::Pmtiles(Encoding::TerrainRgb) => "pmtiles-terrain-rgb",
            Form::Pmtiles(_) => "pmtiles-terrarium",
        }
    }

    /// All forms.
    pub const ALL: [Form; 9] = [
        Form::Cog,
        Form::Zarr,
        Form::Tiles(Samples::Png),
        Form::Tiles(Samples::R16),
        Form::Tiles(Samples::R32),
        Form::Xyz(Encoding::Terrarium),
        Form::Xyz(Encoding::TerrainRgb),
        Form::Pmtiles(Encoding::Terrarium),
        Form::Pmtiles(Encoding::TerrainRgb),
    ];

    /// The form with this name.
    #[must_use]
    pub fn named(name: &str) -> Option<Form> {
        Form::ALL.into_iter().find(|form| form.name() == name)
    }

    /// The form for a file name's extension: `.tif`, `.tiff`, `.zarr` or `.pmtiles`.
    #[must_use]
    pub fn of(out: &Path) -> Option<Form> {
        let extension = out.extension()?.to_string_lossy().to_lowercase();
        match extension.as_str() {
            "tif" | "tiff" => Some(Form::Cog),
            "zarr" => Some(Form::Zarr),
            "pmtiles" => Some(Form::Pmtiles(Encoding::Terrarium)),
            _ => None,
        }
    }

    /// The form that follows from the name of the result and the option `tiles` of [`BuildSpec::OPTIONS`].
    ///
    /// # Errors
    /// If they do not determine it, or contradict each other.
    pub fn chosen(out: &Path, options: &Options) -> Result<Form> {
        let refuse = |message: String| Err(Error::new(ErrorKind::Request, message));
        match (Form::of(out), options.word("tiles").and_then(Form::named)) {
            (Some(form), None) | (None, Some(form)) => Ok(form),
            (Some(Form::Pmtiles(_)), Some(Form::Xyz(encoding))) => Ok(Form::Pmtiles(encoding)),
            (Some(Form::Pmtiles(_)), Some(_)) => {
                refuse("a .pmtiles file holds terrarium or terrain-rgb tiles; choose one of them with --tiles".into())
            }
            (Some(_), Some(_)) => refuse(format!(
                "--tiles writes a folder, but {} has the extension of a file; leave out one of them",
                out.display()
            )),
            (None, None) => refuse(format!(
                "{} does not determine what to build: use the extension .tif, .zarr or .pmtiles, or --tiles png, r16, r32, \
                 terrarium or terrain-rgb",
                out.display()
            )),
        }
    }

    /// The default side of a tile in samples; `None` if it depends on the window. For tiles that share their edges it
    /// is a power of two plus one, as game engines require.
    #[must_use]
    pub fn usual_tile(self) -> Option<usize> {
        match self {
            Form::Cog => None,
            Form::Zarr => Some(512),
            Form::Tiles(_) => Some(513),
            Form::Xyz(_) | Form::Pmtiles(_) => Some(256),
        }
    }

    /// Whether the result is a single file instead of a folder.
    #[must_use]
    pub fn is_file(self) -> bool {
        matches!(self, Form::Cog | Form::Pmtiles(_))
    }

    /// Whether the result has the tiles of web maps.
    #[must_use]
    pub fn is_map(self) -> bool {
        matches!(self, Form::Xyz(_) | Form::Pmtiles(_))
    }

    /// Whether the result can hold several layers.
    #[must_use]
    pub fn holds_many(self) -> bool {
        matches!(self, Form::Zarr | Form::Tiles(_))
    }
}

/// The specification of a build: which samples, and in which form.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
#[must_use]
pub struct BuildSpec {
    /// The form of the result.
    pub form: Form,
    /// The window.
    pub window: Window,
    /// Side of a tile in samples; `None`, the default, for [`Form::usual_tile`].
    pub tile: Option<usize>,
    /// The layers, without duplicates; `height` by default.
    pub layers: Vec<String>,
    /// The part that is made, from 1, and the number of parts; `None`, the default, for the whole build.
    pub part: Option<[usize; 2]>,
}

const TILES: &[Choice] = &[
    Choice::new("png", "16-bit grey PNG over the value range of all tiles; adjacent tiles share their edge samples"),
    Choice::new(
        "r16",
        "Headerless u16, little-endian, over the value range of all tiles; adjacent tiles share their edge samples",
    ),
    Choice::new("r32", "Headerless f32, little-endian; adjacent tiles share their edge samples"),
    Choice::new(
        "terrarium",
        "XYZ tree of Terrarium PNG tiles with TileJSON, for web maps, or a .pmtiles file of them (its default); in \
         EPSG:3857 those of OpenStreetMap",
    ),
    Choice::new(
        "terrain-rgb",
        "XYZ tree of Terrain-RGB PNG tiles with TileJSON, for web maps, or a .pmtiles file of them; in EPSG:3857 those of \
         OpenStreetMap",
    ),
];

const OPTIONS: &[OptionSpec] = &[
    OptionSpec::new("tiles", "TILES", ValueKind::Choice(TILES))
        .with_about("Kind of the tiles in a folder or a .pmtiles file"),
    OptionSpec::new("layers", "A,B", ValueKind::Text)
        .with_about("Layers to build, separated by commas")
        .with_default(HEIGHT),
    OptionSpec::new("tile", "N", ValueKind::Whole(1, 65_536)).with_about(
        "Samples along each side of a tile [default: 512; 513 for tiles that share their edges; 256 for tiles \
             of web maps]",
    ),
    OptionSpec::new("part", "K/N", ValueKind::Part(MAX_PARTS)).with_about(
        "Build only part K of N: N processes, also on other machines, make one result together, and the last one \
             finishes it",
    ),
];

/// Maximum number of parts.
const MAX_PARTS: u64 = 1_000_000;

/// Maximum length of a layer name that becomes part of a file name.
const LONGEST_NAME: usize = 100;

impl BuildSpec {
    /// The options, for front ends.
    pub const OPTIONS: &[OptionSpec] = OPTIONS;

    /// Sets the tiles, layers and part that are chosen by [`OPTIONS`](BuildSpec::OPTIONS).
    pub fn with_options(self, options: &Options) -> BuildSpec {
        let tile = options.whole("tile").map(|side| side as usize);
        let part = options.pair("part").map(|part| part.map(|number| number as usize));
        BuildSpec { tile, part, ..self }.with_layers(options.text("layers").unwrap_or(HEIGHT).split(','))
    }

    /// A build of the heights of a window.
    pub fn new(form: Form, window: Window) -> BuildSpec {
        BuildSpec { form, window, tile: None, layers: vec![HEIGHT.into()], part: None }
    }

    /// Sets the side of a tile, in samples.
    pub fn with_tile(self, tile: usize) -> BuildSpec {
        BuildSpec { tile: Some(tile), ..self }
    }

    /// Sets the layers.
    pub fn with_layers(self, layers: impl IntoIterator<Item = impl Into<String>>) -> BuildSpec {
        BuildSpec { layers: layers.into_iter().map(Into::into).collect(), ..self }
    }

    /// Sets the part that is made: part `number`, from 1, of `count`. Every part is one call of
    /// [`Build::run`](super::Build::run), in any process and any order; the call that completes the last part finishes
    /// the result.
    pub fn with_part(self, number: usize, count: usize) -> BuildSpec {
        BuildSpec { part: Some([number, count]), ..self }
    }

    /// Rejects specifications that no form can satisfy.
    ///
    /// # Errors
    /// If there are no layers, duplicate layers, a name that is not valid in file names, more layers than the form can
    /// hold, or no such part.
    pub fn check(&self) -> Result<()> {
        let refuse = |message: String| Err(Error::new(ErrorKind::Request, message));
        if self.layers.is_empty() {
            return refuse("no layer was chosen; name at least one with --layers".into());
        }
        if let Some([number, count]) = self.part
            && !(1..=count).contains(&number)
        {
            return refuse(format!("there is no part {number} of {count}: parts are counted from 1"));
        }
        if self.layers.len() > 1 && !self.form.holds_many() {
            return refuse(format!(
                "{} holds one layer, and {} were chosen; choose one, or build a .zarr or a folder of tiles",
                match self.form {
                    Form::Cog => "a GeoTIFF",
                    Form::Pmtiles(_) => "a .pmtiles file",
                    _ => "an XYZ tree",
                },
                self.layers.len()
            ));
        }
        for (i, layer) in self.layers.iter().enumerate() {
            if self.layers[..i].contains(layer) {
                return refuse(format!("the layer `{layer}` is listed twice"));
            }
            let plain = |c: char| c.is_alphanumeric() || matches!(c, '_' | '-' | '.');
            let named = self.form.holds_many();
            if named && (layer.starts_with(['.', '_']) || layer.len() > LONGEST_NAME || !layer.chars().all(plain)) {
                return refuse(format!(
                    "`{layer}` cannot be used in file names: at most {LONGEST_NAME} letters, digits, `-`, `_` and `.` are allowed, starting with a letter or digit; rename the output in the recipe"
                ));
            }
            if self.form == Form::Zarr && matches!(layer.as_str(), "x" | "y") {
                return refuse(format!(
                    "the layer `{layer}` has the name of a coordinate array of a .zarr; rename the output in the recipe"
                ));
            }
        }
        Ok(())
    }
}
