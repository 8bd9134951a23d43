//! Which samples of which world: the options for seed, size, cell, window and georeference shared by all commands, and
//! the window that they define. Apart from the seed, they only change which samples are taken; the world stays the
//! same.

use std::path::{Path, PathBuf};

use clap::Args;
use orogen::grid::words::number;
use orogen::io::dem::PreparedDem;
use orogen::io::dem::prepared::DEFAULT_MEMORY;
use orogen::io::format::Georeference;
use orogen::io::format::crs::Crs;
use orogen::{Budget, ErrorKind, Recipe, Window, World};

use crate::failure::Failure;
use crate::say;
use crate::sink::{DASH, is_stdout};
use crate::source::{Source, of_dem};
use crate::values::arguments::Arguments;
use crate::values::number::cell;
use crate::values::region::{Bounds, Rectangle, place};
use crate::values::seeds::Seeds;
use crate::values::size::Size;

/// Which samples of which world.
#[derive(Debug, Clone, Default, Args)]
#[command(next_help_heading = "World and window")]
pub struct View {
    /// Seed of the world, instead of the recipe's. Several seeds, such as 1,2,3 or 1..9, make one output each, named by
    /// its seed (NAME-7.png, or at {seed} in the name)
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
    /// Whether only the part of a file of heights that the window needs is read.
    #[arg(skip)]
    pub reads_part: bool,
}

/// The same where samples may also be counted.
#[derive(Debug, Clone, Default, Args)]
#[command(next_help_heading = "World and window")]
pub struct SizedView {
    /// What it is a size of.
    #[command(flatten)]
    pub view: View,
    /// Samples along the longer side, or along both (with the same aspect ratio), of the world or of the window
    #[arg(long, value_name = "N|WxH", allow_negative_numbers = true)]
    pub size: Option<Size>,
}

/// Default number of samples per side of an unbounded world.
const UNBOUNDED: usize = 1024;

/// Maximum number of samples along a side of a whole world that is shown at its own cell, and of one that is not.
const LARGE: f64 = 16_384.0;
const OVERVIEW: f64 = 4096.0;

/// Samples of a file of heights that are read around a window: as many as layers derived from heights usually need.
const SURROUNDINGS: usize = 64;

/// Tolerance, in cells, for coordinates that are meant to be those of a sample.
const NEAR: f64 = 1e-6;

impl SizedView {
    /// The requested window: see [`View::window`].
    pub fn window(&self, world: &World) -> Result<Window, Failure> {
        self.view.sized(world, self.size)
    }

    /// Whether a part of the world is requested.
    pub fn has_part(&self) -> bool {
        self.view.window.is_some() || self.view.bounds.is_some() || self.view.projwin.is_some()
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
            // What was written to a stream cannot be written again.
            let reads_part = out.as_deref() != Some(Path::new(DASH));
            let view = View { seed, reads_part, ..self.clone() };
            match work(view.clone(), out.clone()) {
                // Some work reads further than the surroundings of its window.
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

    /// Reads a recipe with these options for its parameters and its world. Its memory counts in `budget`.
    pub fn recipe(&self, source: &Source, budget: &Budget) -> Result<Recipe, Failure> {
        if let Some(path) = source.dem()
            && self.reads_part
            && self.arguments.values().is_empty()
            && (self.window.is_some() || self.bounds.is_some() || self.projwin.is_some())
            && let Some(outline) = PreparedDem::outline(path)?
        {
            let outline = self.placed(of_dem(path, outline));
            let part = match self.around(&outline) {
                Some(window) => PreparedDem::part(path, &window, budget.left().unwrap_or(DEFAULT_MEMORY))?,
                None => None,
            };
            return Ok(part.map_or(outline, |part| self.placed(of_dem(path, part))));
        }
        Ok(self.placed(source.read(budget, &self.arguments)?))
    }

    /// A recipe with these options for its world.
    fn placed(&self, mut recipe: Recipe) -> Recipe {
        let world = &mut recipe.world;
        world.seed = self.seed.as_ref().map_or(world.seed, Seeds::first);
        world.crs = self.crs.or(world.crs);
        world.origin = self.origin.or(world.origin);
        recipe
    }

    /// The requested part of a file of heights with its surroundings, on the lattice of the file. `None` if it cannot
    /// be told without `--size`.
    fn around(&self, recipe: &Recipe) -> Option<Window> {
        let lattice = recipe.world.cell;
        let Ok(Some(part)) = self.part(recipe, None, self.cell.unwrap_or(lattice)) else { return None };
        let first = |at: f64| (at / lattice).floor() as i64;
        let (x, y) = (first(part.east(0)), first(part.south(0)));
        let count = |start: i64, last: f64| (first(last).saturating_sub(start).max(0) as usize).saturating_add(2);
        let (width, height) = (count(x, part.east(part.width - 1)), count(y, part.south(part.height - 1)));
        Some(Window { x, y, width, height, cell: lattice }.grown(SURROUNDINGS))
    }

    /// The requested window: a part, or the whole world. A world of length L has round(L / cell) samples. For an
    /// unbounded world it starts at the origin and has the default size. A world that is too large for its own cell is
    /// shown as a whole with a larger one, and a note says so.
    pub fn window(&self, world: &World) -> Result<Window, Failure> {
        self.sized(world, None)
    }

    /// A window that the world can be asked for: estimates of its memory and time are numbers.
    fn sized(&self, world: &World, size: Option<Size>) -> Result<Window, Failure> {
        let window = self.asked(world, size)?;
        world.check(&window)?;
        Ok(window)
    }

    fn asked(&self, world: &World, size: Option<Size>) -> Result<Window, Failure> {
        let spec = &world.recipe().world;
        let cell = self.cell.unwrap_or(spec.cell);
        if let Some(part) = self.part(world.recipe(), size, cell)? {
            return Ok(part);
        }
        match (spec.size, size) {
            (Some(extent), None) => {
                let cell = self.cell.or_else(|| overview(world, extent)).unwrap_or(cell);
                Ok(world.full_window(cell)?)
            }
            (Some(extent), Some(size)) => {
                let [width, height] = extent.map(number);
                let (width, height, cell) = fit(extent, size, &format!("the world of {width} x {height} m"))?;
                Ok(Window::new(width, height, cell))
            }
            (None, None) => Ok(Window::new(UNBOUNDED, UNBOUNDED, cell)),
            (None, Some(Size::Longer(n))) => Ok(Window::new(n, n, cell)),
            (None, Some(Size::Both(width, height))) => Ok(Window::new(width, height, cell)),
        }
    }

    /// The requested part of the world, if it is given in metres or coordinates: its west, north, east and south in
    /// metres from the north-west corner. It may extend half a cell beyond the world.
    pub fn ends(&self, recipe: &Recipe, cell: f64) -> Result<Option<[f64; 4]>, Failure> {
        let bounds = match (&self.projwin, self.bounds) {
            (Some(corners), _) => Some(Bounds::of_corners(corners).map_err(Failure::Usage)?),
            (None, bounds) => bounds,
        };
        let map = recipe.georeference();
        let local = || Georeference { origin: [0.0; 2], per_metre: [1.0; 2], keys: None };
        let ends = match (self.window, bounds) {
            (Some(Rectangle::Samples(..)), _) => return Ok(None),
            (Some(Rectangle::Metres([x, y, width, height])), _) => [x, y, x + width, y + height],
            (None, Some(Bounds { west, south, east, north })) => {
                let place = map.clone().unwrap_or_else(local);
                let ([left, top], [right, bottom]) = (place.metres(west, north), place.metres(east, south));
                [left, top, right, bottom]
            }
            (None, None) => return Ok(None),
        };
        if let Some([width, height]) = recipe.world.size {
            // A pixel of a GeoTIFF extends half a cell beyond its sample.
            let spare = (0.5 + NEAR) * cell;
            let inside =
                ends[0] >= -spare && ends[1] >= -spare && ends[2] <= width + spare && ends[3] <= height + spare;
            if !inside {
                let asked = match bounds {
                    Some(Bounds { west, south, east, north }) => {
                        format!("the bounds {west},{south},{east},{north} are")
                    }
                    None => "the window is".into(),
                };
                return Err(Failure::Usage(format!(
                    "{asked} not inside the world, which {}",
                    reach(map, [width, height])
                )));
            }
        }
        Ok(Some(ends))
    }

    /// The requested part of the world, if any: in samples of `cell` metres, or with `size` samples.
    ///
    /// Bounds include samples at their west and north edges, and exclude those at their east and south edges. Adjacent
    /// parts therefore share no samples, and bounds along pixel edges of a GeoTIFF select the same pixels as
    /// gdal_translate.
    pub fn part(&self, recipe: &Recipe, size: Option<Size>, cell: f64) -> Result<Option<Window>, Failure> {
        if size.is_some() && self.cell.is_some() {
            let message = "--size and --cell both set the cell size; leave out one of them";
            return Err(Failure::Usage(message.into()));
        }
        if let Some(Rectangle::Samples(x, y, width, height)) = self.window {
            return match size {
                None => Ok(Some(Window { x, y, width, height, cell })),
                Some(_) => Err(Failure::Usage(
                    "--window counts samples already; leave out --size, or give the window in metres, such as \
                     0m,500m,2km,2km"
                        .into(),
                )),
            };
        }
        let Some(ends) = self.ends(recipe, cell)? else { return Ok(None) };
        let extent = [ends[2] - ends[0], ends[3] - ends[1]];
        let (counts, cell) = match size {
            Some(size) => {
                let [width, height] = extent.map(number);
                let (width, height, cell) = fit(extent, size, &format!("the window of {width} x {height} m"))?;
                (Some([width, height]), cell)
            }
            None => (None, cell),
        };
        let first = |at: f64| (at / cell - NEAR).ceil();
        let [x, y, right, bottom] = ends.map(first);
        let [width, height] = counts.unwrap_or([right - x, bottom - y].map(|count| count.max(0.0) as usize));
        if width == 0 || height == 0 {
            return Err(Failure::Usage(format!(
                "the window of {} x {} m contains no sample at a cell size of {} m; use a larger window or a smaller --cell",
                number(extent[0]),
                number(extent[1]),
                number(cell)
            )));
        }
        Ok(Some(Window { x: x as i64, y: y as i64, width, height, cell }))
    }
}

/// The cell that shows a whole world which has too many samples at its own cell: a power of two times as large. A file
/// of heights is always shown at its own. Prints a note.
fn overview(world: &World, extent: [f64; 2]) -> Option<f64> {
    let cell = world.recipe().world.cell;
    let samples = |cell: f64| extent[0].max(extent[1]) / cell;
    if samples(cell) <= LARGE || world.recipe().is_dem() {
        return None;
    }
    let mut larger = cell;
    while samples(larger) > OVERVIEW {
        larger *= 2.0;
    }
    say::error(&format!(
        "note: a cell of {} m, because the whole world has {:.0} samples along a side at its own cell of {} m; --cell, --size, --window or \
         --bounds select others",
        number(larger),
        samples(cell),
        number(cell)
    ));
    Some(larger)
}

/// The extent of a world, as text.
fn reach(map: Option<Georeference>, [width, height]: [f64; 2]) -> String {
    let Some(map) = map else {
        let [width, height] = [width, height].map(number);
        return format!(
            "extends {width} m to the east and {height} m to the south of (0, 0): --bounds 0,-{height},{width},0"
        );
    };
    let ([west, north], [east, south]) = (map.at(0.0, 0.0), map.at(width, height));
    let [west, south, east, north] = [west, south, east, north].map(coordinate(&map));
    let name = map.epsg().map_or(String::new(), |code| format!(" in EPSG:{code}"));
    format!("extends over {west},{south},{east},{north}{name}")
}

/// A coordinate, with a resolution of about a centimetre.
fn coordinate(map: &Georeference) -> impl Fn(f64) -> String + use<> {
    let scale = if map.counts_degrees() { 1e7 } else { 1e2 };
    move |at| ((at * scale).round() / scale).to_string()
}

/// Samples and cell for an extent in metres.
fn fit(extent: [f64; 2], size: Size, what: &str) -> Result<(usize, usize, f64), Failure> {
    let longer = extent[0].max(extent[1]);
    let (width, height) = match size {
        Size::Longer(n) => {
            let cell = longer / n as f64;
            let [width, height] = extent.map(|length| ((length / cell).round() as usize).max(1));
            return Ok((width, height, cell));
        }
        Size::Both(width, height) => (width, height),
    };
    let across = |of: usize, length: f64, from: f64| ((of as f64 * length / from).round() as usize).max(1);
    let fitting = [across(height, extent[0], extent[1]), across(width, extent[1], extent[0])];
    let is_wide = extent[0] >= extent[1];
    match if is_wide { fitting[1] == height } else { fitting[0] == width } {
        true => Ok((width, height, longer / if is_wide { width } else { height } as f64)),
        false => Err(Failure::Usage(format!(
            "--size {width}x{height} does not have the aspect ratio of {what}; the nearest sizes that do are {width}x{} and {}x{height}",
            fitting[1], fitting[0]
        ))),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn world(size: &str) -> World {
        let text = format!(
            "orogen = 1\n[world]\n{size}\ncell = 10\n[nodes.a]\nop = \"constant\"\n[outputs]\nheight = \"a\"\n"
        );
        World::open(Recipe::parse(&text, "test").unwrap()).unwrap()
    }

    fn look(size: &str, view: &SizedView) -> Result<Window, String> {
        match view.window(&world(size)) {
            Ok(window) => Ok(window),
            Err(Failure::Usage(message)) => Err(message),
            Err(Failure::Engine(error)) => Err(error.to_string()),
            Err(other) => panic!("{other:?}"),
        }
    }

    fn view(size: Option<&str>, cell: Option<f64>) -> SizedView {
        SizedView { size: size.map(|text| text.parse().unwrap()), view: View { cell, ..View::default() } }
    }

    #[test]
    fn windows_of_a_bounded_world() {
        let world = "size = [8000, 4000]";
        for (size, cell, (width, height, expect)) in [
            (None, None, (800, 400, 10.0)),
            (None, Some(20.0), (400, 200, 20.0)),
            (None, Some(7.0), (1143, 571, 7.0)),
            (Some("1000"), None, (1000, 500, 8.0)),
            (Some("1000x500"), None, (1000, 500, 8.0)),
            (Some("3"), None, (3, 2, 8000.0 / 3.0)),
            (Some("1"), None, (1, 1, 8000.0)),
        ] {
            assert_eq!(look(world, &view(size, cell)), Ok(Window::new(width, height, expect)), "{size:?} {cell:?}");
        }
        assert_eq!(look("size = [4000, 8000]", &view(Some("500x1000"), None)), Ok(Window::new(500, 1000, 8.0)));
    }

    #[test]
    fn a_huge_world_is_shown_with_a_larger_cell() {
        let world = "size = [400000, 200000]";
        assert_eq!(look(world, &view(None, None)), Ok(Window::new(2500, 1250, 160.0)));
        assert_eq!(look(world, &view(None, Some(10.0))), Ok(Window::new(40_000, 20_000, 10.0)));
        assert_eq!(look("size = [163840, 10]", &view(None, None)), Ok(Window::new(16_384, 1, 10.0)));
    }

    #[test]
    fn what_does_not_fit_is_a_sentence() {
        let world = "size = [8000, 4000]";
        let error = look(world, &view(Some("1000x1000"), None)).unwrap_err();
        assert!(error.contains("1000x500 and 2000x1000"), "{error}");
        assert!(look(world, &view(None, Some(9000.0))).unwrap_err().contains("smaller cell"));
        assert!(look(world, &view(None, Some(1e-9))).unwrap_err().contains("larger cell"));
    }

    #[test]
    fn windows_of_a_world_without_bounds() {
        for (size, cell, expect) in [
            (None, None, (1024, 1024, 10.0)),
            (None, Some(3.0), (1024, 1024, 3.0)),
            (Some("50"), None, (50, 50, 10.0)),
            (Some("50x70"), None, (50, 70, 10.0)),
        ] {
            let (width, height, cell_expected) = expect;
            let window = Window::new(width, height, cell_expected);
            assert_eq!(look("", &view(size, cell)), Ok(window), "{size:?} {cell:?}");
        }
    }

    #[test]
    fn parts_in_samples_metres_and_coordinates_are_the_same() {
        let local = "size = [8000, 4000]";
        let mapped = "size = [8000, 4000]\ncrs = \"EPSG:32632\"\norigin = [600000, 5200000]";
        let part = |window: &str, bounds: &str, projwin: &[f64]| SizedView {
            view: View {
                window: (!window.is_empty()).then(|| window.parse().unwrap()),
                bounds: (!bounds.is_empty()).then(|| bounds.parse().unwrap()),
                projwin: (!projwin.is_empty()).then(|| projwin.to_vec()),
                ..View::default()
            },
            size: None,
        };
        let expect = Window::new(30, 20, 10.0).at(100, 50);
        for (world, asked) in [
            (local, part("100,50,30,20", "", &[])),
            (local, part("1km,500m,300m,200m", "", &[])),
            (local, part("", "1000,-700,1300,-500", &[])),
            // At the edges of pixels, and at other points between samples.
            (local, part("", "995,-695,1295,-495", &[])),
            (local, part("", "991,-691,1291,-491", &[])),
            (mapped, part("100,50,30,20", "", &[])),
            (mapped, part("", "601000,5199300,601300,5199500", &[])),
            (mapped, part("", "", &[601000.0, 5199500.0, 601300.0, 5199300.0])),
        ] {
            assert_eq!(look(world, &asked), Ok(expect), "{asked:?}");
        }
        let sized = SizedView { size: Some(Size::Longer(60)), ..part("", "1000,-700,1300,-500", &[]) };
        assert_eq!(look(local, &sized), Ok(Window::new(60, 40, 5.0).at(200, 100)));
        // Adjacent parts share no sample, and together equal the whole.
        let halves = ["0,-4000,3333,0", "3333,-4000,8000,0"].map(|bounds| look(local, &part("", bounds, &[])).unwrap());
        assert_eq!((halves[0].x, halves[0].width as i64, halves[1].x), (0, halves[1].x, 334));
        assert_eq!(halves[0].width + halves[1].width, 800);
        for (world, asked, expect) in [
            (local, part("", "0,0,100,100", &[]), "--bounds 0,-4000,8000,0"),
            (mapped, part("", "11,46,12,47", &[]), "extends over 600000,5196000,608000,5200000 in EPSG:32632"),
            (local, part("0m,0m,9km,1km", "", &[]), "the window is not inside the world"),
            (local, part("", "1001,-700,1009,-500", &[]), "the window of 8 x 200 m contains no sample"),
            (local, part("", "", &[1.0, 2.0, 0.0, 1.0]), "--projwin: the west, 1, must be less"),
            (local, SizedView { size: Some(Size::Longer(9)), ..part("0,0,5,5", "", &[]) }, "leave out --size"),
        ] {
            let error = look(world, &asked).unwrap_err();
            assert!(error.contains(expect), "{asked:?}: {error}");
        }
    }

    #[test]
    fn degrees_are_metres_at_the_middle_latitude() {
        let world = world("size = [8000, 4000]\ncrs = \"EPSG:4326\"\norigin = [11.0, 47.0]");
        let map = world.recipe().georeference().unwrap();
        let ([west, north], [east, south]) = (map.at(0.0, 0.0), map.at(8000.0, 4000.0));
        assert!((east - west - 0.1052).abs() < 1e-3 && (north - south - 0.03598).abs() < 1e-4, "{east} {south}");
        let bounds = Bounds { west, south, east, north };
        let asked = View { bounds: Some(bounds), ..View::default() };
        assert_eq!(asked.window(&world).unwrap(), Window::new(800, 400, 10.0));
    }
}
