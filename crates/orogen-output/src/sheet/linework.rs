//! Lines of a map: contours, rivers, lakes, shores and summits, found in the heights at the scale of the map, unless
//! the water is known.

use super::furniture::{Entry, Sign};
use super::ground::laid;
use super::inks::{GIVEN, THICK, THIN};
use super::lines::{self, Summit, interval, is_thick, lines, summits, thick_interval};
use super::options::{Page, PlaceKind, SheetOptions};
use super::roads;
use super::ticks::grouped;
use super::water::{Least, Water, find};
use orogen_grid::contour::chaikin::chaikin;
use orogen_grid::contour::levels::given;
use orogen_grid::contour::line::Line;
use orogen_grid::contour::trace;
use orogen_grid::error::Result;
use orogen_grid::grid::{Grid, Window};
use orogen_io::format::levels::Levels;

/// Width of a sample for finding lines, in millimetres, and the maximum number of samples along a side.
const SAMPLE: f64 = 0.25;
const MOST: usize = 2400;

/// Minimum drainage area at the start of a river in m^2: gullies at a large scale are not rivers.
const SMALLEST: f64 = 1e5;

/// Thresholds: drainage area at the start of a river and minimum area of a lake, in square millimetres of the map;
/// minimum depth of a lake, as a share of the relief.
const SPRING: f64 = 42.0;
const LAKE: f64 = 2.0;
const DEPTH: f64 = 0.006;

/// Ratio of cells below which heights count as enlarged: smooth between the original samples.
const ENLARGED: f64 = 0.6;

/// Minimum distance between summits in millimetres, and maximum number of summits.
const APART: f64 = 26.0;
const SUMMITS: usize = 24;

/// Number of samples along the longer side of a map of this many millimetres, for finding lines.
#[must_use]
pub fn lines_at(longer: f64) -> usize {
    ((longer / SAMPLE).ceil() as usize).clamp(8, MOST)
}

/// Approximate length of the longer side of a map in millimetres; the exact length depends on its legend.
pub(super) fn longer_side(window: &Window, page: Page) -> f64 {
    let [width, height] = [window.width, window.height].map(|samples| samples.saturating_sub(1).max(1) as f64);
    let aspect = width / height;
    match page {
        Page::Fitted(longer) => longer,
        Page::Paper([width, height]) => {
            let (width, height) = ((width - 36.0).max(10.0), (height - 60.0).max(10.0));
            if width / height > aspect { height * aspect.max(1.0) } else { width / aspect.min(1.0) }
        }
    }
}

/// Minimum drainage area of rivers and minimum area of lakes on a map of this window, in m^2.
#[must_use]
pub fn least_areas(window: &Window, page: Page) -> [f64; 2] {
    let longer = window.width.max(window.height).saturating_sub(1).max(1) as f64 * window.cell;
    let metres = longer / longer_side(window, page);
    [(SPRING * metres * metres).max(SMALLEST), LAKE * metres * metres]
}

/// The heights at the resolution of lines, and the lines.
pub struct Linework {
    /// The heights.
    pub grid: Grid,
    /// Ratio of width to height.
    pub aspect: f64,
    /// Rivers and lakes.
    pub water: Water,
    /// Contours.
    pub contours: Vec<Line>,
    /// Distance between contours in metres, if there are contours at an interval.
    pub interval: Option<f64>,
    /// The coast.
    pub shore: Vec<Line>,
    /// Summits, in samples of the original heights.
    pub summits: Vec<Summit>,
    /// Columns and rows of the original heights.
    pub samples: [usize; 2],
}

impl Linework {
    /// Finds the lines of heights.
    ///
    /// # Errors
    /// If there would be too many contours or shores.
    pub fn of(heights: &Grid, options: &SheetOptions) -> Result<Linework> {
        let window = heights.window();
        let sides = [window.width - 1, window.height - 1].map(|side| side as f64);
        let aspect = sides[0] / sides[1];
        let longer = longer_side(window, options.page);
        let samples = lines_at(longer);
        let size = sides.map(|side| ((samples as f64 * side / sides[0].max(sides[1])).round() as usize).max(1) + 1);
        let sample = longer / samples as f64;
        let grid = laid(heights, size);
        let levels = Levels::of(&grid);
        let relief = f64::from(levels.high()) - f64::from(levels.low());
        let parts = &options.parts;
        let sea = options.sea_level.map(|sea| sea as f32);
        let wanted = (parts.rivers || parts.lakes) && relief > 0.0;
        let water = match &options.water {
            Some(known) if wanted => known.on(&grid),
            None if wanted => {
                let [river, lake] = least_areas(window, options.page);
                let [river, lake] = [options.river_area.unwrap_or(river), options.lake_area.unwrap_or(lake)];
                let cell_area = grid.window().cell * grid.window().cell;
                let cells = |area: f64| (area / cell_area).ceil().max(1.0) as u32;
                // Rivers continue through lakes that are not drawn.
                let lake = if parts.lakes { cells(lake) } else { u32::MAX };
                let scattered = grid.window().cell < ENLARGED * window.cell;
                let depth = (relief * DEPTH) as f32;
                find(&grid, sea, Least::new(cells(river), lake).with_depth(depth).with_scattered(scattered))?
            }
            _ => Water { rivers: Vec::new(), lakes: Vec::new(), surface: grid.clone() },
        };
        let levels = options.levels.as_ref().filter(|_| parts.contours);
        let interval = (parts.contours && levels.is_none())
            .then(|| options.interval.unwrap_or_else(|| interval(&grid, options.sea_level, sample)));
        // Contours end at lakes that are drawn, and continue under lakes that are not.
        let ground = Grid::from_data(*grid.window(), water.surface.data().to_vec()).filter(|_| parts.lakes);
        let ground = ground.as_ref().unwrap_or(&grid);
        let contours = match (interval, levels) {
            (_, Some(levels)) => lines::lines_at(ground, &given(levels)?, sample)?,
            (Some(interval), _) if relief > 0.0 => lines(ground, interval, options.sea_level, sample)?,
            _ => Vec::new(),
        };
        let shore = match (options.sea_level, options.palette.has_sea()) {
            (Some(sea), true) => trace::contours(&grid, &[sea])?.iter().map(|line| chaikin(line, 1)).collect(),
            _ => Vec::new(),
        };
        let summits = match options.parts.summits {
            // Summits are found in the original heights, because resampling moves them.
            true => {
                let block = (window.width - 1).div_ceil((size[0] - 1).max(1));
                let block_width = sample * block as f64 * (size[0] - 1) as f64 / sides[0];
                let apart = (APART / block_width).ceil() as usize;
                summits(heights, options.sea_level, block, apart, SUMMITS)
            }
            false => Vec::new(),
        };
        let interval = interval.filter(|_| relief > 0.0);
        let samples = [window.width, window.height];
        Ok(Linework { grid, aspect, water, contours, interval, shore, summits, samples })
    }

    /// Whether a line is an index contour.
    pub(super) fn is_index(&self, line: &Line) -> bool {
        self.interval.is_some_and(|interval| is_thick(line, interval))
    }

    /// The width of a contour in millimetres.
    pub(super) fn contour_width(&self, line: &Line) -> f32 {
        match self.interval {
            Some(_) if self.is_index(line) => THICK,
            Some(_) => THIN,
            None => GIVEN,
        }
    }

    /// The heights of the contours, ascending.
    pub(super) fn levels(&self) -> Vec<f64> {
        let mut levels: Vec<f64> = self.contours.iter().map(|line| line.elevation).collect();
        levels.sort_by(f64::total_cmp);
        levels.dedup();
        levels
    }

    /// The legend entries of the lines.
    #[must_use]
    pub fn legend(&self, options: &SheetOptions) -> Vec<Entry> {
        let mut entries = Vec::new();
        let sea = options.sea_level.unwrap_or(f64::NEG_INFINITY);
        let colors = &options.page_colors;
        let ink = colors.of_contours(self.contours.iter().any(|line| line.elevation > sea));
        let entry = |width, text| Entry { sign: Sign::Line(width, ink), text };
        if self.interval.is_none() && !self.contours.is_empty() {
            entries.push(entry(GIVEN, listed(&self.levels())));
        }
        if let Some(interval) = self.interval.filter(|_| !self.contours.is_empty()) {
            let metres = |value: f64| format!("{} m", height(value));
            entries.push(entry(THIN, format!("Contours, {} apart", metres(interval))));
            entries.push(entry(THICK, format!("Index contours, {} apart", metres(thick_interval(interval)))));
        }
        if options.parts.rivers && !self.water.rivers.is_empty() {
            entries.push(Entry { sign: Sign::Line(0.45, colors.rivers()), text: "River".into() });
        }
        if options.parts.lakes && !self.water.lakes.is_empty() {
            entries.push(Entry { sign: Sign::Water(colors.lakes(), colors.shores()), text: "Lake".into() });
        }
        if options.parts.roads {
            let kinds = roads::kinds(&options.roads);
            entries.extend(kinds.map(|(kind, text)| Entry { sign: Sign::Road(kind), text: text.into() }));
        }
        let is_named = |kind: PlaceKind| options.names.iter().any(|place| place.kind == kind);
        if is_named(PlaceKind::Place) {
            entries.push(Entry { sign: Sign::Place, text: "Place".into() });
        }
        if !self.summits.is_empty() || is_named(PlaceKind::Summit) {
            entries.push(Entry { sign: Sign::Summit, text: "Summit, height in m".into() });
        }
        entries
    }
}

/// A height as written in labels, without its unit.
pub(super) fn height(value: f64) -> String {
    grouped(value, if value.fract() == 0.0 { 0 } else { 1 })
}

/// Maximum number of heights in the legend.
const LISTED: usize = 4;

/// The legend of contours at these heights.
fn listed(levels: &[f64]) -> String {
    let heights: Vec<String> = levels.iter().map(|level| height(*level)).collect();
    match heights.as_slice() {
        [one] => format!("Contour at {one} m"),
        [start @ .., last] if heights.len() <= LISTED => format!("Contours at {} and {last} m", start.join(", ")),
        [low, .., high] => format!("Contours at {} heights, {low} to {high} m", heights.len()),
        [] => String::new(),
    }
}
