//! A map sheet.

use std::path::Path;

use orogen::export::contour_options;
use orogen::export::derived::list as derived;
use orogen::jobs::map::{MapColors, MapJob};
use orogen::jobs::sheet_format::SheetFormat;
use orogen::palette::color::hex;
use orogen::palette::named;
use orogen::palette::palette::Palette;
use orogen::recipe::document::Recipe;
use orogen::sheet::options::{GridStep, Labels, PageColors, Parts, Resolution, Scale, Shading};
use orogen::sheet::paper::Paper;
use orogen::world::HEIGHT;
use orogen::{Error, ErrorKind, Result, WorldSpec};

use super::command_line::CommandLine;
use super::samples::Samples;
use super::work::{Work, lines};
use crate::preview::region::Region;

/// A part of a sheet: the option that leaves it out, the key of its name, and its place in [`Parts`].
pub type Part = (&'static str, &'static str, fn(&mut Parts) -> &mut bool);

/// The parts of a sheet.
pub const PARTS: [Part; 12] = [
    ("no-title", "export.part_title", |parts| &mut parts.title),
    ("no-contours", "export.part_contours", |parts| &mut parts.contours),
    ("no-labels", "export.part_labels", |parts| &mut parts.labels),
    ("no-rivers", "export.part_rivers", |parts| &mut parts.rivers),
    ("no-lakes", "export.part_lakes", |parts| &mut parts.lakes),
    ("no-summits", "export.part_summits", |parts| &mut parts.summits),
    ("no-axes", "export.part_axes", |parts| &mut parts.axes),
    ("no-color", "export.part_colors", |parts| &mut parts.colors),
    ("no-legend", "export.part_legend", |parts| &mut parts.legend),
    ("no-scale", "export.part_scale", |parts| &mut parts.scale),
    ("no-north", "export.part_north", |parts| &mut parts.north),
    ("no-profile", "export.part_profile", |parts| &mut parts.profile),
];

/// What the colors show: its name on the command line, and the key of its name.
pub const COLORS: [(MapColors, &str, &str); 4] = [
    (MapColors::Palette, "palette", "export.color_palette"),
    (MapColors::Surfaces, "surfaces", "export.color_surfaces"),
    (MapColors::Biomes, "biomes", "export.color_biomes"),
    (MapColors::Classes, "classes", "export.color_classes"),
];

/// Relief shading, likewise.
pub const SHADINGS: [(Shading, &str, &str); 4] = [
    (Shading::Multi, "multi", "export.shade_multi"),
    (Shading::Single, "single", "export.shade_single"),
    (Shading::Swiss, "swiss", "export.shade_swiss"),
    (Shading::None, "none", "export.shade_none"),
];

/// How values are mapped to colors, likewise.
pub const SCALES: [(Scale, &str, &str); 3] = [
    (Scale::Linear, "linear", "export.scale_linear"),
    (Scale::Log, "log", "export.scale_log"),
    (Scale::Labels, "labels", "export.scale_labels"),
];

/// The contours that have labels, likewise.
pub const LABELS: [(Labels, &str, &str); 2] =
    [(Labels::Index, "index", "export.labels_index"), (Labels::All, "all", "export.labels_all")];

/// Pixels per inch that a sheet may have.
pub const DPI: std::ops::RangeInclusive<u16> = 20..=1200;

/// Pixels along the longer side of a page.
pub const SIDE: std::ops::RangeInclusive<u32> = 100..=30_000;

/// The choices of a map sheet.
#[derive(Debug, Clone)]
pub struct MapExport {
    /// The kind of file.
    pub format: SheetFormat,
    /// Samples along the longer side; `None` for the world's own cell.
    pub samples: Option<usize>,
    /// What the colors show.
    pub colors: MapColors,
    /// The layer that the palette colors.
    pub layer: String,
    /// The palette by name; that of the layer if `None`.
    pub palette: Option<&'static str>,
    /// Whether the palette's colors are not mixed.
    pub nearest_color: bool,
    /// How values of another layer than the heights are mapped to colors.
    pub scale: Option<Scale>,
    /// The values at the ends of the palette.
    pub range: Option<[f32; 2]>,
    /// The relief shading.
    pub shading: Shading,
    /// The interval of contours in metres; a round number if `None`.
    pub interval: Option<f64>,
    /// The heights of contours in metres, separated by commas, in place of an interval; none if it is empty.
    pub levels: String,
    /// The contours that have labels; index contours, or all of given heights, if `None`.
    pub labels: Option<Labels>,
    /// Whether there is a coordinate grid.
    pub has_grid: bool,
    /// The distance between its lines, in metres or degrees; one that suits the scale if `None`.
    pub grid_step: Option<f64>,
    /// The colors of the page and of its lines.
    pub page_colors: PageColors,
    /// The minimum drainage area of rivers in m^2; one that suits the scale if `None`.
    pub river_area: Option<f64>,
    /// The minimum area of lakes in m^2, likewise.
    pub lake_area: Option<f64>,
    /// A file of points with names; none if it is empty.
    pub names: String,
    /// The denominator of the scale, which sets the size of the page; only a page without paper has one.
    pub map_scale: Option<f64>,
    /// The heading.
    pub title: String,
    /// The heading that a command line gives by itself.
    pub own_title: String,
    /// The paper, by its name.
    pub paper: Option<&'static str>,
    /// Whether the paper is wider than high.
    pub is_landscape: bool,
    /// The resolution; one that suits the kind of file if `None`.
    pub resolution: Option<Resolution>,
    /// The parts.
    pub parts: Parts,
    /// Whether the world is a file of heights.
    pub is_place: bool,
}

impl MapExport {
    /// A picture of the heights.
    #[must_use]
    pub fn new(title: &str, is_place: bool) -> MapExport {
        MapExport {
            format: SheetFormat::Png,
            samples: None,
            colors: MapColors::Palette,
            layer: HEIGHT.into(),
            palette: None,
            nearest_color: false,
            scale: None,
            range: None,
            shading: Shading::Multi,
            interval: None,
            levels: String::new(),
            labels: None,
            has_grid: false,
            grid_step: None,
            page_colors: PageColors::default(),
            river_area: None,
            lake_area: None,
            names: String::new(),
            map_scale: None,
            title: title.into(),
            own_title: title.into(),
            paper: None,
            is_landscape: false,
            resolution: None,
            parts: Parts::default(),
            is_place,
        }
    }

    /// Other colors; only a palette has a layer and a range of its own.
    pub fn set_colors(&mut self, colors: MapColors) {
        self.colors = colors;
        if colors != MapColors::Palette {
            (self.palette, self.range, self.nearest_color) = (None, None, false);
            self.set_layer(HEIGHT);
        }
    }

    /// Another layer; only other layers than the heights have a scale.
    pub fn set_layer(&mut self, layer: &str) {
        self.layer = layer.to_owned();
        self.scale = self.scale.filter(|_| layer != HEIGHT);
    }

    /// The layers of a recipe that a map can show: those of one channel.
    #[must_use]
    pub fn layers(recipe: &Recipe) -> Vec<String> {
        let mut names: Vec<String> = recipe.outputs().map(str::to_owned).collect();
        for layer in derived::all().iter().filter(|layer| !layer.palette.is_empty()) {
            if !names.iter().any(|name| name == layer.name) {
                names.push(layer.name.to_owned());
            }
        }
        names
    }

    /// The scale; paper has a size of its own.
    fn map_scale(&self) -> Option<f64> {
        self.map_scale.filter(|_| self.paper.is_none())
    }

    /// The contours that have labels; those at given heights are all alike.
    fn labels(&self) -> Option<Labels> {
        self.labels.filter(|labels| self.parts.labels && (self.levels.is_empty() || *labels == Labels::All))
    }

    fn job(&self) -> Result<MapJob> {
        let mut job = MapJob::new(self.format).with_colors(self.colors).with_layer(&self.layer);
        job = job.with_title(&self.title);
        job.palette = palette(self.palette, self.nearest_color);
        job.scale = self.scale;
        if self.range.is_some_and(|[low, high]| low >= high) {
            let message = "the lower end of the range of colors must be below the upper one";
            return Err(Error::new(ErrorKind::Request, message));
        }
        job.range = self.range;
        job.shading = self.shading;
        match self.levels.as_str() {
            "" => job.interval = self.interval,
            levels => job.levels = Some(contour_options::parse(levels)?),
        }
        job.labels = self.labels();
        job.grid = self.has_grid.then(|| self.grid_step.map_or(GridStep::Automatic, GridStep::Every));
        job.page_colors = self.page_colors;
        job.river_area = self.river_area;
        job.lake_area = self.lake_area;
        job.map_scale = self.map_scale();
        job.paper = self
            .paper
            .map(|name| name.parse::<Paper>().map_err(|message| Error::new(ErrorKind::Request, message)))
            .transpose()?
            .map(|paper| paper.sides(self.is_landscape));
        job.resolution = self.resolution;
        job.parts = self.parts;
        job.is_place = self.is_place;
        job.check()?;
        Ok(job)
    }

    /// Adds the options of `orogen map`.
    pub fn words(&self, path: &Path, region: Region, world: &WorldSpec, line: &mut CommandLine) {
        if SheetFormat::of_path(path) != Some(self.format) {
            line.option("format", self.format.name());
        }
        if let Some((_, name, _)) = COLORS.iter().find(|(colors, ..)| *colors == self.colors) {
            line.differing("color", *name, &"palette");
        }
        line.differing("layer", self.layer.as_str(), &HEIGHT);
        if let Some(palette) = self.palette {
            line.option("palette", palette);
            if self.nearest_color {
                line.flag("nearest-color");
            }
        }
        if let Some((_, name, _)) = SCALES.iter().find(|(scale, ..)| Some(*scale) == self.scale) {
            line.option("ramp", name);
        }
        if let Some([low, high]) = self.range {
            line.option("range", format!("{low},{high}"));
        }
        if let Some((_, name, _)) = SHADINGS.iter().find(|(shading, ..)| *shading == self.shading) {
            line.differing("shade", *name, &"multi");
        }
        match (self.levels.as_str(), self.interval) {
            ("", None) => {}
            ("", Some(interval)) => line.option("contours", interval),
            (levels, _) => line.option("levels", levels),
        }
        if let Some((_, name, _)) = LABELS.iter().find(|(labels, ..)| Some(*labels) == self.labels()) {
            line.option("labels", name);
        }
        match (self.has_grid, self.grid_step) {
            (false, _) => {}
            (true, None) => line.flag("grid"),
            (true, Some(step)) => line.option("grid", step),
        }
        let (own, colors) = (PageColors::default(), &self.page_colors);
        line.differing("page-color", hex(colors.page), &hex(own.page));
        line.differing("ink-color", hex(colors.ink), &hex(own.ink));
        for (option, color) in [("water-color", colors.water), ("contour-color", colors.contours)] {
            if let Some(color) = color {
                line.option(option, hex(color));
            }
        }
        for (option, area) in [("river-area", self.river_area), ("lake-area", self.lake_area)] {
            if let Some(area) = area {
                line.option(option, area);
            }
        }
        if !self.names.is_empty() {
            line.option("names", &self.names);
        }
        if let Some(scale) = self.map_scale() {
            line.option("scale", scale);
        }
        line.differing("title", self.title.as_str(), &self.own_title.as_str());
        if let Some(paper) = self.paper {
            line.option("paper", paper);
            if self.is_landscape {
                line.flag("landscape");
            }
        }
        match self.resolution {
            Some(Resolution::Inch(dpi)) => line.option("dpi", dpi),
            Some(Resolution::Longer(pixels)) => line.option("size", pixels),
            None => {}
        }
        let mut parts = self.parts;
        for (flag, _, part) in PARTS {
            if !*part(&mut parts) {
                line.flag(flag);
            }
        }
        Samples::of(region, self.samples, world).unsized_for(world, line);
    }

    /// Makes the file. Returns a description.
    ///
    /// # Errors
    /// If options are not valid, or the export fails; then there is no file, or that which was there.
    pub fn make(&self, mut work: Work, region: Region) -> Result<String> {
        let mut job = self.job()?;
        if !self.names.is_empty() {
            job = job.with_names_from(Path::new(&self.names), &work.recipe)?;
        }
        job.prepare(&mut work.recipe)?;
        let world = work.open()?;
        let window = Samples::of(region, self.samples, &work.recipe.world).window(&world)?;
        let drawn = job.with_window(window).to_file(&world, &work.output()?, work.progress)?;
        let lacking: String = drawn.lacking().iter().collect();
        let letters = (!lacking.is_empty()).then(|| format!("no installed font has the letters {lacking}"));
        Ok(lines(&drawn.words(), drawn.warnings().iter().cloned().chain(letters)))
    }
}

/// A palette by name, with its colors not mixed if `is_nearest`.
pub fn palette(name: Option<&str>, is_nearest: bool) -> Option<Palette> {
    let palette = name.and_then(named::find)?.palette();
    Some(if is_nearest { palette.nearest() } else { palette })
}
