//! Map sheets: heights with all elements of a map, on a page.

use super::font_set::FontSet;
use super::furniture::{COLORS, Desk, Entry, LEGEND_ROWS, Sign, colors_block, legend_block, north_block, scale_block};
use super::geometry::Rect;
use super::grid_lines::GridLines;
use super::layout::{Block, Layout};
use super::linework::{Linework, longer_side};
use super::options::{Coloring, Page, SheetOptions, SurfaceEntry};
use super::overlay::Below;
use super::profile::{Direction, Profile};
use super::ramp::Ramp;
use super::relief::{Paint, paint};
use super::scene::{Item, Scene};
use super::ticks::{Count, grouped};
use orogen_grid::error::{Error, ErrorKind, Result};
use orogen_grid::grid::Grid;
use orogen_grid::progress::Progress;
use orogen_io::format::levels::Levels;
use orogen_io::palette::tint::Tint;

/// A drawn sheet.
pub struct Sheet {
    /// The items on the page.
    pub scene: Scene,
    /// Characters of the texts that no installed font has; they are omitted.
    pub lacking: Vec<char>,
    /// Names that have no room on the map; they are omitted.
    pub left_out: Vec<String>,
    /// Names of rivers at points without a river nearby; they are omitted.
    pub without_river: Vec<String>,
    /// Distance between contours, in metres, if there are contours at an interval.
    pub interval: Option<f64>,
    /// The heights of the contours in metres, ascending.
    pub levels: Vec<f64>,
    /// Resolution in pixels per inch, for [`raster::draw`](super::raster::draw).
    pub dpi: f64,
    /// The rectangle of the ground on the page, between the centers of its first and its last samples.
    pub ground: Rect,
}

/// Draws a sheet of heights in metres. Samples that are not finite have the palette's color of missing samples.
///
/// # Errors
/// If there are fewer than 2 x 2 heights or none is finite, there would be too many contours, or the work is cancelled.
pub fn draw(heights: &Grid, options: &SheetOptions, progress: &Progress) -> Result<Sheet> {
    let window = heights.window();
    if window.width < 2 || window.height < 2 || heights.data().iter().all(|height| !height.is_finite()) {
        let message = format!(
            "a map needs at least 2 x 2 finite heights, and there are {} x {}, {} of them finite",
            window.width,
            window.height,
            heights.data().iter().filter(|height| height.is_finite()).count()
        );
        return Err(Error::new(ErrorKind::Request, message));
    }
    let [water, painting, drawing] = progress.parts([4.0, 1.0, 1.0]);
    let letters = FontSet::for_texts(
        [options.title.as_str(), options.about.as_str()]
            .into_iter()
            .chain(options.names.iter().map(|place| place.name.as_str()))
            .chain(options.line_names.iter().map(|line| line.name.as_str())),
    )?;
    let linework = Linework::of(heights, options)?;
    water.finish();
    progress.check()?;
    let mut entries = linework.legend(options);
    let (spans, counts) = spans(heights, options);
    let grid = options.grid.map(|step| {
        let longer = longer_side(window, options.page);
        let [width, height] = [linework.aspect.min(1.0), (1.0 / linework.aspect).min(1.0)];
        GridLines::new(step, spans, counts, [longer * width, longer * height])
    });
    let grid = grid.transpose()?;
    entries.extend(grid.as_ref().map(|grid| Entry { sign: Sign::Grid, text: grid.words() }));
    let cover = match &options.coloring {
        Coloring::Surfaces(cover) => cover.entries.iter().map(surface_entry).collect(),
        _ => Vec::new(),
    };
    let colors = if cover.is_empty() { colors_block() } else { legend_block(&cover, &letters) };
    let parts = [
        (options.parts.colors, Part::Colors, colors),
        (options.parts.scale, Part::Scale, scale_block()),
        (options.parts.north, Part::North, north_block()),
        (options.parts.legend && !entries.is_empty(), Part::Legend, legend_block(&entries, &letters)),
    ];
    let (parts, blocks): (Vec<Part>, Vec<Block>) =
        parts.into_iter().filter(|part| part.0).map(|(_, part, block)| (part, block)).unzip();
    let layout = Layout::new(linework.aspect, &blocks, options);
    let colors = options.page_colors;
    let scene = Scene { page: colors.page, ..Scene::new(layout.page, &options.title) };
    let mut desk = Desk { scene, letters: &letters, colors };
    let sea = options.sea_level.map_or(f32::NEG_INFINITY, |sea| sea as f32);
    let ramp = match &options.coloring {
        Coloring::Layer(layer) => Some(Ramp::new(layer, &options.palette)?),
        _ => None,
    };
    let colors = match (&options.coloring, &ramp) {
        (Coloring::Layer(layer), Some(ramp)) => Paint::Layer(&layer.values, ramp),
        (Coloring::Surfaces(cover), _) => Paint::Albedo(&cover.albedo),
        _ => Paint::Tint,
    };
    let is_tint = matches!(colors, Paint::Tint);
    let tint = tint(heights, options);
    let map = layout.map;
    let size = map.size().pixels(layout.dpi);
    let pixels = paint(heights, colors, size, &tint, options.shading, sea);
    painting.finish();
    progress.check()?;
    let below = if is_tint { Below::Tint(&tint) } else { Below::Picture(size[0], &pixels) };
    if let Some(grid) = &grid {
        grid.draw(&mut desk, map);
    }
    let left_out = linework.draw(&mut desk, map, options, &below);
    desk.scene.items.insert(0, Item::Picture { area: map, width: size[0], height: size[1], pixels });
    drawing.finish();
    progress.check()?;
    desk.scene.frame(map, 0.3, desk.colors.ink);
    let metres = [window.width, window.height].map(|samples| (samples - 1) as f64 * window.cell);
    let scale = metres[0] / f64::from(map.width);
    if options.parts.axes {
        match &grid {
            Some(grid) => grid.frame(&mut desk, map),
            None => desk.axes(map, spans, counts),
        }
    }
    let levels = Levels::of(heights);
    let ends = [levels.low(), levels.high()].map(f64::from);
    let rows = |entries: &[Entry]| layout.column.map_or(LEGEND_ROWS, |_| entries.len());
    for (part, at) in parts.into_iter().zip(&layout.blocks) {
        match part {
            Part::Colors if !cover.is_empty() => desk.legend(*at, &cover, rows(&cover)),
            Part::Colors => {
                let width = layout.column.unwrap_or(COLORS).min(COLORS);
                match &ramp {
                    Some(ramp) => desk.ramp(*at, width, ramp),
                    None => desk.colors(*at, width, &tint, options.range.map_or(ends, |range| range.map(f64::from))),
                }
            }
            Part::Scale => desk.scale(*at, scale),
            Part::North => desk.north(*at),
            Part::Legend => desk.legend(*at, &entries, rows(&entries)),
        }
    }
    let directions = [Direction::Eastward, Direction::Southward];
    for profile in layout.profiles.iter().zip(directions) {
        let Some(profile) = Profile::new(heights, options, profile.1, *profile.0) else { continue };
        // On a map of another layer, the colors of heights would be misleading.
        profile.draw(&mut desk, map, is_tint.then_some(&tint), layout.dpi);
    }
    if options.parts.title {
        let facts = facts(metres, ends, scale, options);
        let facts = ramp.as_ref().map_or(facts.clone(), |ramp| format!("{}; {facts}", ramp.words()));
        let about = [options.about.as_str(), &facts];
        desk.heading(&options.title, if options.about.is_empty() { [&facts, ""] } else { about });
    }
    let scene = desk.scene;
    Ok(Sheet {
        scene,
        lacking: letters.lacking().to_vec(),
        left_out: left_out.crowded,
        without_river: left_out.without_river,
        interval: linework.interval,
        levels: linework.levels(),
        dpi: layout.dpi,
        ground: layout.map,
    })
}

enum Part {
    Colors,
    Scale,
    North,
    Legend,
}

/// The tint of a sheet's heights. Without a sea level, everything is land.
fn tint(heights: &Grid, options: &SheetOptions) -> Tint {
    // With a given range, the colors must not depend on the window's own heights.
    let below_all = || options.range.map_or_else(|| Levels::of(heights).low() - 1.0, |_| f32::NEG_INFINITY);
    let sea = options.sea_level.map_or_else(below_all, |sea| sea as f32);
    match (&options.coloring, options.range) {
        (Coloring::Heights, Some(range)) => Tint::between(&options.palette, range, sea),
        (Coloring::Heights, None) => Tint::of(&options.palette, heights, sea),
        // The palette belongs to another layer; the sea keeps the tint of its depths.
        _ => Tint::fit(heights, sea),
    }
}

/// The legend entry of a surface.
fn surface_entry(surface: &SurfaceEntry) -> Entry {
    let percent = (surface.share * 100.0).round();
    let share = if percent < 1.0 { "below 1 %".to_string() } else { format!("{percent} %") };
    Entry { sign: Sign::Swatch(surface.colors.clone()), text: format!("{}, {share}", surface.name) }
}

/// The coordinates at the left and the right, and at the top and the bottom, with their units.
fn spans(heights: &Grid, options: &SheetOptions) -> ([[f64; 2]; 2], [Count; 2]) {
    let window = heights.window();
    let (west, east) = (window.east(0), window.east(window.width - 1));
    let (north, south) = (window.south(0), window.south(window.height - 1));
    match &options.map {
        Some(map) => {
            let ([left, top], [right, bottom]) = (map.at(west, north), map.at(east, south));
            let degrees = map.is_degrees();
            let counts = if degrees { [Count::Longitude, Count::Latitude] } else { [Count::Metres; 2] };
            ([[left, right], [top, bottom]], counts)
        }
        // A world's own metres increase southward.
        None => ([[west, east], [north, south]], [Count::Metres; 2]),
    }
}

/// The line of facts under the title.
fn facts(metres: [f64; 2], [low, high]: [f64; 2], scale: f64, options: &SheetOptions) -> String {
    let size = match metres[0].max(metres[1]) >= 2000.0 {
        true => format!("{} × {} km", short(metres[0] / 1000.0), short(metres[1] / 1000.0)),
        false => format!("{} × {} m", short(metres[0]), short(metres[1])),
    };
    let decimals = if high - low < 20.0 { 1 } else { 0 };
    let mut text = format!("{size}, heights {} to {} m", grouped(low, decimals), grouped(high, decimals));
    if let Some(ratio) = options.map_scale {
        text += &format!(", scale 1 : {}", grouped(ratio, 0));
    } else if let Page::Paper(_) = options.page {
        let ratio = scale * 1000.0;
        let power = libm::pow(10.0, libm::log10(ratio).floor() - 2.0);
        text += &format!(", scale about 1 : {}", grouped((ratio / power).round() * power, 0));
    }
    text
}

/// A number with three significant digits, or all digits before the decimal point.
fn short(value: f64) -> String {
    let decimals = (2.0 - libm::log10(value.max(1e-9)).floor()).clamp(0.0, 3.0) as usize;
    let text = format!("{value:.decimals$}");
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').to_string() } else { text }
}
