//! The map in metres of the world.

use std::io::Read;
use std::path::Path;

use orogen_grid::error::{Error, Result};
use orogen_grid::words::{bytes, count, number};

use super::cells::{Cells, Sets};
use super::document::Document;
use super::parts::{Lake, River, Settlement, Site, Water};
use super::rivers::rivers;
use super::surroundings::Surroundings;
use super::units::{self, EXPONENTS, LAND};
use crate::format::dem::refused;
use crate::format::features::Ring;
use crate::open;

/// Maximum length of a file, in bytes. The largest maps of the tool, of 100 000 cells, have about 100 MB.
const MAX_LENGTH: u64 = 256 << 20;

/// Range of the width and the height of a map, in metres.
const SIZES: std::ops::RangeInclusive<f64> = 1e3..=4e7;

/// Maximum number of vertices around a cell.
const MAX_SIDES: usize = 1000;

/// Distance by which land at the border of the map goes on beyond it, in distances between cells: the border is no
/// shore.
const BEYOND: f64 = 4.0;

/// Precipitation of the tool's unit, as a factor of the rain: 100 mm a year, where 1000 mm is 1.
const RAIN: f64 = 0.1;

/// The advice for files without cells.
const EXPORT: &str = "export the map again with `Export`, `Export To JSON`, `full`, in Azgaar's Fantasy Map Generator";

/// A map of Azgaar's Fantasy Map Generator, in metres of the world: x to the east, y to the south, from its north-west
/// corner.
#[derive(Debug, Clone, PartialEq)]
pub struct FmgMap {
    /// The name; may be empty.
    pub name: String,
    /// The seed of the tool, if it is a number.
    pub seed: Option<u64>,
    /// Width and height in metres.
    pub size: [f64; 2],
    /// Distance between the cells in metres: the root of their mean area.
    pub spacing: f64,
    /// Heights of cells; all of the land, and of water those of the grid if the file has it.
    pub sites: Vec<Site>,
    /// The land with its lakes: polygons of an outer ring and its holes. Land at the border of the map goes on beyond
    /// it.
    pub coast: Vec<Vec<Ring>>,
    /// The lakes, the largest first.
    pub lakes: Vec<Lake>,
    /// The rivers, main rivers before their tributaries.
    pub rivers: Vec<River>,
    /// The settlements: capitals first, then by population.
    pub settlements: Vec<Settlement>,
    /// Factors of the rain at positions; empty if the file has no precipitation.
    pub rain: Vec<([f64; 2], f64)>,
    /// Messages about what was left out.
    pub notes: Vec<String>,
}

impl FmgMap {
    /// Reads an export. `width` is the width of the map in kilometres, in place of the scale of the file.
    ///
    /// # Errors
    /// If the file cannot be read, is too large, or is no export with cells: the message says what is missing and
    /// where.
    pub fn read(path: &Path, width: Option<f64>) -> Result<FmgMap> {
        let name = path.display().to_string();
        let Some(content) = open::bytes(path, "read the map", MAX_LENGTH)? else {
            let why = format!("it has more than {}, the limit of a map", bytes(MAX_LENGTH));
            return Err(refused(&name, why));
        };
        let is_saved = path.extension().is_some_and(|extension| extension == "map" || extension == "gz");
        FmgMap::of_content(content, is_saved, width).map_err(|why| refused(&name, why))
    }

    /// Reads an export from a stream, such as standard input. `name` is its name in messages.
    ///
    /// # Errors
    /// The errors of [`FmgMap::read`].
    pub fn read_from(stream: &mut dyn Read, name: &str, width: Option<f64>) -> Result<FmgMap> {
        let mut content = Vec::new();
        let read = stream.take(MAX_LENGTH + 1).read_to_end(&mut content);
        read.map_err(|cause| Error::file("read the map from", Path::new(name), &cause))?;
        if content.len() as u64 > MAX_LENGTH {
            return Err(refused(name, format!("it has more than {}, the limit of a map", bytes(MAX_LENGTH))));
        }
        FmgMap::of_content(content, false, width).map_err(|why| refused(name, why))
    }

    /// The map of a file's content, which is perhaps the tool's own file.
    fn of_content(content: Vec<u8>, is_saved: bool, width: Option<f64>) -> std::result::Result<FmgMap, String> {
        let text = String::from_utf8(content).map_err(|_| "it is not text in UTF-8".to_owned());
        match text {
            Ok(text) if !is_saved || text.trim_start().starts_with('{') => FmgMap::parse(&text, width),
            Err(why) if !is_saved => Err(why),
            _ => Err(SAVED.into()),
        }
    }

    /// Reads the text of an export.
    ///
    /// # Errors
    /// A message that says what is missing or out of range, where, and what to do.
    pub fn parse(text: &str, width: Option<f64>) -> std::result::Result<FmgMap, String> {
        let text = text.trim_start_matches('\u{feff}');
        if !text.trim_start().starts_with('{') && text.lines().next().is_some_and(|line| line.contains('|')) {
            return Err(SAVED.into());
        }
        let document = Document::parse(text)?;
        check_cells(&document)?;
        let (metres_per_pixel, size) = scale(&document, width)?;
        let (cells, heights) = cells(&document, metres_per_pixel, size)?;
        let water = water(&cells, &heights);
        let spacing = spacing(&document, &cells, size);
        let around = Surroundings { metres_per_pixel, size, spacing, cells, water };
        let mut notes = Vec::new();
        let coast = coast(&around)?;
        if coast.is_empty() {
            return Err(format!("it has no land: no `h` of {} is {LAND} or more", document.cells_name));
        }
        let exponent = exponent(&document)?;
        let (rivers, short) = rivers(&document, &around)?;
        if short > 0 {
            notes.push(format!("{} with fewer than two points left out", count(short, "river")));
        }
        let settlements = settlements(&document, &around, &mut notes);
        let rain = rain(&document, &around);
        if rain.is_empty() {
            notes.push("it has no precipitation (`grid.cells[].prec`); the rain is the same everywhere".into());
        }
        Ok(FmgMap {
            name: [&document.info, &document.settings]
                .iter()
                .find_map(|table| table.text("mapName", 0))
                .unwrap_or_default()
                .to_owned(),
            seed: document.info.text("seed", 0).and_then(|seed| seed.parse().ok()),
            size,
            spacing,
            sites: sites(&document, &around, &heights, exponent),
            coast,
            lakes: lakes(&document, &around, exponent)?,
            rivers,
            settlements,
            rain,
            notes,
        })
    }
}

/// The message for the tool's own files.
const SAVED: &str = "it is no JSON; a .map file is only read by Azgaar's Fantasy Map Generator itself: load it there, \
                     then choose `Export`, `Export To JSON`, `full`";

/// Metres per pixel, and the size in metres.
fn scale(document: &Document, width: Option<f64>) -> std::result::Result<(f64, [f64; 2]), String> {
    let pixels = |name: &str| match document.info.number(name, 0) {
        Some(pixels) if (1.0..=1e5).contains(&pixels) => Ok(pixels),
        Some(pixels) => Err(format!("`info.{name}` is {}, and must be 1 to 100000 pixels; {EXPORT}", number(pixels))),
        None => Err(format!("`info.{name}`, the size of the map in pixels, is missing; {EXPORT}")),
    };
    let [columns, rows] = [pixels("width")?, pixels("height")?];
    let metres = match width {
        Some(width) => width * 1000.0 / columns,
        None => {
            let settings = &document.settings;
            let advice = "give the width of the map in kilometres, such as `--width 1200`";
            let Some(scale) = settings.number("distanceScale", 0).filter(|scale| *scale > 0.0) else {
                return Err(format!("it does not say how long a pixel is (`settings.distanceScale`); {advice}"));
            };
            let unit = settings.text("distanceUnit", 0).unwrap_or_default();
            let Some(metres) = units::metres(unit) else {
                return Err(format!(
                    "`settings.distanceUnit` is `{}`, whose length is not known; {advice}",
                    unit.escape_debug()
                ));
            };
            scale * metres
        }
    };
    let size = [columns * metres, rows * metres];
    if !size.iter().all(|length| SIZES.contains(length)) {
        return Err(format!(
            "its map is {} x {} km, and sides of 1 to 40000 km are read; give another width, such as `--width 1200`",
            number(size[0] / 1000.0),
            number(size[1] / 1000.0)
        ));
    }
    Ok((metres, size))
}

/// Checks that there are cells with positions and corners.
fn check_cells(document: &Document) -> std::result::Result<(), String> {
    let (table, name) = (&document.pack.cells, document.cells_name);
    if table.rows() == 0 {
        return Err(format!("it has no cells (`{name}`), as in a `minimal` export; {EXPORT}"));
    }
    if !table.has("p") {
        return Err(format!("the cells have no positions (`{name}[].p`), as in an export of `grid cells`; {EXPORT}"));
    }
    if document.pack.vertices.rows() == 0 {
        return Err(format!("it has no corners of cells (`pack.vertices`); {EXPORT}"));
    }
    Ok(())
}

/// The cells in metres, and their heights from 0 to 100.
fn cells(document: &Document, metres: f64, size: [f64; 2]) -> std::result::Result<(Cells, Vec<f64>), String> {
    let (table, name) = (&document.pack.cells, document.cells_name);
    let vertices = &document.pack.vertices;
    // Corners of cells may be outside the map, but not far from it.
    let placed = |[x, y]: [f64; 2]| {
        let at = [x * metres, y * metres];
        (at[0].abs() <= 3.0 * size[0] && at[1].abs() <= 3.0 * size[1]).then_some(at)
    };
    let mut corners = Vec::with_capacity(vertices.rows());
    for row in 0..vertices.rows() {
        // A corner that no cell has may be anywhere.
        corners.push(vertices.position("p", row).and_then(placed).unwrap_or([f64::NAN; 2]));
    }
    let mut cells = Cells { middles: Vec::new(), vertices: corners, around: Vec::new(), starts: vec![0] };
    let mut heights = Vec::with_capacity(table.rows());
    for row in 0..table.rows() {
        let Some(middle) = table.position("p", row).and_then(placed) else {
            return Err(format!("`{name}[{row}].p` is not a position [x, y] on the map; {EXPORT}"));
        };
        let Some(height) = table.number("h", row).filter(|height| (0.0..=100.0).contains(height)) else {
            return Err(format!("`{name}[{row}].h` is not a height from 0 to 100; {EXPORT}"));
        };
        let around = table.list("v", row);
        if !(3..=MAX_SIDES).contains(&around.len()) {
            return Err(format!(
                "`{name}[{row}].v` has {}, and a cell has 3 to {MAX_SIDES}; {EXPORT}",
                count(around.len(), "corner")
            ));
        }
        for (k, &vertex) in around.iter().enumerate() {
            let index = vertex as usize;
            let is_there = vertex >= 0.0
                && vertex.fract() == 0.0
                && cells.vertices.get(index).is_some_and(|at| at.iter().all(|number| number.is_finite()));
            if !is_there {
                return Err(format!("`{name}[{row}].v[{k}]` is not the number of a corner on the map; {EXPORT}"));
            }
            cells.around.push(index as u32);
        }
        cells.starts.push(cells.around.len());
        cells.middles.push(middle);
        heights.push(height);
    }
    Ok((cells, heights))
}

/// The water of each cell. Water that reaches the outermost sides is sea.
fn water(cells: &Cells, heights: &[f64]) -> Vec<Option<Water>> {
    let mut sets = Sets::new(heights.len());
    let is_water = |cell: u32| heights[cell as usize] < LAND;
    let sides = cells.sides(0..heights.len());
    let mut outer = Vec::new();
    for same in sides.chunk_by(|a, b| (a.low, a.high) == (b.low, b.high)) {
        match same {
            [one] => outer.push(one.cell),
            _ => {
                for pair in same.windows(2).filter(|pair| is_water(pair[0].cell) && is_water(pair[1].cell)) {
                    sets.join(pair[0].cell, pair[1].cell);
                }
            }
        }
    }
    let mut is_sea = vec![false; heights.len()];
    for cell in outer {
        is_sea[sets.root(cell) as usize] = true;
    }
    let water = |cell: u32| match is_water(cell).then(|| is_sea[sets.root(cell) as usize]) {
        None => None,
        Some(true) => Some(Water::Sea),
        Some(false) => Some(Water::Lake),
    };
    (0..heights.len() as u32).map(water).collect()
}

/// The distance between cells: that of the grid, else that of the cells of the land.
fn spacing(document: &Document, cells: &Cells, size: [f64; 2]) -> f64 {
    let whole = size[0] * size[1];
    let area = match document.grid.rows() {
        0 => {
            let areas: f64 = (0..cells.middles.len()).map(|cell| cells.area(cell)).sum();
            areas.min(whole) / cells.middles.len().max(1) as f64
        }
        count => whole / count as f64,
    };
    area.sqrt().clamp(1e-3 * whole.sqrt(), whole.sqrt())
}

/// The polygons of the land. Corners on the outermost sides are moved away from the border of the map.
fn coast(around: &Surroundings) -> std::result::Result<Vec<Vec<Ring>>, String> {
    let Surroundings { cells, water, size, spacing, .. } = around;
    let mut is_outer = vec![false; cells.vertices.len()];
    let sides = cells.sides(0..cells.middles.len());
    for same in sides.chunk_by(|a, b| (a.low, a.high) == (b.low, b.high)) {
        if let [side] = same {
            is_outer[side.low as usize] = true;
            is_outer[side.high as usize] = true;
        }
    }
    let beyond = |at: f64, length: f64| match at {
        at if at < 1.5 * spacing => -BEYOND * spacing,
        at if at > length - 1.5 * spacing => length + BEYOND * spacing,
        at => at,
    };
    let place = |vertex: u32| {
        let [x, y] = cells.vertices[vertex as usize];
        match is_outer[vertex as usize] {
            true => [beyond(x, size[0]), beyond(y, size[1])],
            false => [x, y],
        }
    };
    cells.polygons((0..water.len()).filter(|&cell| water[cell] != Some(Water::Sea)), place)
}

/// The exponent of heights.
fn exponent(document: &Document) -> std::result::Result<f64, String> {
    match document.settings.number("heightExponent", 0) {
        None => Ok(2.0),
        Some(exponent) if EXPONENTS.contains(&exponent) => Ok(exponent),
        Some(exponent) => Err(format!(
            "`settings.heightExponent` is {}, and must be {} to {}",
            number(exponent),
            EXPONENTS.start(),
            EXPONENTS.end()
        )),
    }
}

/// The heights of all cells. The grid has more cells in the sea.
fn sites(document: &Document, around: &Surroundings, heights: &[f64], exponent: f64) -> Vec<Site> {
    let (grid, points) = (&document.grid, &document.points);
    let has_grid = grid.rows() > 0 && grid.rows() == points.rows() && grid.has("h");
    let site = |(cell, &h): (usize, &f64)| Site {
        at: around.cells.middles[cell],
        height: units::height(h, exponent),
        water: around.water[cell],
    };
    let mut sites: Vec<Site> = heights.iter().enumerate().map(site).collect();
    if has_grid {
        sites.retain(|site| site.water != Some(Water::Sea));
        let mut is_lake = vec![false; grid.rows()];
        for (cell, _) in around.water.iter().enumerate().filter(|(_, water)| **water == Some(Water::Lake)) {
            let of = document.pack.cells.number("g", cell).and_then(|of| is_lake.get_mut(of as usize));
            of.into_iter().for_each(|is_lake| *is_lake = true);
        }
        for row in (0..grid.rows()).filter(|&row| !is_lake[row]) {
            let (Some(h), Some([x, y])) = (grid.number("h", row), points.position("points", row)) else { continue };
            let at = [x * around.metres_per_pixel, y * around.metres_per_pixel];
            if h < LAND && around.limited(at) == at {
                sites.push(Site { at, height: units::height(h.max(0.0), exponent), water: Some(Water::Sea) });
            }
        }
    }
    sites
}

/// The lakes, the largest first.
fn lakes(document: &Document, around: &Surroundings, exponent: f64) -> std::result::Result<Vec<Lake>, String> {
    let cells = &around.cells;
    let lake_cells = || (0..around.water.len()).filter(|&cell| around.water[cell] == Some(Water::Lake));
    let mut sets = Sets::new(around.water.len());
    for same in cells.sides(lake_cells()).chunk_by(|a, b| (a.low, a.high) == (b.low, b.high)) {
        same.windows(2).for_each(|pair| sets.join(pair[0].cell, pair[1].cell));
    }
    let mut members: Vec<(u32, usize)> = lake_cells().map(|cell| (sets.root(cell as u32), cell)).collect();
    members.sort_unstable();
    let (table, features) = (&document.pack.cells, &document.pack.features);
    let mut lakes = Vec::new();
    for members in members.chunk_by(|a, b| a.0 == b.0) {
        let own = || members.iter().map(|member| member.1);
        let parts = cells.polygons(own(), |vertex| cells.vertices[vertex as usize])?;
        let first = members[0].1;
        let feature = table
            .number("f", first)
            .and_then(|id| Some(id as usize).filter(|row| features.number("i", *row) == Some(id)));
        let sum = own().map(|cell| cells.middles[cell]).fold([0.0; 2], |sum, at| [sum[0] + at[0], sum[1] + at[1]]);
        let mean = sum.map(|sum| sum / members.len() as f64);
        let far = |cell: usize| libm::hypot(cells.middles[cell][0] - mean[0], cells.middles[cell][1] - mean[1]);
        let middle = own().min_by(|a, b| far(*a).total_cmp(&far(*b))).unwrap_or(first);
        let area: f64 = own().map(|cell| cells.area(cell)).sum();
        let lake = Lake {
            name: feature.and_then(|row| features.text("name", row)).unwrap_or_default().to_owned(),
            height: feature
                .and_then(|row| features.number("height", row))
                .filter(|height| (LAND..=100.0).contains(height))
                .map(|height| units::height(height, exponent)),
            parts,
            middle: cells.middles[middle],
        };
        if !lake.parts.is_empty() {
            lakes.push((area, lake));
        }
    }
    lakes.sort_by(|a, b| b.0.total_cmp(&a.0));
    Ok(lakes.into_iter().map(|(_, lake)| lake).collect())
}

/// The settlements that exist.
fn settlements(document: &Document, around: &Surroundings, notes: &mut Vec<String>) -> Vec<Settlement> {
    let table = &document.pack.burgs;
    let (mut found, mut odd) = (Vec::new(), 0);
    for row in 0..table.rows() {
        let Some(name) = table.text("name", row) else { continue };
        if table.number("removed", row).is_some_and(|removed| removed != 0.0) {
            continue;
        }
        let at = table.number("x", row).zip(table.number("y", row));
        let at = at.map(|(x, y)| [x * around.metres_per_pixel, y * around.metres_per_pixel]);
        match at.filter(|at| around.limited(*at) == *at) {
            Some(at) => found.push(Settlement {
                name: name.to_owned(),
                at,
                is_capital: table.number("capital", row).is_some_and(|capital| capital != 0.0),
                population: table.number("population", row).unwrap_or(0.0),
            }),
            None => odd += 1,
        }
    }
    if odd > 0 {
        notes.push(format!("{} without a position on the map left out (`pack.burgs`)", count(odd, "settlement")));
    }
    found.sort_by(|a, b| b.is_capital.cmp(&a.is_capital).then(b.population.total_cmp(&a.population)));
    found
}

/// Factors of the rain.
fn rain(document: &Document, around: &Surroundings) -> Vec<([f64; 2], f64)> {
    let at = |[x, y]: [f64; 2]| [x * around.metres_per_pixel, y * around.metres_per_pixel];
    let factor = |precipitation: f64| (RAIN * precipitation).clamp(0.0, 100.0);
    let (grid, points) = (&document.grid, &document.points);
    if grid.has("prec") && grid.rows() == points.rows() {
        let row = |row| Some((at(points.position("points", row)?), factor(grid.number("prec", row)?)));
        return (0..grid.rows()).filter_map(row).filter(|(at, _)| around.limited(*at) == *at).collect();
    }
    let table = &document.pack.cells;
    let row = |row| Some((around.cells.middles[row], factor(table.number("prec", row)?)));
    (0..table.rows()).filter_map(row).collect()
}
