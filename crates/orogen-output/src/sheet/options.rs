//! Options of a sheet.

use super::roads::MapRoad;
use super::scene::{INK, WHITE};
use super::water::KnownWater;
use orogen_grid::grid::Grid;
use orogen_io::format::dem::Georeference;
use orogen_io::palette::color::Rgb;
use orogen_io::palette::palette::Palette;

/// Relief shading.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Shading {
    /// No shading.
    None,
    /// One light from the north-west.
    Single,
    /// Three lights, which also show ridges parallel to the first.
    #[default]
    Multi,
    /// In the style of Swiss maps: three lights, soft and hazy lowlands, crisp and warm summits (after E. Imhof,
    /// "Kartographische Geländedarstellung", 1965).
    Swiss,
}

/// The size of a page.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Page {
    /// Fitted to a map with a longer side of this many millimetres.
    Fitted(f64),
    /// Width and height in millimetres.
    Paper([f64; 2]),
}

/// The resolution of a page.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Resolution {
    /// Pixels per inch.
    Inch(f64),
    /// Pixels along the page's longer side.
    Longer(u32),
}

/// The parts of a sheet; each can be switched off. All are on by default.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub struct Parts {
    /// The heading, and the lines under it.
    pub title: bool,
    /// Coordinates along the sides.
    pub axes: bool,
    /// Contours.
    pub contours: bool,
    /// Labels along contours.
    pub labels: bool,
    /// The highest summits with their heights.
    pub summits: bool,
    /// Rivers.
    pub rivers: bool,
    /// Lakes.
    pub lakes: bool,
    /// Roads.
    pub roads: bool,
    /// The legend.
    pub legend: bool,
    /// The color bar.
    pub colors: bool,
    /// The scale bar.
    pub scale: bool,
    /// The north arrow.
    pub north: bool,
    /// Profiles through the highest sample, if the paper has room for them.
    pub profile: bool,
}

impl Default for Parts {
    /// All parts.
    fn default() -> Parts {
        Parts {
            title: true,
            axes: true,
            contours: true,
            labels: true,
            summits: true,
            rivers: true,
            lakes: true,
            roads: true,
            legend: true,
            colors: true,
            scale: true,
            north: true,
            profile: true,
        }
    }
}

/// The contours that have labels.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Labels {
    /// Index contours.
    Index,
    /// All contours with room for a label.
    All,
}

/// The colors of a page, and of the lines on its map.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub struct PageColors {
    /// Color of the page; white by default.
    pub page: Rgb,
    /// Color of texts, frames and symbols; almost black by default.
    pub ink: Rgb,
    /// Color of rivers, shores, lakes and contours under water; shades of blue by default. The sea has the colors of
    /// the palette.
    pub water: Option<Rgb>,
    /// Color of contours on land, whatever the ground; by default brown, and bright on dark ground.
    pub contours: Option<Rgb>,
}

impl Default for PageColors {
    fn default() -> PageColors {
        PageColors { page: WHITE, ink: INK, water: None, contours: None }
    }
}

/// The distance between the lines of a coordinate grid.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum GridStep {
    /// A round distance that suits the scale.
    Automatic,
    /// A distance in the unit of the coordinates: metres or degrees.
    Every(f64),
}

/// The mapping from values of a layer to colors.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Scale {
    /// Linear.
    Linear,
    /// Logarithmic, for values over orders of magnitude.
    Log,
    /// A separate color for each number.
    Labels,
}

/// A layer that colors the sheet in place of the heights.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct Layer {
    /// Its values, over the window of the heights.
    pub values: Grid,
    /// The name.
    pub name: String,
    /// The unit, or empty.
    pub unit: &'static str,
    /// The mapping from values to colors.
    pub scale: Scale,
    /// The values at the ends of the palette; by default the minimum and maximum.
    pub range: Option<[f32; 2]>,
}

impl Layer {
    /// A layer on a linear scale between its minimum and maximum, without a unit.
    #[must_use]
    pub fn new(name: impl Into<String>, values: Grid) -> Layer {
        Layer { values, name: name.into(), unit: "", scale: Scale::Linear, range: None }
    }

    /// Sets the unit.
    #[must_use]
    pub fn with_unit(self, unit: &'static str) -> Layer {
        Layer { unit, ..self }
    }

    /// Sets the scale.
    #[must_use]
    pub fn with_scale(self, scale: Scale) -> Layer {
        Layer { scale, ..self }
    }

    /// Sets the values at the ends of the palette; `None` uses the minimum and maximum.
    #[must_use]
    pub fn with_range(self, range: Option<[f32; 2]>) -> Layer {
        Layer { range, ..self }
    }
}

/// The kind of a named place.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum PlaceKind {
    /// A place, marked by a dot.
    #[default]
    Place,
    /// A summit, marked by a triangle and labeled with its height.
    Summit,
    /// A point near a drawn river; the name follows the river.
    River,
    /// A lake or a sea.
    Water,
}

/// A place with a name.
#[derive(Debug, Clone, PartialEq)]
pub struct PlaceName {
    /// The name.
    pub name: String,
    /// The kind of place.
    pub kind: PlaceKind,
    /// The height of a summit in metres; by default taken from the heights.
    pub height: Option<f64>,
    /// The position as shares of the ground's width and height, from its north-west corner.
    pub at: [f64; 2],
}

/// A name along a line.
#[derive(Debug, Clone, PartialEq)]
pub struct LineName {
    /// The name.
    pub name: String,
    /// Whether it is a river or other water.
    pub is_water: bool,
    /// Positions as shares of the ground's width and height, from its north-west corner.
    pub points: Vec<[f64; 2]>,
}

/// A surface in the legend of a sheet.
#[derive(Debug, Clone, PartialEq)]
pub struct SurfaceEntry {
    /// The name.
    pub name: String,
    /// Its colors, sRGB: one, or several along a gradient.
    pub colors: Vec<Rgb>,
    /// The share of the land that it covers, 0 to 1.
    pub share: f64,
}

/// The recipe's surfaces, whose albedo colors the sheet in place of the heights.
#[derive(Debug, Clone)]
pub struct SurfaceCover {
    /// Red, green and blue in linear light, over the window of the heights.
    pub albedo: [Grid; 3],
    /// The surfaces in the legend.
    pub entries: Vec<SurfaceEntry>,
}

/// What the colors of a sheet represent.
#[derive(Debug, Clone, Default)]
pub enum Coloring {
    /// The heights.
    #[default]
    Heights,
    /// Another layer.
    Layer(Layer),
    /// The surfaces.
    Surfaces(SurfaceCover),
}

/// Options of a sheet.
///
/// ```
/// use orogen_output::sheet::options::{Page, SheetOptions};
///
/// let palette = orogen_io::palette::named::all()[0].palette();
/// let mut options = SheetOptions::new(palette).with_title("Hills").with_page(Page::Paper([210.0, 297.0]));
/// options.parts.legend = false;
/// ```
#[derive(Debug, Clone)]
#[non_exhaustive]
#[must_use]
pub struct SheetOptions {
    /// The heading; empty by default.
    pub title: String,
    /// The line under the heading, before the facts of the sheet; empty by default.
    pub about: String,
    /// The palette.
    pub palette: Palette,
    /// The relief shading; three lights by default.
    pub shading: Shading,
    /// Contour interval in metres; by default chosen by relief and scale.
    pub interval: Option<f64>,
    /// The heights of contours in metres, which replace an interval.
    pub levels: Option<Vec<f64>>,
    /// The contours that have labels: by default index contours, or all if their heights are given.
    pub labels: Option<Labels>,
    /// The colors of the page and of its lines.
    pub page_colors: PageColors,
    /// The coordinate grid; none by default.
    pub grid: Option<GridStep>,
    /// The parts that are drawn; all by default.
    pub parts: Parts,
    /// The page; by default fitted to a map with a longer side of 240 mm.
    pub page: Page,
    /// The resolution of the relief picture, and of the page if it is written as pixels; 150 pixels per inch by
    /// default.
    pub resolution: Resolution,
    /// Sea level in metres; without it, the default, everything is land.
    pub sea_level: Option<f64>,
    /// What the colors represent: the heights by default. The heights shade the relief in any case.
    pub coloring: Coloring,
    /// The heights at the ends of the palette, which make several sheets comparable; by default the minimum and maximum
    /// of this sheet.
    pub range: Option<[f32; 2]>,
    /// Minimum drainage area of rivers that are found in the heights, in m^2; by default it depends on the scale.
    pub river_area: Option<f64>,
    /// Minimum area of lakes that are found in the heights, in m^2; by default it depends on the scale.
    pub lake_area: Option<f64>,
    /// Rivers and lakes, if they are known; by default they are found in the heights.
    pub water: Option<KnownWater>,
    /// Roads; none by default.
    pub roads: Vec<MapRoad>,
    /// Names of places, the most important first. Names without room are omitted.
    pub names: Vec<PlaceName>,
    /// Names along lines, the most important first. Names without room are omitted.
    pub line_names: Vec<LineName>,
    /// The denominator of the scale, if the page was chosen for one.
    pub map_scale: Option<f64>,
    /// The position of the ground on a map of the Earth, if it has one.
    pub map: Option<Georeference>,
}

impl SheetOptions {
    /// A sheet with all parts and this palette, without a title.
    pub fn new(palette: Palette) -> SheetOptions {
        SheetOptions {
            title: String::new(),
            about: String::new(),
            palette,
            shading: Shading::default(),
            interval: None,
            levels: None,
            labels: None,
            page_colors: PageColors::default(),
            grid: None,
            parts: Parts::default(),
            page: Page::Fitted(240.0),
            resolution: Resolution::Inch(150.0),
            sea_level: None,
            coloring: Coloring::default(),
            range: None,
            river_area: None,
            lake_area: None,
            water: None,
            roads: Vec::new(),
            names: Vec::new(),
            line_names: Vec::new(),
            map_scale: None,
            map: None,
        }
    }

    /// Sets the heading.
    pub fn with_title(self, title: impl Into<String>) -> SheetOptions {
        SheetOptions { title: title.into(), ..self }
    }

    /// Sets the page.
    pub fn with_page(self, page: Page) -> SheetOptions {
        SheetOptions { page, ..self }
    }

    /// Sets the resolution.
    pub fn with_resolution(self, resolution: Resolution) -> SheetOptions {
        SheetOptions { resolution, ..self }
    }

    /// Sets the sea level, in metres.
    pub fn with_sea_level(self, sea_level: f64) -> SheetOptions {
        SheetOptions { sea_level: Some(sea_level), ..self }
    }
}
