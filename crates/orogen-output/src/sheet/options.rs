//! What a sheet is to show.

use orogen_grid::grid::Grid;
use orogen_io::format::dem::Georeference;
use orogen_io::palette::color::Rgb;
use orogen_io::palette::palette::Palette;

/// How relief is shaded.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Shading {
    /// Not at all.
    None,
    /// By one light from the north-west.
    Single,
    /// By three lights, which show ridges that run along the first.
    #[default]
    Multi,
    /// As on Swiss maps: three lights, lowlands soft and in haze, summits crisp and warm in the light (after E. Imhof,
    /// "Kartographische Geländedarstellung", 1965).
    Swiss,
}

/// How large a page is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Page {
    /// As large as a map with a longer side of so many millimetres needs.
    Fitted(f64),
    /// Width and height in millimetres.
    Paper([f64; 2]),
}

/// How many pixels a page has.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Resolution {
    /// So many an inch.
    Inch(f64),
    /// So many along the page's longer side.
    Longer(u32),
}

/// The parts of a sheet.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Parts {
    /// The heading, and what is said of the map beneath it.
    pub title: bool,
    /// Numbers along the sides.
    pub axes: bool,
    /// Lines of one height.
    pub contours: bool,
    /// Heights along index contours.
    pub labels: bool,
    /// The highest summits, with their heights.
    pub summits: bool,
    /// Rivers.
    pub rivers: bool,
    /// Lakes.
    pub lakes: bool,
    /// What the lines mean.
    pub legend: bool,
    /// What the colours mean.
    pub colors: bool,
    /// How long a kilometre is.
    pub scale: bool,
    /// Where north is.
    pub north: bool,
    /// The land cut from west to east through its highest place, where paper has room left for it.
    pub profile: bool,
}

impl Default for Parts {
    /// All of them.
    fn default() -> Parts {
        Parts {
            title: true,
            axes: true,
            contours: true,
            labels: true,
            summits: true,
            rivers: true,
            lakes: true,
            legend: true,
            colors: true,
            scale: true,
            north: true,
            profile: true,
        }
    }
}

/// How the values of a layer become colours.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Scale {
    /// Evenly.
    Linear,
    /// By their logarithms: for amounts over orders of magnitude.
    Log,
    /// Each number a colour of its own.
    Labels,
}

/// A layer whose values colour the sheet in place of the heights.
#[derive(Debug, Clone)]
pub struct Layer {
    /// Its values, over the very window of the heights.
    pub values: Grid,
    /// What it is called.
    pub name: String,
    /// What it is measured in, or empty.
    pub unit: &'static str,
    /// How values become colours.
    pub scale: Scale,
    /// The values at the ends of the palette; without, the lowest and the highest.
    pub range: Option<[f32; 2]>,
}

/// A surface as it appears on a sheet.
#[derive(Debug, Clone, PartialEq)]
pub struct SurfaceEntry {
    /// What it is called.
    pub name: String,
    /// Its colors, sRGB: one, or several along a gradient.
    pub colors: Vec<Rgb>,
    /// The share of the land that it covers, 0 to 1.
    pub share: f64,
}

/// The recipe's surfaces, whose albedo colors the sheet in place of the heights.
#[derive(Debug, Clone)]
pub struct SurfaceCover {
    /// Red, green and blue as linear light, over the very window of the heights.
    pub albedo: [Grid; 3],
    /// The surfaces in the legend.
    pub entries: Vec<SurfaceEntry>,
}

/// What the colors of a sheet show.
#[derive(Debug, Clone, Default)]
pub enum Coloring {
    /// The heights.
    #[default]
    Heights,
    /// Another layer.
    Layer(Layer),
    /// What covers the ground.
    Surfaces(SurfaceCover),
}

/// What a sheet is to show, and how.
#[derive(Debug, Clone)]
pub struct Options {
    /// The heading.
    pub title: String,
    /// What is said of the map beneath it, before what the sheet says itself.
    pub about: String,
    /// Its colours.
    pub palette: Palette,
    /// How relief is shaded.
    pub shading: Shading,
    /// Metres from one contour to the next; without, what suits the ground and the scale.
    pub interval: Option<f64>,
    /// What of it is drawn.
    pub parts: Parts,
    /// The page.
    pub page: Page,
    /// How fine the picture is that the lines lie on, and the page where it is made of pixels.
    pub resolution: Resolution,
    /// The sea's surface in metres; without, all is land.
    pub sea_level: Option<f64>,
    /// What its colors show. The heights shade it in any case.
    pub coloring: Coloring,
    /// The heights at the ends of the palette, the same for several sheets; without, the lowest and the highest of this one.
    pub range: Option<[f32; 2]>,
    /// How the ground lies on a map of the Earth, if it does.
    pub map: Option<Georeference>,
}
