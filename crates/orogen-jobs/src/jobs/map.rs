//! A map sheet as one job.

use std::io;
use std::path::{Path, PathBuf};

pub use super::drawn_map::DrawnMap;
use super::drawn_map::numbers;
use super::sheet_format::SheetFormat;
use super::{finite, map_names, map_roads, map_water};
use crate::export::derived::list;
use crate::export::layer_source::LayerSource;
use crate::export::{biome_cover, sheet_cover};
use crate::options::Options;
use orogen_engine::layer::LayerKind;
use orogen_engine::recipe::document::Recipe;
use orogen_engine::world::{HEIGHT, World};
use orogen_grid::contour::levels;
use orogen_grid::error::{Error, ErrorKind, Result};
use orogen_grid::grid::{Grid, Window};
use orogen_grid::progress::Progress;
use orogen_grid::words::number;
use orogen_io::file::{self, Output};
use orogen_io::format::dem::Georeference;
use orogen_io::format::points::NamedPoints;
use orogen_io::palette::named;
use orogen_io::palette::palette::Palette;
use orogen_output::sheet::draw::draw;
use orogen_output::sheet::linework::{least_areas, lines_at};
use orogen_output::sheet::options::{
    Coloring, GridStep, Labels, Layer, Page, PageColors, Parts, Resolution, Scale, Shading, SheetOptions,
};

/// What the colors of a map show.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
#[non_exhaustive]
pub enum MapColors {
    /// The heights or another layer, with a palette.
    #[default]
    Palette,
    /// The recipe's surfaces, or the standard ones.
    Surfaces,
    /// The classes of an output that is the layer of a `biome`.
    Biomes,
    /// The recipe's terrain classes.
    Classes,
}

impl MapColors {
    /// What the legend lists.
    #[must_use]
    pub fn plural(self) -> &'static str {
        match self {
            MapColors::Palette => "values",
            MapColors::Surfaces => "surfaces",
            MapColors::Biomes => "biomes",
            MapColors::Classes => "classes",
        }
    }
}

/// A map sheet of a world.
///
/// [`prepare`](MapJob::prepare) a recipe, open its world, then write [to a file](MapJob::to_file); or
/// [`draw`](MapJob::draw) the sheet and write it yourself.
///
/// ```
/// use orogen_engine::{Progress, Window, World, presets};
/// use orogen_io::file::OutputPolicy;
/// use orogen_jobs::jobs::{map::MapJob, sheet_format::SheetFormat};
///
/// let mut recipe = presets::find("hills").ok_or("no such preset")?.recipe()?;
/// let job = MapJob::new(SheetFormat::Svg).with_title("Hills").with_window(Window::new(64, 48, 30.0));
/// job.prepare(&mut recipe)?;
/// let path = std::env::temp_dir().join(format!("orogen-doc-map-{}.svg", std::process::id()));
/// job.to_file(&World::open(recipe)?, &OutputPolicy::default().output(&path)?, &Progress::none())?;
/// # std::fs::remove_file(&path).ok();
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone)]
#[non_exhaustive]
#[must_use]
pub struct MapJob {
    /// The kind of file.
    pub format: SheetFormat,
    /// What the colors show.
    pub colors: MapColors,
    /// The layer that is colored with the palette; `height` by default. Other layers have no lines and no water, which
    /// would hide them.
    pub layer: String,
    /// Options of a derived layer.
    pub layer_options: Options,
    /// How values of another layer than the heights are mapped to colors; by default what suits the layer.
    pub scale: Option<Scale>,
    /// The values at the ends of the palette; by default the minimum and maximum.
    pub range: Option<[f32; 2]>,
    /// The palette; by default that of the layer.
    pub palette: Option<Palette>,
    /// The relief shading.
    pub shading: Shading,
    /// Contour interval in metres; by default a round number that suits relief and scale.
    pub interval: Option<f64>,
    /// The heights of contours in metres, in place of an interval.
    pub levels: Option<Vec<f64>>,
    /// The contours that have labels: by default index contours, or all if their heights are given.
    pub labels: Option<Labels>,
    /// The colors of the page and of its lines.
    pub page_colors: PageColors,
    /// The coordinate grid; none by default.
    pub grid: Option<GridStep>,
    /// Minimum drainage area of rivers in m^2; by default it depends on the scale, and is at least 100 000. With
    /// one, rivers are also searched for in land that nothing drains, such as bare noise.
    pub river_area: Option<f64>,
    /// Minimum area of lakes in m^2; by default it depends on the scale.
    pub lake_area: Option<f64>,
    /// Points and lines whose names are shown, in map coordinates, or in metres east and north of the world's origin;
    /// the most important first. Those without room are left out.
    pub names: NamedPoints,
    /// A file of points and lines (`.csv` or `.geojson`), in the same coordinates, with further names.
    pub names_file: Option<PathBuf>,
    /// The denominator of the map's scale, such as 100 000, which sets the size of the page. Paper has a size of its
    /// own.
    pub map_scale: Option<f64>,
    /// The heading.
    pub title: String,
    /// Width and height of the paper in millimetres; by default the page fits the map.
    pub paper: Option<[f64; 2]>,
    /// The resolution; by default 220 pixels per inch, and 150 for a picture without paper.
    pub resolution: Option<Resolution>,
    /// The parts of the sheet.
    pub parts: Parts,
    /// Whether the world is a real place, a file of heights: it has no sea level, and its lakes are level in the data
    /// already.
    pub is_place: bool,
    /// Whether georeferencing files are written beside a picture, if the world has a position on a map.
    pub has_sidecars: bool,
    /// The window; by default the whole world at its own cell, which must then be bounded.
    pub window: Option<Window>,
}

/// The palette of a layer without a palette of its name.
const LAYER_PALETTE: &str = "viridis";

/// Longer side of a map on a fitted page, in millimetres.
const LONGER: f64 = 240.0;

/// Default resolution in pixels per inch: of pictures, and on paper and in vector files.
const SCREEN: f64 = 150.0;
const PRINT: f64 = 220.0;

/// Longer sides of a map at a scale, in millimetres.
const PAGES: std::ops::RangeInclusive<f64> = 20.0..=5000.0;

/// Maximum number of names in a file.
const MAX_NAMES: usize = 10_000;

/// Maximum number of pixels of a page.
const MOST: f64 = 4e8;

/// Approximate time of drawing per sample of the heights, and of drawing and writing per pixel of the page, in
/// nanoseconds.
const DRAWING: f64 = 400.0;
const WRITING: f64 = 60.0;

impl MapJob {
    /// The heights of the whole world with all parts, without a heading.
    pub fn new(format: SheetFormat) -> MapJob {
        MapJob {
            format,
            colors: MapColors::default(),
            layer: HEIGHT.into(),
            layer_options: Options::default(),
            scale: None,
            range: None,
            palette: None,
            shading: Shading::default(),
            interval: None,
            levels: None,
            labels: None,
            page_colors: PageColors::default(),
            grid: None,
            river_area: None,
            lake_area: None,
            names: NamedPoints::default(),
            names_file: None,
            map_scale: None,
            title: String::new(),
            paper: None,
            resolution: None,
            parts: Parts::default(),
            is_place: false,
            has_sidecars: true,
            window: None,
        }
    }

    /// The same with these colors.
    pub fn with_colors(self, colors: MapColors) -> MapJob {
        MapJob { colors, ..self }
    }

    /// The same for this layer.
    pub fn with_layer(self, layer: impl Into<String>) -> MapJob {
        MapJob { layer: layer.into(), ..self }
    }

    /// The same with this heading.
    pub fn with_title(self, title: impl Into<String>) -> MapJob {
        MapJob { title: title.into(), ..self }
    }

    /// The same over this window.
    pub fn with_window(self, window: Window) -> MapJob {
        MapJob { window: Some(window), ..self }
    }

    /// Checks that the options do not contradict each other.
    ///
    /// # Errors
    /// If they do, or the page is too large.
    pub fn check(&self) -> Result<()> {
        let refuse = |message: String| Err(Error::new(ErrorKind::Request, message));
        if self.is_covered() && (self.layer != HEIGHT || self.palette.is_some() || self.range.is_some()) {
            return refuse(format!("a map of {} has no other layer, palette or range", self.colors.plural()));
        }
        if self.scale.is_some() && self.layer == HEIGHT {
            return refuse("heights are always mapped to colors on a linear scale; leave out the scale".into());
        }
        if let Some(levels) = &self.levels {
            if self.interval.is_some() {
                return refuse("contours have an interval or given heights; leave out one of them".into());
            }
            if levels.is_empty() {
                return refuse("the list of contour heights is empty".into());
            }
            levels::given(levels)?;
            if self.labels == Some(Labels::Index) {
                return refuse("contours at given heights have no index contours; label all of them, or none".into());
            }
        }
        if self.map_scale.is_some() && self.paper.is_some() {
            return refuse("the scale sets the size of the page; leave out the paper".into());
        }
        if let (Some(scale), Page::Fitted(longer)) = (self.map_scale, self.page())
            && !PAGES.contains(&longer)
        {
            let suits = |millimetres: f64| number(scale * longer / millimetres);
            return refuse(format!(
                "at a scale of 1 : {} the map is {} mm long; choose a scale from 1 : {} to 1 : {}",
                number(scale),
                number(longer),
                suits(*PAGES.end()),
                suits(*PAGES.start())
            ));
        }
        if self.is_too_large() {
            return refuse(format!(
                "there is not enough memory for a page of {:.0} pixels per side; use a lower resolution or a smaller paper",
                self.side()
            ));
        }
        Ok(())
    }

    /// Whether the page has more pixels than a map may have.
    #[must_use]
    pub fn is_too_large(&self) -> bool {
        self.side() * self.side() > MOST
    }

    /// Pixels along a side of a square that contains the page.
    #[must_use]
    pub fn side(&self) -> f64 {
        match self.resolution() {
            Resolution::Inch(dpi) => longer(self.page()) * dpi / 25.4,
            Resolution::Longer(pixels) => f64::from(pixels),
        }
    }

    /// Appends to a recipe the nodes that the map needs; call it before the world is opened.
    ///
    /// # Errors
    /// The errors of [`list::prepare`].
    pub fn prepare(&self, recipe: &mut Recipe) -> Result<()> {
        list::prepare(recipe, &self.layer, &self.layer_options)?;
        if self.colors == MapColors::Surfaces {
            sheet_cover::prepare(recipe);
        }
        Ok(())
    }

    /// Draws the sheet and writes it to a file, with georeferencing files beside a picture, atomically.
    ///
    /// # Errors
    /// The errors of [`draw`](MapJob::draw), or if a file cannot be written.
    pub fn to_file(&self, world: &World, output: &Output, progress: &Progress) -> Result<DrawnMap> {
        file::check_folder(file::folder(output.path()))?;
        let drawn = self.draw(world, progress)?;
        drawn.to_file(output)?;
        Ok(drawn)
    }

    /// Draws the sheet of a world of a [prepared](MapJob::prepare) recipe. Writing it is the rest of `progress`.
    ///
    /// # Errors
    /// The errors of [`check`](MapJob::check); if the world has no such layer, surfaces or classes, or cannot make the
    /// window; if memory does not suffice (then nothing was started); or the work was cancelled.
    pub fn draw(&self, world: &World, progress: &Progress) -> Result<DrawnMap> {
        let Some(window) = self.window else {
            return self.clone().with_window(world.full_window(world.recipe().world.cell)?).draw(world, progress);
        };
        self.check()?;
        let mut options = self.options(world);
        let mut warnings = Vec::new();
        let map = options.map.clone();
        let names = self.all_names(map.as_ref())?;
        map_names::add(&mut options, &names, map.as_ref(), &window, &mut warnings);
        let shows_biomes = self.shows_biomes(world.recipe());
        let (plan, reserved) = world.plan_beside(&[HEIGHT], &window, self.memory(&window, shows_biomes))?;
        let work = world.work(&plan)?;
        let layered = if self.layer == HEIGHT && !self.is_covered() { 0.0 } else { work };
        let pixels = self.side() * self.side();
        let is_known = (options.parts.rivers || options.parts.lakes) && map_water::is_known(world.recipe(), &window);
        let watering = if is_known { work } else { 0.0 };
        let [making, watering, layering, drawing, writing] =
            progress.parts([work, watering, layered, DRAWING * window.len() as f64, WRITING * pixels]);
        let heights = world.run(&plan, &making)?.pop().unwrap_or_else(|| Grid::filled(window, f32::NAN));
        finite::check(HEIGHT, &heights, &mut warnings)?;
        if is_known {
            let [river, lake] = least_areas(&window, options.page);
            let least = [options.river_area.unwrap_or(river), options.lake_area.unwrap_or(lake)];
            options.water = Some(map_water::of(world, &window, least, 4 * window.len() as u64, &watering)?);
        }
        if options.parts.roads {
            options.roads = map_roads::of(world, &window, &progress.part(0.0))?;
        }
        if self.layer != HEIGHT && !shows_biomes {
            options.coloring = Coloring::Layer(self.layer(world, &window, &mut warnings, &layering)?);
        }
        let (sea, made) = (options.sea_level, |cause: io::Error| {
            // The path is not known, and the causes are messages.
            file::explain("make", Path::new(self.colors.plural()), &cause)
        });
        let cover = match self.colors {
            MapColors::Palette if shows_biomes => Some(biome_cover::of(world, &heights, sea, &layering)),
            MapColors::Palette => None,
            MapColors::Surfaces => Some(sheet_cover::of(world, &heights, sea, &layering)),
            MapColors::Biomes => Some(biome_cover::of(world, &heights, sea, &layering)),
            MapColors::Classes => Some(biome_cover::of_terrain(world, &heights, sea, &layering)),
        };
        if let Some(cover) = cover {
            options.coloring = Coloring::Surfaces(cover.map_err(made)?);
        }
        let sheet = draw(&heights, &options, &drawing)?;
        if !sheet.left_out.is_empty() {
            let names = map_names::listed(&sheet.left_out);
            warnings
                .push(format!("there is no room for {names}; use a larger --paper, a larger scale, or fewer names"));
        }
        if !sheet.without_river.is_empty() {
            let names = map_names::listed(&sheet.without_river);
            warnings.push(format!("no river is drawn near {names}"));
        }
        let is_missing = |level: &&f64| !sheet.levels.contains(level);
        let missing: Vec<f64> = match &self.levels {
            Some(levels) if options.parts.contours => levels.iter().filter(is_missing).copied().collect(),
            _ => Vec::new(),
        };
        if !missing.is_empty() {
            warnings.push(format!("there is no contour at {} m", numbers(&missing)));
        }
        drawing.finish();
        Ok(DrawnMap {
            format: self.format,
            what: match (self.colors, self.layer.as_str()) {
                (MapColors::Palette, HEIGHT) => String::new(),
                (MapColors::Palette, layer) => format!("{layer}, "),
                (colors, _) => format!("{}, ", colors.plural()),
            },
            title: options.title,
            map: options.map.filter(|_| self.has_sidecars),
            window,
            sheet,
            warnings,
            writing,
            _reserved: reserved,
        })
    }

    /// The names, those of the file last.
    fn all_names(&self, map: Option<&Georeference>) -> Result<NamedPoints> {
        let mut names = self.names.clone();
        if let Some(path) = &self.names_file {
            let read = NamedPoints::read_on(path, map, "the heights", MAX_NAMES)?;
            names.points.extend(read.points);
            names.lines.extend(read.lines);
        }
        Ok(names)
    }

    fn is_covered(&self) -> bool {
        self.colors != MapColors::Palette
    }

    /// Whether the layer is that of the biomes, which have colors and names of their own, unless a palette or a mapping
    /// to colors was chosen.
    pub(super) fn shows_biomes(&self, recipe: &Recipe) -> bool {
        let has_own = self.palette.is_some() || self.range.is_some() || self.scale.is_some();
        !self.is_covered() && !has_own && biome_cover::classes(recipe).is_some_and(|(name, _)| name == self.layer)
    }

    /// The palette: the given one, otherwise that of the layer.
    pub(super) fn palette(&self, recipe: &Recipe) -> Palette {
        if let Some(palette) = &self.palette {
            return palette.clone();
        }
        let derived = list::named(&self.layer).map(|derived| derived.palette).filter(|palette| !palette.is_empty());
        let own = derived.or(named::find(&self.layer).map(|named| named.name)).unwrap_or(LAYER_PALETTE);
        let name = if self.layer == HEIGHT || self.shows_biomes(recipe) { named::DEFAULT } else { own };
        named::find(name).unwrap_or(&named::all()[0]).palette()
    }

    /// The layer that colors the map.
    fn layer(&self, world: &World, window: &Window, warnings: &mut Vec<String>, progress: &Progress) -> Result<Layer> {
        let mut source = LayerSource::new(world, &self.layer, *window, progress)?;
        if source.channels() != 1 {
            let message = format!(
                "`{}` has {} channels, but a map shows a layer with one channel",
                self.layer,
                source.channels()
            );
            return Err(Error::new(ErrorKind::Request, message));
        }
        let scale = self.scale.unwrap_or(scale_of(source.kind()));
        let unit = source.unit();
        let made = source.whole().map_err(|cause| file::explain("make", Path::new(&self.layer), &cause))?;
        let values = made.into_iter().next().unwrap_or_else(|| Grid::filled(*window, f32::NAN));
        finite::check(&self.layer, &values, warnings)?;
        Ok(Layer::new(&self.layer, values).with_unit(unit).with_scale(scale).with_range(self.range))
    }

    fn page(&self) -> Page {
        let at_scale = |scale: f64| self.window.map(|window| 1000.0 * longer_side(&window) / scale);
        let fitted = self.map_scale.and_then(at_scale).unwrap_or(LONGER);
        self.paper.map_or(Page::Fitted(fitted), Page::Paper)
    }

    fn resolution(&self) -> Resolution {
        let is_screen = self.format == SheetFormat::Png && self.paper.is_none();
        self.resolution.unwrap_or(Resolution::Inch(if is_screen { SCREEN } else { PRINT }))
    }

    fn options(&self, world: &World) -> SheetOptions {
        let recipe = world.recipe();
        // Lines and water would hide the other layer.
        let is_height = self.layer == HEIGHT;
        let mut parts = self.parts;
        parts.contours &= is_height || self.interval.is_some() || self.levels.is_some();
        parts.summits &= is_height;
        parts.rivers &= is_height;
        parts.roads &= is_height && world.has_roads();
        // Most depressions of a real place are gorges dammed by coarse samples, and its lakes are level in the data
        // already.
        parts.lakes &= is_height && !self.is_place;
        let is_drained = self.is_place || map_water::is_drained(recipe);
        parts.rivers &= is_drained || self.river_area.is_some();
        parts.lakes &= is_drained || self.lake_area.is_some();
        let about = match recipe.about.as_str() {
            about if self.is_place => about.to_string(),
            "" => format!("Seed {}", recipe.world.seed),
            about => format!("{}; seed {}", about.trim_end_matches('.'), recipe.world.seed),
        };
        let mut options = SheetOptions::new(self.palette(recipe));
        options.title.clone_from(&self.title);
        options.about = about;
        options.shading = self.shading;
        options.interval = self.interval;
        options.levels.clone_from(&self.levels);
        options.labels = self.labels;
        options.page_colors = self.page_colors;
        options.grid = self.grid;
        options.river_area = self.river_area;
        options.lake_area = self.lake_area;
        options.parts = parts;
        options.map_scale = self.map_scale;
        options.page = self.page();
        options.resolution = self.resolution();
        options.range = self.range.filter(|_| is_height);
        // A file of heights has no sea level: all of it is land.
        options.sea_level = (!self.is_place).then_some(recipe.world.sea_level);
        options.map = recipe.georeference();
        options
    }

    /// Memory of drawing beside the heights, in bytes.
    fn memory(&self, window: &Window, shows_biomes: bool) -> u64 {
        let pixels = self.side() * self.side();
        let lines = lines_at(longer(self.page())) as f64;
        // First the water and the contours are computed; then they are held beside the page twice, the picture and its
        // heights.
        let page = f64::max(64.0 * lines * lines, 20.0 * pixels + 16.0 * lines * lines);
        // The heights count in the world's plan; another layer is held beside them, twice while it is computed.
        let layer = if self.layer == HEIGHT { 0.0 } else { 8.0 * window.len() as f64 };
        // The albedo of the surfaces is also held at the resolution of the page.
        let cover = match self.colors {
            MapColors::Palette if shows_biomes => biome_cover::memory(window) as f64 + 12.0 * pixels,
            MapColors::Palette => 0.0,
            MapColors::Surfaces => sheet_cover::memory(window) as f64 + 12.0 * pixels,
            MapColors::Biomes | MapColors::Classes => biome_cover::memory(window) as f64 + 12.0 * pixels,
        };
        (page + layer + cover) as u64
    }
}

/// How values of a layer are mapped to colors.
pub(super) fn scale_of(kind: LayerKind) -> Scale {
    match kind {
        LayerKind::Flow => Scale::Log,
        LayerKind::Label => Scale::Labels,
        _ => Scale::Linear,
    }
}

/// The longer side of a map of a window, in metres, between the first and the last samples.
fn longer_side(window: &Window) -> f64 {
    (window.width.max(window.height) - 1) as f64 * window.cell
}

/// Approximate longer side of a page, in millimetres.
fn longer(page: Page) -> f64 {
    match page {
        Page::Fitted(longer) => longer + 36.0,
        Page::Paper([width, height]) => width.max(height),
    }
}
