//! Views: the choice of a part of a world, a cell or a number of samples, and the window that it defines.

mod number;
mod region;
mod size;

use super::world::World;
use crate::recipe::document::Recipe;
use orogen_grid::error::{Error, ErrorKind, Result};
use orogen_grid::grid::Window;
use orogen_grid::words::number;
use orogen_io::format::dem::Georeference;

pub use number::{MAX_SIDE, finite};
pub use region::{Bounds, Rectangle};
pub use size::Size;

/// A choice of samples of a world. By default the whole world at its own cell.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct View {
    /// Distance between samples, in metres.
    pub cell: Option<f64>,
    /// A part of the world, relative to its north-west corner.
    pub window: Option<Rectangle>,
    /// A part of the world in map coordinates, if there is no `window`; in a world without a CRS, metres east and north
    /// of its north-west corner.
    pub bounds: Option<Bounds>,
    /// Samples along the sides of the world or of the part.
    pub size: Option<Size>,
}

/// Default number of samples per side of an unbounded world.
const UNBOUNDED: usize = 1024;

/// Maximum number of samples along a side of a whole world that is shown at its own cell.
const LARGE: f64 = 16_384.0;
/// Maximum number of samples along a side of a whole world that is shown at a larger cell.
const OVERVIEW: f64 = 4096.0;

/// Tolerance for coordinates that are meant to be at a sample, in cells.
const NEAR: f64 = 1e-6;

impl View {
    /// The same with this number of samples along the longer side, if neither a part nor a cell nor a size is chosen.
    #[must_use]
    pub fn sized(&self, side: usize) -> View {
        let is_chosen = self.window.is_some() || self.bounds.is_some() || self.cell.is_some() || self.size.is_some();
        if is_chosen { *self } else { View { size: Some(Size::Longer(side)), ..*self } }
    }

    /// The requested window: a part, or the whole world. A world of length L has round(L / cell) samples. For an
    /// unbounded world it starts at the origin and has the default size. A world that is too large for its own cell is
    /// shown as a whole at a larger cell, and `note` gets a remark about it.
    ///
    /// # Errors
    /// If the part is not inside the world or has no sample, the size has another aspect ratio, or the world cannot
    /// have such a window.
    pub fn window(&self, world: &World, note: impl FnOnce(&str)) -> Result<Window> {
        let window = self.unchecked(world, note)?;
        world.check(&window)?;
        Ok(window)
    }

    fn unchecked(&self, world: &World, note: impl FnOnce(&str)) -> Result<Window> {
        let (spec, size) = (&world.recipe().world, self.size);
        let cell = self.cell.unwrap_or(spec.cell);
        if let Some(part) = self.part(world.recipe(), cell)? {
            return Ok(part);
        }
        match (spec.size, size) {
            (Some(extent), None) => {
                let cell = self.cell.or_else(|| overview(world, extent, note)).unwrap_or(cell);
                world.full_window(cell)
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
    ///
    /// # Errors
    /// If it is not inside the world.
    pub fn ends(&self, recipe: &Recipe, cell: f64) -> Result<Option<[f64; 4]>> {
        let bounds = self.bounds;
        let map = recipe.georeference();
        let local = || Georeference::LOCAL;
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
                return Err(request(format!("{asked} not inside the world, which {}", reach(map, [width, height]))));
            }
        }
        Ok(Some(ends))
    }

    /// The requested part of the world, if any: in samples of `cell` metres, or with `size` samples.
    ///
    /// Bounds include samples at their west and north edges, and exclude those at their east and south edges. Adjacent
    /// parts therefore share no samples, and bounds along pixel edges of a GeoTIFF select the same pixels as
    /// gdal_translate.
    ///
    /// # Errors
    /// As [`View::window`].
    pub fn part(&self, recipe: &Recipe, cell: f64) -> Result<Option<Window>> {
        let size = self.size;
        if size.is_some() && self.cell.is_some() {
            let message = "--size and --cell both set the cell size; leave out one of them";
            return Err(request(message.into()));
        }
        if let Some(Rectangle::Samples(x, y, width, height)) = self.window {
            return match size {
                None => Ok(Some(Window { x, y, width, height, cell })),
                Some(_) => Err(request(
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
            return Err(request(format!(
                "the window of {} x {} m contains no sample at a cell size of {} m; use a larger window or a smaller --cell",
                number(extent[0]),
                number(extent[1]),
                number(cell)
            )));
        }
        Ok(Some(Window { x: x as i64, y: y as i64, width, height, cell }))
    }
}

fn request(message: String) -> Error {
    Error::new(ErrorKind::Request, message)
}

/// The cell at which a whole world is shown that has too many samples at its own cell: larger by a power of two. A file
/// of heights is always shown at its own cell.
fn overview(world: &World, extent: [f64; 2], note: impl FnOnce(&str)) -> Option<f64> {
    let cell = world.recipe().world.cell;
    let samples = |cell: f64| extent[0].max(extent[1]) / cell;
    if samples(cell) <= LARGE || world.recipe().is_dem() {
        return None;
    }
    let mut larger = cell;
    while samples(larger) > OVERVIEW {
        larger *= 2.0;
    }
    note(&format!(
        "a cell of {} m, because the whole world has {:.0} samples along a side at its own cell of {} m; --cell, --size, --window or \
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
fn fit(extent: [f64; 2], size: Size, what: &str) -> Result<(usize, usize, f64)> {
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
        false => Err(request(format!(
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

    fn look(size: &str, view: &View) -> std::result::Result<Window, String> {
        view.window(&world(size), |_| ()).map_err(|error| error.to_string())
    }

    fn view(size: Option<&str>, cell: Option<f64>) -> View {
        View { size: size.map(|text| text.parse().unwrap()), cell, ..View::default() }
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
        let mut remark = String::new();
        let whole = View::default().window(&world("size = [400000, 200000]"), |note| remark = note.to_string());
        assert!(whole.is_ok() && remark.starts_with("a cell of 160 m, because the whole world has 40000"), "{remark}");
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
        let part = |window: &str, bounds: &str, corners: &[f64]| View {
            window: (!window.is_empty()).then(|| window.parse().unwrap()),
            bounds: match corners {
                [] => (!bounds.is_empty()).then(|| bounds.parse().unwrap()),
                corners => Some(Bounds::of_corners(corners).unwrap()),
            },
            ..View::default()
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
        let sized = View { size: Some(Size::Longer(60)), ..part("", "1000,-700,1300,-500", &[]) };
        assert_eq!(look(local, &sized), Ok(Window::new(60, 40, 5.0).at(200, 100)));
        // Adjacent parts share no sample, and together equal the whole.
        let halves = ["0,-4000,3333,0", "3333,-4000,8000,0"].map(|bounds| look(local, &part("", bounds, &[])).unwrap());
        assert_eq!((halves[0].x, halves[0].width as i64, halves[1].x), (0, halves[1].x, 334));
        assert_eq!(halves[0].width + halves[1].width, 800);
        assert!(
            Bounds::of_corners(&[1.0, 2.0, 0.0, 1.0]).unwrap_err().contains("--projwin: the west, 1, must be less")
        );
        for (world, asked, expect) in [
            (local, part("", "0,0,100,100", &[]), "--bounds 0,-4000,8000,0"),
            (mapped, part("", "11,46,12,47", &[]), "extends over 600000,5196000,608000,5200000 in EPSG:32632"),
            (local, part("0m,0m,9km,1km", "", &[]), "the window is not inside the world"),
            (local, part("", "1001,-700,1009,-500", &[]), "the window of 8 x 200 m contains no sample"),
            (local, View { size: Some(Size::Longer(9)), ..part("0,0,5,5", "", &[]) }, "leave out --size"),
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
        assert_eq!(asked.window(&world, |_| ()).unwrap(), Window::new(800, 400, 10.0));
    }
}
