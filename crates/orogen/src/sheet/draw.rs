//! A map sheet: heights, and all that belongs to a map of them, on a page.

use super::furniture::{COLORS, Desk, Entry, LEGEND_ROWS, Sign, colors_block, legend_block, north_block, scale_block};
use super::ground::laid;
use super::labels::{Label, Setting, Taken, gaps, place};
use super::layout::{Block, Layout};
use super::letters::Letters;
use super::lines::{Summit, interval, is_thick, lines, summits, thick_interval};
use super::marks;
use super::options::{Options, Page};
use super::profile::Profile;
use super::ramp::Ramp;
use super::relief::paint;
use super::scene::{INK, Item, Place, Scene, Step};
use super::ticks::{Count, grouped};
use super::water::{Least, Water, find};
use crate::contour::chaikin::smooth;
use crate::contour::line::Line;
use crate::contour::trace;
use crate::error::{Error, ErrorKind, Result};
use crate::format::levels::Levels;
use crate::grid::Grid;
use crate::map::text::Face;
use crate::palette::color::{Light, Rgb};
use crate::palette::tint::Tint;
use crate::progress::Progress;

/// A sheet that is drawn.
pub struct Sheet {
    /// What is on it.
    pub scene: Scene,
    /// Letters of its title that no font at hand has; they are left out.
    pub lacking: Vec<char>,
    /// Metres from one contour to the next, if there are contours.
    pub interval: Option<f64>,
    /// Pixels an inch, for [`raster::draw`](super::raster::draw).
    pub dpi: f64,
    /// Left, top, width and height of the ground on the page, in millimetres, from the middles of its first samples to those of its last.
    pub ground: [f32; 4],
}

/// How wide a sample is that lines are drawn from, in millimetres, and the most of them along a side.
const SAMPLE: f64 = 0.25;
const MOST: usize = 2400;

/// Where rivers begin, and how large lakes are, in square millimetres; how deep, as a share of the relief.
const SPRING: f64 = 42.0;
const LAKE: f64 = 2.0;
const DEPTH: f64 = 0.006;

/// Heights of so many times finer samples are smooth between those that there were.
const ENLARGED: f64 = 0.6;

/// Inks and widths in millimetres.
const BROWN: Rgb = [126, 82, 42];
const DARK_BROWN: Rgb = [92, 56, 26];
const BLUE: Rgb = [34, 92, 156];
const SHORE: Rgb = [40, 96, 152];
const ISOBATH: Rgb = [58, 112, 166];
/// Light of the ground below which inks are bright.
const DARK: f32 = 0.14;
const LAKES: Rgb = [170, 211, 233];
const THIN: f32 = 0.12;
const THICK: f32 = 0.24;
const RIVERS: [f32; 2] = [0.16, 0.95];

/// Size of the heights along contours, an em in millimetres, and of that their reach above the line.
const LABEL: Setting = Setting { size: 2.1, apart: 7.0, every: 95.0 };

/// How far summits are from each other in millimetres, and how many there are at most.
const APART: f64 = 26.0;
const SUMMITS: usize = 24;

/// How many samples lie along the longer side of a map of so many millimetres, to draw lines from.
pub fn lines_at(longer: f64) -> usize {
    ((longer / SAMPLE).ceil() as usize).clamp(8, MOST)
}

/// Draws a sheet of heights in metres. What is not finite is left as paper.
///
/// # Errors
/// If there are fewer than 2 x 2 heights or none at all, the contours asked for are too many, or the work is cancelled.
pub fn draw(heights: &Grid, options: &Options, progress: &Progress) -> Result<Sheet> {
    let window = heights.window();
    if window.width < 2 || window.height < 2 || heights.data().iter().all(|height| !height.is_finite()) {
        let sentence = format!(
            "there is nothing to map: it takes 2 x 2 heights, and there are {} x {}, {} of them finite",
            window.width,
            window.height,
            heights.data().iter().filter(|height| height.is_finite()).count()
        );
        return Err(Error::new(ErrorKind::Request, sentence));
    }
    let [water, painting, drawing] = progress.parts([4.0, 1.0, 1.0]);
    let letters = Letters::for_texts([options.title.as_str(), options.about.as_str()])?;
    let ground = Ground::of(heights, options)?;
    water.finish();
    progress.check()?;
    let entries = ground.legend(options);
    let parts = [
        (options.parts.colors, Part::Colors, colors_block()),
        (options.parts.scale, Part::Scale, scale_block()),
        (options.parts.north, Part::North, north_block()),
        (options.parts.legend && !entries.is_empty(), Part::Legend, legend_block(&entries, &letters)),
    ];
    let (parts, blocks): (Vec<Part>, Vec<Block>) =
        parts.into_iter().filter(|part| part.0).map(|(_, part, block)| (part, block)).unzip();
    let layout = Layout::new(ground.aspect, &blocks, options);
    let scene = Scene { size: layout.page, title: options.title.clone(), items: Vec::new() };
    let mut desk = Desk { scene, letters: &letters };
    let sea = options.sea_level.map_or(f32::NEG_INFINITY, |sea| sea as f32);
    let ramp = options.layer.as_ref().map(|layer| Ramp::new(layer, &options.palette)).transpose()?;
    let colored = options.layer.as_ref().zip(ramp.as_ref()).map(|(layer, ramp)| (&layer.values, ramp));
    let tint = tint(heights, options);
    let map = layout.map;
    let pixels = [map[2], map[3]].map(|side| ((f64::from(side) * layout.dpi / 25.4).round() as usize).max(1));
    let picture = Item::Picture {
        area: map,
        width: pixels[0],
        height: pixels[1],
        pixels: paint(heights, colored, pixels, &tint, options.shading, sea),
    };
    desk.scene.items.push(picture);
    painting.finish();
    progress.check()?;
    ground.draw(&mut desk, map, options, &tint);
    drawing.finish();
    progress.check()?;
    desk.scene.frame(map, 0.3, INK);
    let metres = [window.width, window.height].map(|samples| (samples - 1) as f64 * window.cell);
    let scale = metres[0] / f64::from(map[2]);
    if options.parts.axes {
        let (spans, counts) = spans(heights, options);
        desk.axes(map, spans, counts);
    }
    let levels = Levels::of(heights);
    let ends = [f64::from(levels.low()), f64::from(levels.high())];
    for (part, at) in parts.into_iter().zip(&layout.blocks) {
        match part {
            Part::Colors => {
                let width = layout.column.unwrap_or(COLORS).min(COLORS);
                match &ramp {
                    Some(ramp) => desk.ramp(*at, width, ramp),
                    None => desk.colors(*at, width, &tint, ends),
                }
            }
            Part::Scale => desk.scale(*at, scale),
            Part::North => desk.north(*at),
            Part::Legend => desk.legend(*at, &entries, layout.column.map_or(LEGEND_ROWS, |_| entries.len())),
        }
    }
    if let Some(profile) = layout.profile.and_then(|area| Profile::new(heights, options, area)) {
        // On a map of another layer, the heights' colours would mean nothing.
        let tint = ramp.is_none().then_some(&tint);
        profile.draw(&mut desk, map, tint, layout.dpi);
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
        interval: ground.interval,
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

/// The colours of a sheet. Where nothing is told of a sea, all is land.
fn tint(heights: &Grid, options: &Options) -> Tint {
    let lowest = Levels::of(heights).low();
    if options.layer.is_some() {
        // The palette is the layer's; lines keep the inks that suit heights.
        return Tint::fit(heights, options.sea_level.map_or(lowest - 1.0, |sea| sea as f32));
    }
    let sea = options.sea_level.map_or(lowest - 1.0, |sea| sea as f32);
    Tint::of(&options.palette, heights, sea)
}

/// What the sides count: the values at the left and the right, at the top and the bottom.
fn spans(heights: &Grid, options: &Options) -> ([[f64; 2]; 2], [Count; 2]) {
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
        // A world's own metres count south.
        None => ([[west, east], [north, south]], [Count::Metres; 2]),
    }
}

/// What the sheet says of itself.
fn facts(metres: [f64; 2], [low, high]: [f64; 2], scale: f64, options: &Options) -> String {
    let size = match metres[0].max(metres[1]) >= 2000.0 {
        true => format!("{} × {} km", short(metres[0] / 1000.0), short(metres[1] / 1000.0)),
        false => format!("{} × {} m", short(metres[0]), short(metres[1])),
    };
    let decimals = if high - low < 20.0 { 1 } else { 0 };
    let mut text = format!("{size}, heights {} to {} m", grouped(low, decimals), grouped(high, decimals));
    if let Page::Paper(_) = options.page {
        let ratio = scale * 1000.0;
        let power = libm::pow(10.0, libm::log10(ratio).floor() - 2.0);
        text += &format!(", scale about 1 : {}", grouped((ratio / power).round() * power, 0));
    }
    text
}

/// A number with three digits, or all before the point.
fn short(value: f64) -> String {
    let decimals = (2.0 - libm::log10(value.max(1e-9)).floor()).clamp(0.0, 3.0) as usize;
    let text = format!("{value:.decimals$}");
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').to_string() } else { text }
}

/// What contours and their heights are drawn with.
struct Inks {
    line: Rgb,
    words: Rgb,
    cover: f32,
}

impl Inks {
    /// Those that are seen on a colour: dark ones, and on dark ground bright ones.
    fn over([red, green, blue]: Light, is_land: bool) -> Inks {
        let dark = 0.2126 * red + 0.7152 * green + 0.0722 * blue < DARK;
        match (is_land, dark) {
            (true, false) => Inks { line: BROWN, words: DARK_BROWN, cover: 0.62 },
            (true, true) => Inks { line: [226, 200, 168], words: [244, 228, 208], cover: 0.4 },
            (false, false) => Inks { line: ISOBATH, words: [28, 74, 122], cover: 0.5 },
            (false, true) => Inks { line: [176, 208, 232], words: [206, 228, 244], cover: 0.32 },
        }
    }
}

/// The heights at the samples that lines are drawn from, and the lines.
struct Ground {
    grid: Grid,
    /// Width over height.
    aspect: f64,
    water: Water,
    contours: Vec<Line>,
    interval: Option<f64>,
    shore: Vec<Line>,
    summits: Vec<Summit>,
    /// Columns and rows of the heights that it was made of.
    samples: [usize; 2],
}

impl Ground {
    fn of(heights: &Grid, options: &Options) -> Result<Ground> {
        let window = heights.window();
        let sides = [window.width - 1, window.height - 1].map(|side| side as f64);
        let aspect = sides[0] / sides[1];
        // How large the map will be is known only with its legend; near enough.
        let longer = match options.page {
            Page::Fitted(longer) => longer,
            Page::Paper([width, height]) => {
                let (width, height) = ((width - 36.0).max(10.0), (height - 60.0).max(10.0));
                if width / height > aspect { height * aspect.max(1.0) } else { width / aspect.min(1.0) }
            }
        };
        let samples = lines_at(longer);
        let size = sides.map(|side| ((samples as f64 * side / sides[0].max(sides[1])).round() as usize).max(1) + 1);
        let sample = longer / samples as f64;
        let grid = laid(heights, size);
        let levels = Levels::of(&grid);
        let relief = f64::from(levels.high()) - f64::from(levels.low());
        let parts = &options.parts;
        let sea = options.sea_level.map(|sea| sea as f32);
        let cells = |millimetres: f64| (millimetres / (sample * sample)).ceil().max(1.0) as u32;
        let water = match (parts.rivers || parts.lakes) && relief > 0.0 {
            true => {
                // Rivers run through lakes that are not drawn.
                let lake = if parts.lakes { cells(LAKE) } else { u32::MAX };
                let scattered = grid.window().cell < ENLARGED * window.cell;
                let depth = (relief * DEPTH) as f32;
                find(&grid, sea, Least { spring: cells(SPRING), lake, depth, scattered })?
            }
            false => Water { rivers: Vec::new(), lakes: Vec::new(), surface: grid.clone() },
        };
        let interval =
            parts.contours.then(|| options.interval.unwrap_or_else(|| interval(&grid, options.sea_level, sample)));
        // Contours end at lakes that are drawn, and go on under those that are not.
        let ground = Grid::from_data(*grid.window(), water.surface.data().to_vec()).filter(|_| parts.lakes);
        let contours = match interval {
            Some(interval) if relief > 0.0 => {
                lines(ground.as_ref().unwrap_or(&grid), interval, options.sea_level, sample)?
            }
            _ => Vec::new(),
        };
        let shore = match (options.sea_level, options.palette.has_sea()) {
            (Some(sea), true) => trace::contours(&grid, &[sea])?.iter().map(|line| smooth(line, 1)).collect(),
            _ => Vec::new(),
        };
        let summits = match options.parts.summits {
            // Looked for among the heights themselves: means, and the cubic between samples, have other summits.
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
        Ok(Ground { grid, aspect, water, contours, interval, shore, summits, samples })
    }

    /// What its lines mean.
    fn legend(&self, options: &Options) -> Vec<Entry> {
        let mut entries = Vec::new();
        if let Some(interval) = self.interval.filter(|_| !self.contours.is_empty()) {
            let metres = |value: f64| format!("{} m", grouped(value, if value.fract() == 0.0 { 0 } else { 1 }));
            let sea = options.sea_level.unwrap_or(f64::NEG_INFINITY);
            let ink = if self.contours.iter().any(|line| line.elevation > sea) { BROWN } else { ISOBATH };
            let entry = |width, text| Entry { sign: Sign::Line(width, ink), text };
            entries.push(entry(THIN, format!("Contours, {} apart", metres(interval))));
            entries.push(entry(THICK, format!("Index contours, {} apart", metres(thick_interval(interval)))));
        }
        if options.parts.rivers && !self.water.rivers.is_empty() {
            entries.push(Entry { sign: Sign::Line(0.45, BLUE), text: "River".into() });
        }
        if options.parts.lakes && !self.water.lakes.is_empty() {
            entries.push(Entry { sign: Sign::Water(LAKES, SHORE), text: "Lake".into() });
        }
        if !self.summits.is_empty() {
            entries.push(Entry { sign: Sign::Summit, text: "Summit, height in m".into() });
        }
        entries
    }

    /// Draws all lines on the map.
    fn draw(&self, desk: &mut Desk, map: [f32; 4], options: &Options, tint: &Tint) {
        let [left, top, width, height] = map;
        let across = width / (self.grid.width() - 1) as f32;
        let down = height / (self.grid.height() - 1) as f32;
        let spot = |[x, y]: [f64; 2]| [left + x as f32 * across, top + y as f32 * down];
        let cell = self.grid.window().cell;
        let path = |line: &Line| line.path().map(|[x, y]| spot([x / cell, y / cell])).collect::<Vec<Place>>();
        let mut taken = Taken::none(inset(map, 1.0));
        let rivers: Vec<(f32, Vec<Place>)> = match options.parts.rivers {
            true => self
                .water
                .rivers
                .iter()
                .map(|river| (self.width(river.drained), river.points.iter().map(|p| spot(*p)).collect()))
                .collect(),
            false => Vec::new(),
        };
        let lakes: Vec<Vec<Place>> = match options.parts.lakes {
            true => self.water.lakes.iter().map(|ring| ring.iter().map(|p| spot(*p)).collect()).collect(),
            false => Vec::new(),
        };
        let shore: Vec<Vec<Place>> = self.shore.iter().map(path).collect();
        rivers.iter().for_each(|(width, line)| taken.take_line(line, 0.35 + width / 2.0));
        lakes.iter().chain(&shore).for_each(|line| taken.take_line(line, 0.5));
        // Summits are written last, over the lines, but take their room first.
        let mut over = Desk {
            scene: Scene { size: desk.scene.size, title: String::new(), items: Vec::new() },
            letters: desk.letters,
        };
        for summit in &self.summits {
            let share = |at: usize, samples: usize| at as f32 / (samples - 1) as f32;
            let place =
                [left + width * share(summit.x, self.samples[0]), top + height * share(summit.y, self.samples[1])];
            let text = grouped(f64::from(summit.height), 0);
            marks::summit(&mut over.scene, desk.letters, &mut taken, place, &text);
        }
        let sea = options.sea_level.unwrap_or(f64::NEG_INFINITY);
        let interval = self.interval.unwrap_or(1.0);
        // By ink and thickness, in the order in which they were met.
        let ink = |elevation: f64| Inks::over(tint.at(elevation as f32), elevation > sea);
        let mut kinds: Vec<(Rgb, f32, f32, Vec<Vec<Place>>)> = Vec::new();
        let mut thick: Vec<(&Line, Vec<Place>)> = Vec::new();
        let mut sort = |line: &Line, places: Vec<Place>| {
            let inks = ink(line.elevation);
            let (width, cover) = if is_thick(line, interval) { (THICK, inks.cover + 0.18) } else { (THIN, inks.cover) };
            match kinds.iter_mut().find(|kind| (kind.0, kind.1) == (inks.line, width)) {
                Some(kind) => kind.3.push(places),
                None => kinds.push((inks.line, width, cover, vec![places])),
            }
        };
        for line in &self.contours {
            match is_thick(line, interval) {
                true => thick.push((line, path(line))),
                false => sort(line, path(line)),
            }
        }
        let labels = if options.parts.labels { self.labels(desk.letters, &thick, &mut taken) } else { Vec::new() };
        thick.into_iter().for_each(|(line, places)| sort(line, places));
        let words: Vec<Label> = labels.iter().map(|(_, label)| label.clone()).collect();
        for (ink, width, cover, lines) in kinds {
            desk.scene.lines(gaps(&lines, &words, LABEL.size * 0.5, 0.25), width, ink, cover);
        }
        // Thin rivers first, so that they end under those that they flow into.
        let mut widths: Vec<f32> = rivers.iter().map(|river| river.0).collect();
        widths.sort_by(f32::total_cmp);
        widths.dedup();
        for width in widths {
            let same = rivers.iter().filter(|river| river.0 == width).map(|river| river.1.clone());
            desk.scene.lines(same.collect(), width, BLUE, 0.95);
        }
        let outline = lakes.iter().flat_map(|ring| super::scene::polygon(ring)).collect::<Vec<Step>>();
        desk.scene.area(outline, LAKES, 1.0);
        desk.scene.lines(lakes, 0.18, SHORE, 1.0);
        desk.scene.lines(shore, 0.22, SHORE, 0.9);
        for (elevation, label) in &labels {
            let ink = ink(*elevation).words;
            let width = desk.letters.width(&label.text, Face::Bold, LABEL.size);
            let length: f32 = label.path.windows(2).map(|pair| distance(pair[0], pair[1])).sum();
            let start = (length - width) / 2.0;
            let outline = desk.letters.each(&label.text, Face::Bold, LABEL.size, |along| {
                let (at, angle) = label.at(start + along);
                // The line runs through the middle of the letters, not along their feet.
                let sink = LABEL.size * 0.34;
                ([at[0] + sink * libm::sinf(angle), at[1] + sink * libm::cosf(angle)], angle)
            });
            desk.scene.area(outline, ink, 1.0);
        }
        desk.scene.items.append(&mut over.scene.items);
    }

    /// Heights along the index contours, the longest first.
    fn labels(&self, letters: &Letters, thick: &[(&Line, Vec<Place>)], taken: &mut Taken) -> Vec<(f64, Label)> {
        let mut order: Vec<&(&Line, Vec<Place>)> = thick.iter().collect();
        order.sort_by(|a, b| b.0.length().total_cmp(&a.0.length()));
        let mut labels = Vec::new();
        for (line, places) in order {
            let text = grouped(line.elevation, if line.elevation.fract() == 0.0 { 0 } else { 1 });
            let width = letters.width(&text, Face::Bold, LABEL.size);
            labels.extend(place(places, &text, width, LABEL, taken).into_iter().map(|label| (line.elevation, label)));
        }
        labels
    }

    /// How wide a river is drawn that so many samples drain to: as the root of its water, in steps that the eye can tell.
    fn width(&self, drained: u32) -> f32 {
        let share = (f64::from(drained) / self.grid.data().len() as f64).sqrt() as f32;
        let width = RIVERS[0] + (RIVERS[1] - RIVERS[0]) * (share * 1.3).min(1.0);
        (width / 0.06).round() * 0.06
    }
}

fn inset([left, top, width, height]: [f32; 4], by: f32) -> [f32; 4] {
    [left + by, top + by, width - 2.0 * by, height - 2.0 * by]
}

fn distance(a: Place, b: Place) -> f32 {
    let [dx, dy] = [0, 1].map(|c| b[c] - a[c]);
    (dx * dx + dy * dy).sqrt()
}

#[cfg(test)]
mod tests {
    use super::super::options::{Parts, Resolution};
    use super::super::relief::Shading;
    use super::super::{pdf, raster, vector};
    use super::*;

    fn draw(heights: &Grid, options: &Options) -> Result<Sheet> {
        super::draw(heights, options, &Progress::none())
    }
    use crate::grid::Window;
    use crate::palette::named;

    fn options() -> Options {
        Options {
            title: "A test".into(),
            about: "Of hills".into(),
            palette: named::all()[0].palette(),
            shading: Shading::Multi,
            interval: None,
            parts: Parts::default(),
            page: Page::Fitted(100.0),
            resolution: Resolution::Inch(60.0),
            sea_level: Some(0.0),
            layer: None,
            map: None,
        }
    }

    fn hills(width: usize, height: usize) -> Grid {
        let mut grid = Grid::filled(Window::new(width, height, 50.0), 0.0);
        for j in 0..height {
            for i in 0..width {
                let (x, y) = (i as f64 / 9.0, j as f64 / 7.0);
                let hills = libm::sin(x) * libm::cos(y) + 0.4 * libm::sin(2.3 * x + y) + 0.03 * x;
                grid.row_mut(j)[i] = (700.0 * hills + 300.0) as f32;
            }
        }
        grid
    }

    fn places(scene: &Scene) -> Vec<Place> {
        let of = |item: &Item| match item {
            Item::Picture { area, .. } => vec![[area[0], area[1]], [area[0] + area[2], area[1] + area[3]]],
            Item::Lines { lines, .. } => lines.concat(),
            Item::Area { outline, .. } => outline
                .iter()
                .map(|step| match *step {
                    Step::Move(place) | Step::Line(place) | Step::Curve(_, _, place) => place,
                })
                .collect(),
        };
        scene.items.iter().flat_map(of).collect()
    }

    #[test]
    fn all_is_on_the_page_whatever_the_world() {
        let mut holed = hills(90, 70);
        for j in 20..40 {
            holed.row_mut(j)[30..50].fill(f32::NAN);
        }
        let flat = Grid::filled(Window::new(50, 50, 10.0), 12.0);
        let deep =
            Grid::from_data(Window::new(90, 70, 50.0), hills(90, 70).data().iter().map(|h| h - 5000.0).collect());
        let worlds = [hills(90, 70), holed, flat, deep.unwrap(), hills(2, 2), hills(400, 8), hills(8, 400)];
        for (k, heights) in worlds.iter().enumerate() {
            for page in [Page::Fitted(100.0), Page::Paper([210.0, 148.0]), Page::Paper([60.0, 60.0])] {
                let sheet = draw(heights, &Options { page, ..options() }).unwrap();
                let [width, height] = sheet.scene.size;
                let small = page == Page::Paper([60.0; 2]);
                for [x, y] in places(&sheet.scene) {
                    // What stands beneath the map may be more than so small a paper holds.
                    let inside = (0.0..=width).contains(&x) && (0.0..=height).contains(&y) || small;
                    assert!(x.is_finite() && y.is_finite() && inside, "{k} {page:?}: {x} {y} of {width} x {height}");
                }
            }
        }
        let none = Grid::filled(Window::new(5, 5, 1.0), f32::NAN);
        assert!(draw(&none, &options()).err().unwrap().to_string().contains("nothing to map"));
        assert!(draw(&hills(1, 9), &options()).is_err());
    }

    #[test]
    fn parts_are_left_out_one_by_one() {
        let heights = hills(120, 90);
        let all = draw(&heights, &options()).unwrap();
        assert!(all.interval.is_some_and(|interval| interval > 0.0));
        // Paper with room for a profile.
        let paper = || Options { page: Page::Paper([150.0, 270.0]), ..options() };
        let all = draw(&heights, &paper()).unwrap();
        let count = |change: fn(&mut Parts)| {
            let mut options = paper();
            change(&mut options.parts);
            places(&draw(&heights, &options).unwrap().scene).len()
        };
        let most = places(&all.scene).len();
        let without: [fn(&mut Parts); 11] = [
            |parts| parts.title = false,
            |parts| parts.axes = false,
            |parts| parts.contours = false,
            |parts| parts.labels = false,
            |parts| parts.summits = false,
            |parts| parts.rivers = false,
            |parts| parts.legend = false,
            |parts| parts.colors = false,
            |parts| parts.scale = false,
            |parts| parts.north = false,
            |parts| parts.profile = false,
        ];
        for (k, change) in without.into_iter().enumerate() {
            assert_ne!(count(change), most, "part {k}");
        }
    }

    #[test]
    fn every_kind_of_file_has_the_same_on_any_number_of_threads() {
        let written = |threads: usize| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            pool.install(|| {
                let sheet = draw(&hills(80, 60), &options()).unwrap();
                let (mut svg, mut page) = (Vec::new(), Vec::new());
                vector::write(&mut svg, &sheet.scene).unwrap();
                pdf::write(&mut page, &sheet.scene).unwrap();
                (raster::draw(&sheet.scene, sheet.dpi), svg, page)
            })
        };
        let (one, three) = (written(1), written(3));
        assert!(one == three);
        let text = String::from_utf8(one.1).unwrap();
        assert!(text.starts_with("<svg") && text.ends_with("</svg>\n") && one.2.starts_with(b"%PDF-1.4"));
    }

    #[test]
    fn pixels_are_as_many_as_asked() {
        let wide = Options { resolution: Resolution::Longer(700), ..options() };
        let sheet = draw(&hills(120, 40), &wide).unwrap();
        let [width, height] = raster::pixels(&sheet.scene, sheet.dpi);
        assert!(width.max(height) == 700, "{width} x {height}");
    }
}
