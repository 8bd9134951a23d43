//! Which samples of which world: the options for seed, size, cell, window and georeference that all commands share, and
//! the window that they define. Apart from the seed, they only select samples and do not change the world.

use std::path::{Path, PathBuf};

use clap::Args;
use orogen::io::dem::PreparedDem;
use orogen::io::dem::prepared::DEFAULT_MEMORY;
use orogen::io::format::crs::Crs;
use orogen::view::{self, Bounds, Rectangle, Size};
use orogen::{Budget, ErrorKind, Recipe, Window, World};

use crate::failure::Failure;
use crate::say;
use crate::sink::{DASH, is_stdout};
use crate::source::{Source, of_dem};
use crate::values::arguments::Arguments;
use crate::values::number::cell;
use crate::values::region::place;
use crate::values::seeds::Seeds;

/// Which samples of which world.
#[derive(Debug, Clone, Default, Args)]
#[command(next_help_heading = "World and window")]
pub struct View {
    /// Seed of the world, instead of the recipe's. Several seeds, such as 1,2,3 or 1..9, make one output each, with the
    /// seed in its name (NAME-7.png, or in place of {seed})
    #[arg(long, value_name = "N", allow_negative_numbers = true)]
    pub seed: Option<Seeds>,
    #[command(flatten)]
    pub arguments: Arguments,
    /// Cell size in metres [default: the world's cell; except for `build`, a whole world of more than 16384 samples
    /// along a side is shown with at most 4096]
    #[arg(long, value_name = "M", value_parser = cell, allow_negative_numbers = true)]
    pub cell: Option<f64>,
    /// Window of the world: column and row of its first sample, width and height, in samples; or in metres, such as
    /// 0m,500m,2km,2km
    #[arg(long, value_name = "X,Y,W,H", conflicts_with_all = ["bounds", "projwin"], allow_hyphen_values = true)]
    pub window: Option<Rectangle>,
    /// Window of the world in map coordinates; in a world without a CRS, metres east and north of its north-west corner
    /// (coordinates south of it are negative)
    #[arg(long, value_name = "W,S,E,N", conflicts_with = "projwin", allow_hyphen_values = true)]
    pub bounds: Option<Bounds>,
    /// Window given by its upper left and lower right corner, as in gdal_translate
    #[arg(long, value_names = ["ULX", "ULY", "LRX", "LRY"], num_args = 4, allow_negative_numbers = true)]
    pub projwin: Option<Vec<f64>>,
    /// Coordinate reference system of the world, such as EPSG:32632, for GeoTIFF and other georeferenced files
    #[arg(long, value_name = "EPSG:N")]
    pub crs: Option<Crs>,
    /// Position of the world's north-west corner in the CRS: easting and northing, or longitude and latitude
    #[arg(long, value_name = "E,N", value_parser = place, allow_hyphen_values = true)]
    pub origin: Option<[f64; 2]>,
    /// Whether the window of a file of heights and its surroundings are read before the world is opened.
    #[arg(skip)]
    pub reads_part: bool,
}

/// A view whose size can also be given in samples.
#[derive(Debug, Clone, Default, Args)]
#[command(next_help_heading = "World and window")]
pub struct SizedView {
    /// The view that the size belongs to.
    #[command(flatten)]
    pub view: View,
    /// Samples along the longer side, or along both (with the same aspect ratio), of the world or of the window
    #[arg(long, value_name = "N|WxH", allow_negative_numbers = true)]
    pub size: Option<Size>,
}

/// Number of samples of a file of heights that are read around a window: enough for most layers derived from heights.
const SURROUNDINGS: usize = 64;

impl SizedView {
    /// The requested window: see [`View::window`].
    pub fn window(&self, world: &World) -> Result<Window, Failure> {
        sized(&self.view, world, self.size)
    }

    /// See [`View::each_seed`].
    pub fn each_seed(
        &self,
        out: Option<&Path>,
        mut work: impl FnMut(SizedView, Option<PathBuf>) -> Result<(), Failure>,
    ) -> Result<(), Failure> {
        self.view.each_seed(out, |view, out| work(SizedView { view, size: self.size }, out))
    }

    /// See [`View::each_output`].
    pub fn each_output(
        &self,
        out: &Path,
        mut work: impl FnMut(SizedView, PathBuf) -> Result<(), Failure>,
    ) -> Result<(), Failure> {
        self.view.each_output(out, |view, out| work(SizedView { view, size: self.size }, out))
    }
}

impl View {
    /// Calls a function for each seed, with the view of that seed and the name of its output: see [`Seeds::each`].
    pub fn each_seed(
        &self,
        out: Option<&Path>,
        mut work: impl FnMut(View, Option<PathBuf>) -> Result<(), Failure>,
    ) -> Result<(), Failure> {
        // Other names of standard output, such as /dev/stdout, cannot have a seed in them.
        let out = out.map(|out| if is_stdout(out) { Path::new(DASH) } else { out });
        Seeds::each(self.seed.as_ref(), out, |seed, out| {
            // Output that was written to a stream cannot be written again.
            let reads_part = out.as_deref() != Some(Path::new(DASH));
            let view = View { seed, reads_part, ..self.clone() };
            match work(view.clone(), out.clone()) {
                // Some work reads further than the surroundings of its window. It opens the file instead, and the
                // engine reads what it needs.
                Err(Failure::Engine(error)) if error.kind() == ErrorKind::Part && reads_part => {
                    work(View { reads_part: false, ..view }, out)
                }
                done => done,
            }
        })
    }

    /// [`View::each_seed`] of a command that always has an output.
    pub fn each_output(
        &self,
        out: &Path,
        mut work: impl FnMut(View, PathBuf) -> Result<(), Failure>,
    ) -> Result<(), Failure> {
        self.each_seed(Some(out), |view, out| work(view, out.unwrap_or_default()))
    }

    /// Whether a part of the world is requested.
    fn has_part(&self) -> bool {
        self.window.is_some() || self.bounds.is_some() || self.projwin.is_some()
    }

    /// Reads a recipe with these options for its parameters and its world. Its memory counts towards `budget`.
    pub fn recipe(&self, source: &Source, budget: &Budget) -> Result<Recipe, Failure> {
        if let Some(path) = source.dem()
            && self.reads_part
            && self.arguments.values().is_empty()
            && self.has_part()
            && let Some(outline) = PreparedDem::outline(path)?
        {
            let outline = self.placed(of_dem(path, outline));
            let part = match self.around(&outline) {
                Some(window) => PreparedDem::part(path, &window, budget.left().unwrap_or(DEFAULT_MEMORY))?,
                None => None,
            };
            return Ok(part.map_or(outline, |part| self.placed(of_dem(path, part))));
        }
        let recipe = match self.has_part() {
            true => source.open(budget, &self.arguments),
            false => source.read(budget, &self.arguments),
        };
        Ok(self.placed(recipe?))
    }

    /// Applies these options to the world of a recipe.
    fn placed(&self, mut recipe: Recipe) -> Recipe {
        let world = &mut recipe.world;
        world.seed = self.seed.as_ref().map_or(world.seed, Seeds::first);
        world.crs = self.crs.or(world.crs);
        world.origin = self.origin.or(world.origin);
        recipe
    }

    /// The requested part of a file of heights with its surroundings, on the lattice of the file. `None` if it cannot
    /// be determined without `--size`.
    fn around(&self, recipe: &Recipe) -> Option<Window> {
        let lattice = recipe.world.cell;
        let part = self.samples(None).ok()?.part(recipe, self.cell.unwrap_or(lattice)).ok()??;
        let first = |at: f64| (at / lattice).floor() as i64;
        let (x, y) = (first(part.east(0)), first(part.south(0)));
        let count = |start: i64, last: f64| (first(last).saturating_sub(start).max(0) as usize).saturating_add(2);
        let (width, height) = (count(x, part.east(part.width - 1)), count(y, part.south(part.height - 1)));
        Some(Window { x, y, width, height, cell: lattice }.grown(SURROUNDINGS))
    }

    /// The samples that these options select, with this size.
    pub fn samples(&self, size: Option<Size>) -> Result<view::View, Failure> {
        let corners = self.projwin.as_deref().map(Bounds::of_corners).transpose().map_err(Failure::Usage)?;
        Ok(view::View { cell: self.cell, window: self.window, bounds: corners.or(self.bounds), size })
    }

    /// The requested window. Prints a note if the world is shown with a larger cell.
    pub fn window(&self, world: &World) -> Result<Window, Failure> {
        sized(self, world, None)
    }
}

fn sized(view: &View, world: &World, size: Option<Size>) -> Result<Window, Failure> {
    let note = |note: &str| say::error(&format!("note: {note}"));
    Ok(view.samples(size)?.window(world, note)?)
}
