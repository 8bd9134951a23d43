//! Worlds: windows, points and objects of their layers.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use numpy::{PyArray1, PyArray2, PyReadonlyArray1};
use orogen::export::derived::list;
use orogen::export::layer_source::LayerSource;
use orogen::fit::FitJob;
use orogen::io::dem::PreparedDem;
use orogen::io::dem::prepared::DEFAULT_MEMORY;
use orogen::io::file;
use orogen::io::format::crs::Crs;
use orogen::io::format::dem::Dem;
use orogen::io::format::notes::SOFTWARE;
use orogen::io::format::png::{self, Picture, Pixel};
use orogen::jobs::AnalyzeJob;
use orogen::jobs::refine::RefineJob;
use orogen::options::Options;
use orogen::output::map::Painter;
use orogen::recipe::RecipeSource;
use orogen::recipe::presets as library;
use orogen::view::{Bounds, Rectangle, Size, View};
use orogen::world::HEIGHT;
use orogen::{
    Budget, Error, ErrorKind, FolderStore, Grid, Progress, Recipe, Result, Sampler, Session, SolutionStore, Window,
};
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict};

use crate::array::{Heights, array, grid};
use crate::failure::{internal, raised, refused};
use crate::options::{of_keywords, of_work};
use crate::output::{by_extension, policy};
use crate::run::run;

/// Column and row of the first sample, samples per row, rows, and the cell in metres.
pub type Part = (i64, i64, usize, usize, f64);

/// An opened recipe.
#[pyclass(frozen, module = "orogen._orogen")]
pub struct World {
    pub(crate) world: Arc<orogen::World>,
    session: Session,
    /// The files that it reads.
    pub(crate) inputs: Vec<PathBuf>,
    /// Whether it is a file of heights.
    pub(crate) is_place: bool,
    notes: Vec<String>,
}

#[pymethods]
impl World {
    /// Opens a recipe: the name of a preset or a path, a text, or heights.
    #[new]
    #[pyo3(signature = (*, source, text, heights, cell, parameters, seed, crs, origin, threads, memory, cache))]
    #[expect(clippy::too_many_arguments, reason = "the Python part gives them by name")]
    fn new(
        py: Python<'_>,
        source: Option<PathBuf>,
        text: Option<&str>,
        heights: Option<Heights<'_>>,
        cell: f64,
        parameters: Vec<(String, f64)>,
        seed: Option<u64>,
        crs: Option<&str>,
        origin: Option<[f64; 2]>,
        threads: Option<usize>,
        memory: Option<u64>,
        cache: Option<PathBuf>,
    ) -> PyResult<World> {
        let crs = crs.map(str::parse::<Crs>).transpose().map_err(|why| refused(py, &why))?;
        let dem = match heights {
            Some(heights) => {
                let grid = grid(&heights, cell)?;
                let [width, height] = [grid.width(), grid.height()];
                Some(Dem::new([width, height], grid.into_data(), None).map_err(|why| refused(py, &why))?)
            }
            None => None,
        };
        run(py, None, |_| {
            let budget = Budget::of(memory);
            let allowed = budget.left().unwrap_or(DEFAULT_MEMORY);
            let mut notes = Vec::new();
            let mut inputs = Vec::new();
            let mut is_place = false;
            let mut recipe = match (dem, text, source) {
                (Some(dem), ..) => {
                    is_place = true;
                    let ground = PreparedDem::of(dem, Some(cell), allowed).map_err(request)?;
                    notes.clone_from(&ground.notes);
                    Recipe::from_dem(Path::new("array"), &Arc::new(ground))
                }
                (None, Some(text), _) => Recipe::parse_with(text, "the recipe", &parameters)?,
                (None, None, source) => {
                    let source = RecipeSource::find(&source.unwrap_or_default())?;
                    if let RecipeSource::File(path) | RecipeSource::Dem(path) = &source {
                        inputs.push(path.clone());
                    }
                    is_place = matches!(source, RecipeSource::Dem(_));
                    source.open(&parameters, allowed, |note| notes.push(note.clone()))?
                }
            };
            recipe.world.seed = seed.unwrap_or(recipe.world.seed);
            recipe.world.crs = crs.or(recipe.world.crs);
            recipe.world.origin = origin.or(recipe.world.origin);
            inputs.extend(recipe.files());
            let store = cache.map(|folder| Arc::new(FolderStore::new(folder)) as Arc<dyn SolutionStore>);
            let options = orogen::Options { threads, memory: budget, store, ..orogen::Options::default() };
            let session = Session::new(options)?;
            let world = Arc::new(session.open(recipe)?);
            Ok(World { world, session, inputs, is_place, notes })
        })
    }

    /// Remarks about what was read.
    #[getter]
    fn notes(&self) -> Vec<String> {
        self.notes.clone()
    }

    /// The names of the recipe's outputs, each with its unit.
    #[getter]
    fn layers(&self) -> Vec<(String, &'static str)> {
        let unit = |name: &str| self.world.unit(name).unwrap_or_default();
        self.world.recipe().outputs().map(|name| (name.to_owned(), unit(name))).collect()
    }

    /// The recipe as TOML.
    #[getter]
    fn toml(&self) -> String {
        self.world.recipe().to_toml()
    }

    #[getter]
    fn about(&self) -> String {
        self.world.recipe().about.clone()
    }

    #[getter]
    fn seed(&self) -> u64 {
        self.world.recipe().world.seed
    }

    #[getter]
    fn cell(&self) -> f64 {
        self.world.recipe().world.cell
    }

    #[getter]
    fn size(&self) -> Option<(f64, f64)> {
        self.world.recipe().world.size.map(|[width, height]| (width, height))
    }

    #[getter]
    fn sea_level(&self) -> f64 {
        self.world.recipe().world.sea_level
    }

    /// The EPSG code of the coordinate reference system, if there is one.
    #[getter]
    fn epsg(&self) -> Option<u16> {
        self.world.recipe().georeference().and_then(|map| map.epsg())
    }

    /// The definition of the coordinate reference system as WKT, if there is one.
    #[getter]
    fn wkt(&self) -> Option<&'static str> {
        let code = self.epsg()?;
        Crs::from_epsg(code).ok().map(|crs| crs.wkt())
    }

    /// The map position of the origin, and map units per metre east and north; without a CRS the position is (0, 0) and
    /// a unit is a metre.
    #[getter]
    fn placement(&self) -> ([f64; 2], [f64; 2]) {
        match self.world.recipe().georeference() {
            Some(map) => (map.origin, map.per_metre),
            None => ([0.0; 2], [1.0; 2]),
        }
    }

    /// Name, value, minimum, maximum, unit and description of each parameter.
    #[getter]
    fn parameters(&self) -> Vec<(String, f64, f64, f64, String, String)> {
        let described = |parameter: &orogen::recipe::Parameter| {
            let [low, high] = parameter.range;
            (parameter.name.clone(), parameter.value, low, high, parameter.unit.clone(), parameter.help.clone())
        };
        self.world.recipe().parameters().iter().map(described).collect()
    }

    /// A hash of all that a layer depends on.
    fn key(&self, py: Python<'_>, layer: &str) -> PyResult<String> {
        let key = self.world.key(layer).map_err(|error| raised(py, &error))?;
        Ok(key.iter().map(|byte| format!("{byte:02x}")).collect())
    }

    /// The window that a choice of samples selects, and remarks.
    fn view(&self, py: Python<'_>, choice: Choice<'_>) -> PyResult<(Part, Vec<String>)> {
        let view = choice.view(py)?;
        let mut notes = Vec::new();
        let found = view.window(&self.world, |note| notes.push(note.to_owned()));
        let window = found.map_err(|error| raised(py, &error))?;
        Ok(((window.x, window.y, window.width, window.height, window.cell), notes))
    }

    /// The samples of layers over a window: arrays of shape (height, width), one for each layer, or for each channel
    /// of a derived layer.
    fn read<'py>(
        &self,
        py: Python<'py>,
        layers: Vec<String>,
        part: Part,
        options: &Bound<'py, PyDict>,
        progress: Option<&Bound<'py, PyAny>>,
    ) -> PyResult<Vec<Bound<'py, PyArray2<f32>>>> {
        let options = of_keywords(&of_work("layer"), options)?;
        let window = window_of(part);
        let grids = run(py, progress, |progress| match layers.as_slice() {
            [layer] if !self.has(layer) => self.derived(layer, &window, &options, progress),
            layers => {
                let names: Vec<&str> = layers.iter().map(String::as_str).collect();
                if let Some(name) = names.iter().find(|name| !self.has(name)) {
                    self.world.unit(name)?;
                }
                if let Some(name) = options.names().next() {
                    return Err(request(format!("--{name} does not apply to layers of the recipe")));
                }
                self.world.grids(&names, &window, progress)
            }
        })?;
        grids.into_iter().map(|grid| array(py, grid)).collect()
    }

    /// The values of a layer at points: metres east and south of the origin.
    fn points<'py>(
        &self,
        py: Python<'py>,
        layer: &str,
        x: PyReadonlyArray1<'py, f64>,
        y: PyReadonlyArray1<'py, f64>,
    ) -> PyResult<Bound<'py, PyArray1<f32>>> {
        let (x, y) = (positions(&x)?, positions(&y)?);
        let values = run(py, None, |_| self.world.points(layer, x, y))?;
        Ok(PyArray1::from_vec(py, values))
    }

    /// A layer that is prepared for many points.
    fn sampler(&self, py: Python<'_>, layer: &str) -> PyResult<Points> {
        let sampler = run(py, None, |_| Sampler::new(Arc::clone(&self.world), layer))?;
        Ok(Points { sampler })
    }

    /// A shaded relief of the heights in hypsometric colors, as the bytes of a PNG.
    fn picture<'py>(&self, py: Python<'py>, part: Part) -> PyResult<Bound<'py, PyBytes>> {
        let window = window_of(part);
        let bytes = run(py, None, |progress| {
            let grids = self.world.grids(&[HEIGHT], &window, progress)?;
            let Some(heights) = grids.first() else { return Ok(Vec::new()) };
            let painter = Painter::fit(heights, self.world.recipe().world.sea_level);
            let notes = [("Software", SOFTWARE)];
            let picture = Picture::new(window.width, window.height, Pixel::Rgb8).with_notes(&notes);
            let mut bytes = Vec::new();
            let painted = png::write(&mut bytes, &picture, |rows, part| {
                painter.paint(heights, rows, part);
                Ok(())
            });
            painted.map_err(|cause| file::explain("make", Path::new("the picture"), &cause))?;
            Ok(bytes)
        })?;
        Ok(PyBytes::new(py, &bytes))
    }

    /// The statistics of a layer over a window, as JSON; with `page`, a page of charts is written to this .png.
    #[expect(clippy::too_many_arguments, reason = "the Python part gives them by name")]
    fn analyze(
        &self,
        py: Python<'_>,
        name: &str,
        layer: &str,
        part: Part,
        page: Option<PathBuf>,
        overwrite: Option<bool>,
        progress: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<String> {
        let window = window_of(part);
        let mut job = AnalyzeJob::new(name, &Options::default()).with_place(self.is_place);
        job.layer = layer.to_owned();
        run(py, progress, |progress| {
            let output = page.map(|page| {
                by_extension(&page, &[((), "png")], "a page of charts")?;
                policy(overwrite).protecting(&self.inputs).output(page)
            });
            let output = output.transpose()?;
            let job = if output.is_some() { job.with_page(name) } else { job };
            let analysis = job.run(&self.world, &window, progress)?;
            if let Some((output, page)) = output.as_ref().zip(analysis.page.as_ref()) {
                file::write_whole(output, |out| page.write_png(out, &[("Software", SOFTWARE)]))?;
            }
            Ok(analysis.to_json())
        })
    }

    /// The same place at a smaller cell, with invented detail.
    fn refined(&self, py: Python<'_>, cell: Option<f64>, options: &Bound<'_, PyDict>) -> PyResult<World> {
        if !self.is_place {
            return Err(refused(
                py,
                "only heights can be refined: a file of heights or an array; choose `cell` in `window`",
            ));
        }
        let options = of_keywords(&of_work("refine"), options)?;
        run(py, None, |_| {
            let mut recipe = self.world.recipe().clone();
            RefineJob::new(&options)?.prepare(&mut recipe, cell)?;
            let world = Arc::new(self.session.open(recipe)?);
            let (session, inputs) = (self.session.clone(), self.inputs.clone());
            Ok(World { world, session, inputs, is_place: false, notes: Vec::new() })
        })
    }

    /// The objects over a window: the names of the entries, and for each object its entry, metres east and south,
    /// height, size and turn.
    #[expect(clippy::type_complexity, reason = "one array for each column")]
    fn objects<'py>(
        &self,
        py: Python<'py>,
        part: Part,
        progress: Option<&Bound<'py, PyAny>>,
    ) -> PyResult<(Vec<String>, Bound<'py, PyArray1<u32>>, Vec<Bound<'py, PyArray1<f64>>>)> {
        let window = window_of(part);
        let objects = run(py, progress, |progress| self.world.objects(&window, progress))?;
        let names = self.world.recipe().scatter().iter().map(|scatter| scatter.name.clone()).collect();
        let entries = PyArray1::from_iter(py, objects.iter().map(|object| object.entry as u32));
        let column = |value: fn(&orogen::Object) -> f64| PyArray1::from_iter(py, objects.iter().map(value));
        let columns = vec![
            column(|object| object.position[0]),
            column(|object| object.position[1]),
            column(|object| object.height),
            column(|object| object.size),
            column(|object| object.turn),
        ];
        Ok((names, entries, columns))
    }
}

impl World {
    /// Whether the recipe has a layer.
    fn has(&self, layer: &str) -> bool {
        self.world.unit(layer).is_ok()
    }

    /// The recipe opened again with what a job adds to it.
    pub(crate) fn prepared(&self, prepare: impl FnOnce(&mut Recipe) -> Result<()>) -> Result<orogen::World> {
        let mut recipe = self.world.recipe().clone();
        prepare(&mut recipe)?;
        self.session.open(recipe)
    }

    /// The world with all heights of its files, which identify a build.
    pub(crate) fn with_whole_files(&self) -> Result<Arc<orogen::World>> {
        let allowed = self.world.memory_limit().unwrap_or(DEFAULT_MEMORY);
        match self.world.recipe().with_whole_files(allowed)? {
            Some(recipe) => Ok(Arc::new(self.session.open(recipe)?)),
            None => Ok(Arc::clone(&self.world)),
        }
    }

    /// The channels of a layer that is derived from the heights.
    fn derived(&self, layer: &str, window: &Window, options: &Options, progress: &Progress) -> Result<Vec<Grid>> {
        derived(&self.prepared(|recipe| list::prepare(recipe, layer, options))?, layer, window, progress)
    }
}

/// The channels of a layer that is derived from the heights of a prepared world.
pub(crate) fn derived(world: &orogen::World, layer: &str, window: &Window, progress: &Progress) -> Result<Vec<Grid>> {
    if world.unit(layer).is_ok() {
        return world.grids(&[layer], window, progress);
    }
    let mut source = LayerSource::new(world, layer, *window, progress)?;
    let reserved = (window.len() as u64).saturating_mul(4 * source.channels() as u64);
    let _held = world.budget().reserve(reserved)?;
    source.whole().map_err(|cause| file::explain("make", Path::new(layer), &cause))
}

/// A layer that is prepared for many points.
#[pyclass(frozen, module = "orogen._orogen")]
pub struct Points {
    sampler: Sampler<Arc<orogen::World>>,
}

#[pymethods]
impl Points {
    /// The values at points: metres east and south of the origin.
    fn points<'py>(
        &self,
        py: Python<'py>,
        x: PyReadonlyArray1<'py, f64>,
        y: PyReadonlyArray1<'py, f64>,
    ) -> PyResult<Bound<'py, PyArray1<f32>>> {
        let (x, y) = (positions(&x)?, positions(&y)?);
        let made = py.detach(|| {
            let mut values = vec![0.0; x.len()];
            self.sampler.points(x, y, &mut values).map(|()| values)
        });
        Ok(PyArray1::from_vec(py, made.map_err(|error| raised(py, &error))?))
    }

    /// The samples of a window.
    fn window<'py>(&self, py: Python<'py>, part: Part) -> PyResult<Bound<'py, PyArray2<f32>>> {
        let window = window_of(part);
        let made = py.detach(|| self.sampler.window(&window));
        array(py, made.map_err(|error| raised(py, &error))?)
    }
}

/// A recipe with the statistics of heights, as TOML, and the comparison of both, as JSON.
#[pyfunction]
#[pyo3(signature = (heights, cell, name, options, threads, memory, progress))]
#[expect(clippy::too_many_arguments, reason = "the Python part gives them by name")]
pub fn fit<'py>(
    py: Python<'py>,
    heights: Heights<'py>,
    cell: f64,
    name: &str,
    options: &Bound<'py, PyDict>,
    threads: Option<usize>,
    memory: Option<u64>,
    progress: Option<&Bound<'py, PyAny>>,
) -> PyResult<(String, String)> {
    let job = FitJob::new(&of_keywords(&of_work("fit"), options)?);
    let heights = grid(&heights, cell)?;
    let limits = orogen::Options { threads, memory: Budget::of(memory), ..orogen::Options::default() };
    run(py, progress, |progress| {
        let _place = limits.memory.reserve(4 * heights.data().len() as u64)?;
        let found = job.run(&heights, name, &limits, progress)?;
        Ok((found.recipe.to_toml(), found.report.to_json()))
    })
}

/// Name and description of each preset.
#[pyfunction]
pub fn presets(py: Python<'_>) -> PyResult<Vec<(&'static str, String)>> {
    let described = |preset: &library::Preset| Ok((preset.name, preset.recipe()?.about));
    library::all().iter().map(described).collect::<Result<_>>().map_err(|error| raised(py, &error))
}

/// The folder where solutions are kept unless another one is chosen; `None` if there is none.
#[pyfunction]
pub fn cache_folder() -> Option<PathBuf> {
    FolderStore::usual_folder()
}

/// The bytes that a text such as "2GiB" stands for.
#[pyfunction]
pub fn memory_of(py: Python<'_>, text: &str) -> PyResult<u64> {
    orogen::budget::bytes(text).map_err(|why| refused(py, &format!("`memory`: {why}")))
}

/// The window of a part.
pub fn window_of((x, y, width, height, cell): Part) -> Window {
    Window { x, y, width, height, cell }
}

/// A choice of samples: a window as text or as four numbers of samples; west, south, east and north; one number of
/// samples or two; and the cell in metres.
#[derive(FromPyObject)]
pub struct Choice<'py>(Option<Bound<'py, PyAny>>, Option<[f64; 4]>, Option<Vec<usize>>, Option<f64>);

impl Choice<'_> {
    /// The choice, as the library takes it.
    ///
    /// # Errors
    /// `RequestError` if a value is not valid.
    pub fn view(&self, py: Python<'_>) -> PyResult<View> {
        let Choice(window, bounds, size, cell) = self;
        let window = window.as_ref().map(rectangle).transpose()?;
        let bounds = bounds.map(|[west, south, east, north]| Bounds::of_corners(&[west, north, east, south]));
        let bounds = bounds.transpose().map_err(|why| refused(py, &why.replace("--projwin: ", "`bounds`: ")))?;
        let size = match size.as_deref() {
            None => None,
            Some([0, ..] | [_, 0, ..]) => return Err(refused(py, "`size` must be at least 1 sample")),
            Some(&[side]) => Some(Size::Longer(side)),
            Some(&[width, height]) => Some(Size::Both(width, height)),
            Some(_) => return Err(refused(py, "`size` must be one number of samples or two: (width, height)")),
        };
        if cell.is_some_and(|cell| !(cell.is_finite() && cell > 0.0)) {
            return Err(refused(py, "`cell` must be a number of metres greater than 0"));
        }
        Ok(View { cell: *cell, window, bounds, size })
    }
}

/// A window as text, or as four numbers of samples.
fn rectangle(window: &Bound<'_, PyAny>) -> PyResult<Rectangle> {
    if let Ok(text) = window.extract::<String>() {
        return text.parse().map_err(|why: String| refused(window.py(), &why));
    }
    match window.extract::<(i64, i64, usize, usize)>() {
        Ok((_, _, 0, _) | (_, _, _, 0)) => Err(refused(window.py(), "`window` must have at least 1 sample")),
        Ok((x, y, width, height)) => Ok(Rectangle::Samples(x, y, width, height)),
        Err(_) => Err(refused(
            window.py(),
            "`window` must be (x, y, width, height) in samples, or a text in metres such as \"0m,500m,2km,2km\"",
        )),
    }
}

fn positions<'a>(array: &'a PyReadonlyArray1<'_, f64>) -> PyResult<&'a [f64]> {
    array.as_slice().map_err(|_| internal(array.py(), "an array that is not contiguous"))
}

pub(crate) fn request(message: String) -> Error {
    Error::new(ErrorKind::Request, message)
}
