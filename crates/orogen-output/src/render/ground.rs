//! Appearance of the ground: rock, scree, grass, forest, snow and sand by slope, height and aspect.

use orogen_grid::parallel;

use super::albedo::{
    BEDS, CLAY, DESERT_WAVES, FARMLAND, GRAVEL, LUSH, NATURAL_WAVES, OCTAVES, ROCK, SAND, SCREE, SCRUB, SHORE, SNOW,
    SOIL, TREES, TUNDRA, Tones,
};
use super::grain::Grain;
use super::relief::{Land, Relief};
use orogen_grid::grid::Grid;
use orogen_io::palette::color::{Light, decode};
use orogen_io::palette::palette::{NO_DATA, Palette};
use orogen_io::palette::tint::Tint;

/// The coloring of the ground.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Colors {
    /// Forest, grass, scree, rock and snow, by height, slope and aspect.
    #[default]
    Natural,
    /// Beds of red and yellow rock, sand, and little vegetation.
    Desert,
    /// The albedo and roughness of [`Style::cover`](super::scene::Style::cover), with grain between samples.
    Surfaces,
    /// The tint of the relief map.
    Map,
    /// A single color, like a clay model.
    Clay,
}

/// Settings of the ground's appearance.
#[derive(Debug, Clone, Copy)]
pub(super) struct Dress<'a> {
    pub colors: Colors,
    pub palette: Option<&'a Palette>,
    pub range: Option<[f64; 2]>,
    pub cover: Option<[&'a Grid; 4]>,
    pub bedding: Option<&'a Grid>,
    pub snow_line: Option<f64>,
}

/// A point on the ground.
#[derive(Debug, Clone, Copy)]
pub(super) struct GroundPoint {
    /// Position in cells.
    pub x: f64,
    pub y: f64,
    /// Height in metres.
    pub height: f32,
    /// Width of a pixel here, in metres.
    pub footprint: f32,
}

/// The appearance of the ground at a point.
#[derive(Debug, Clone, Copy)]
pub(super) struct Look {
    /// Albedo: red, green and blue.
    pub albedo: Light,
    /// Slope east and south, including detail smaller than a cell, in z per cell as drawn.
    pub slope: [f32; 2],
}

/// The ground of a land, prepared for shading.
#[derive(Debug, Clone)]
pub(super) struct GroundCover {
    pub(super) colors: Colors,
    pub(super) tint: Tint,
    /// Per sample: slope east and south (metres per metre), concavity (-1 to 1), flow (0 to 1).
    pub(super) shape: Vec<[f32; 4]>,
    /// Albedo and roughness of every sample; empty if surfaces are not shown.
    pub(super) cover: Vec<[f32; 4]>,
    /// Height of the surface that the layers of rock follow; empty if they are level.
    pub(super) bedding: Vec<f32>,
    /// Whether each sample had no finite height; empty if all had one.
    pub(super) missing: Vec<bool>,
    pub(super) columns: usize,
    pub(super) rows: usize,
    pub(super) cell: f32,
    pub(super) exaggeration: f32,
    pub(super) sea: Option<f32>,
    pub(super) snow_line: f32,
    pub(super) tree_line: f32,
    pub(super) grain: Grain,
}

/// Land with less relief than this, in metres, has no snow by default.
const SNOW_RELIEF: f64 = 1500.0;
/// The shares of the relief at which snow starts and trees end.
const SNOW_SHARE: f64 = 0.60;
const TREE_SHARE: f64 = 0.40;

/// Factor of a map's colors: paper is brighter than any ground, and would be white in the sun.
pub(super) const PAPER: f32 = 0.55;

/// Albedo of ground without a height: a middle gray, darker than snow.
const MISSING: f32 = 0.3;

impl GroundCover {
    /// Prepares the ground of a land. The map's tint uses `palette`, over `range` or the heights of the land. Snow
    /// starts at `snow_line`, in metres, or at a share of the relief.
    pub fn new(land: &Land, relief: &Relief, dress: &Dress) -> GroundCover {
        let Dress { colors, palette, range, cover, bedding, snow_line } = *dress;
        let [columns, rows] = relief.samples();
        let (base, top) = (relief.height_of(0.0), relief.height_of(relief.highest()));
        let base = land.sea_level.map_or(base, |sea| base.max(sea));
        let rise = (top - base).max(0.0);
        let snow = snow_line.unwrap_or(if rise < SNOW_RELIEF { f64::INFINITY } else { base + SNOW_SHARE * rise });
        let tree = if snow.is_finite() { base + TREE_SHARE / SNOW_SHARE * (snow - base) } else { f64::INFINITY };
        let sea = land.sea_level.unwrap_or(f64::MIN) as f32;
        GroundCover {
            colors,
            tint: match (palette, range.map(|ends| ends.map(|end| end as f32))) {
                (Some(palette), Some(ends)) => Tint::between(palette, ends, sea),
                (None, Some([low, high])) => Tint::hypsometric(low, high, sea),
                (Some(palette), None) => Tint::of(palette, land.heights, sea),
                (None, None) => Tint::fit(land.heights, sea),
            },
            shape: shape(land, relief),
            cover: covered(cover, columns * rows),
            bedding: bedding.map_or(Vec::new(), |bedding| bedding.data().iter().map(|z| finite(*z)).collect()),
            missing: missing(land.heights),
            columns,
            rows,
            cell: relief.cell() as f32,
            exaggeration: relief.exaggeration() as f32,
            sea: land.sea_level.map(|sea| sea as f32),
            snow_line: snow as f32,
            tree_line: tree as f32,
            grain: Grain::new(),
        }
    }

    /// The noise that all detail is made of.
    pub fn grain(&self) -> &Grain {
        &self.grain
    }

    fn shape_at(&self, x: f64, y: f64) -> [f32; 4] {
        self.between(&self.shape, x, y)
    }

    /// The height above the bedding of a point at this height.
    fn above_bedding(&self, x: f64, y: f64, height: f32) -> f32 {
        if self.bedding.is_empty() {
            return height;
        }
        let [bedding] = self.between(self.bedding.as_chunks().0, x, y);
        height - bedding
    }

    /// Bilinear interpolation of samples of some numbers.
    fn between<const N: usize>(&self, samples: &[[f32; N]], x: f64, y: f64) -> [f32; N] {
        let (x, y) = (x.clamp(0.0, (self.columns - 1) as f64), y.clamp(0.0, (self.rows - 1) as f64));
        let (i, j) = ((x as usize).min(self.columns - 2), (y as usize).min(self.rows - 2));
        let (u, v) = ((x - i as f64) as f32, (y - j as f64) as f32);
        let at = j * self.columns + i;
        let [nw, ne, sw, se] = [at, at + 1, at + self.columns, at + self.columns + 1].map(|at| samples[at]);
        std::array::from_fn(|c| {
            let north = nw[c] + (ne[c] - nw[c]) * u;
            north + (sw[c] + (se[c] - sw[c]) * u - north) * v
        })
    }

    /// Noise of a wavelength in metres, faded where a pixel is too wide to resolve it.
    fn noise(&self, site: &GroundPoint, wavelength: f32, kind: u32) -> f32 {
        let seen = seen(wavelength, site.footprint);
        if seen <= 0.0 {
            return 0.0;
        }
        let scale = f64::from(self.cell / wavelength);
        self.grain.at(site.x * scale, site.y * scale, kind).value * seen
    }

    fn noises(&self, site: &GroundPoint, waves: [f32; 4]) -> [f32; 4] {
        let [a, b, c, d] = waves;
        [self.noise(site, a, 0), self.noise(site, b, 1), self.noise(site, c, 2), self.noise(site, d, 3)]
    }

    /// Whether the nearest sample has no finite height.
    fn is_missing(&self, site: &GroundPoint) -> bool {
        let nearest = |at: f64, count: usize| (at.max(0.0).round() as usize).min(count - 1);
        !self.missing.is_empty()
            && self.missing[nearest(site.y, self.rows) * self.columns + nearest(site.x, self.columns)]
    }

    /// The appearance of the ground at a point.
    pub fn look(&self, site: &GroundPoint) -> Look {
        let shape = self.shape_at(site.x, site.y);
        if self.is_missing(site) {
            let slope = [shape[0], shape[1]].map(|part| part * self.exaggeration);
            return Look { albedo: no_height(), slope };
        }
        let (albedo, rough) = match self.colors {
            Colors::Natural => self.natural(site, shape),
            Colors::Desert => self.desert(site, shape),
            Colors::Surfaces => self.covered(site),
            Colors::Map => (self.map_color(site.height), 0.0),
            Colors::Clay => (CLAY, 0.0),
        };
        let mut slope = [shape[0], shape[1]];
        if rough > 0.0 {
            self.roughen(site, rough, &mut slope);
        }
        Look { albedo, slope: slope.map(|part| part * self.exaggeration) }
    }

    /// Adds detail smaller than a cell: octaves from two cells down to the width of a pixel, the smaller ones steeper.
    fn roughen(&self, site: &GroundPoint, rough: f32, slope: &mut [f32; 2]) {
        let mut wavelength = 2.0 * self.cell;
        for octave in 0..OCTAVES {
            let seen = seen(wavelength, site.footprint) * (0.45 + 0.15 * f32::from(octave.min(4)));
            if seen <= 0.0 {
                return;
            }
            let scale = f64::from(self.cell / wavelength);
            let bump = self.grain.at(site.x * scale, site.y * scale, 8 + u32::from(octave));
            // The absolute value gives creases and edges; plain noise would be round.
            let fold = if bump.value < 0.0 { -seen } else { seen };
            for (slope, bump) in slope.iter_mut().zip(bump.slope) {
                *slope += bump * rough * fold;
            }
            wavelength *= 0.5;
        }
    }

    /// The color of a height on the map, as albedo.
    pub fn map_color(&self, height: f32) -> Light {
        self.tint.at(height).map(|c| c * PAPER)
    }

    /// The recipe's surfaces. Between samples their color varies as it does in soil and rock.
    fn covered(&self, site: &GroundPoint) -> (Light, f32) {
        let [red, green, blue, roughness] = self.between(&self.cover, site.x, site.y);
        let (small, fine) = (self.noise(site, 2.0 * self.cell, 2), self.noise(site, 0.5 * self.cell, 3));
        let grain = 1.0 + 0.16 * small + 0.18 * fine;
        ([red, green, blue].map(|part| (part * grain).clamp(0.0, 1.0)), 0.25 * roughness)
    }

    /// Land in a temperate climate: its color and roughness.
    fn natural(&self, site: &GroundPoint, [east, south, hollow, flow]: [f32; 4]) -> (Light, f32) {
        let steep = (east * east + south * south).sqrt();
        // 1 on slopes that face north.
        let north = south / (steep + 0.2);
        let [wide, middle, small, fine] = self.noises(site, NATURAL_WAVES);
        let rough_edge = 0.6 * middle + 0.4 * small + 0.25 * fine;

        // Rock: partly grayer and browner, with faint beds.
        let height = self.above_bedding(site.x, site.y, site.height);
        let bed = self.strata(height + 25.0 * wide + 6.0 * middle, 70.0);
        let shade = 0.5 + 0.30 * wide + 0.25 * middle + 0.25 * small + 0.30 * fine + 0.22 * bed;
        let rock = tone(ROCK, shade.clamp(0.0, 1.0));
        let scree = tone(SCREE, 0.5 + 0.4 * small + 0.4 * fine);

        // Vegetation: forest below the tree line, meadow above it, sparser towards the snow.
        let over_trees = site.height - self.tree_line + 130.0 * wide + 90.0 * middle + 60.0 * north;
        let lush = tone(LUSH, 0.5 + 0.5 * wide + 0.4 * small);
        let tundra = tone(TUNDRA, 0.5 + 0.5 * middle + 0.4 * fine);
        let meadow = mix(lush, tundra, step(-250.0, 350.0, over_trees));
        let trees = tone(TREES, 0.5 + 0.45 * middle + 0.5 * fine);
        let wooded = step(120.0, -160.0, over_trees)
            * step(-0.42, 0.05, 0.55 * wide + 0.55 * middle + 0.25 * small + 0.5 * steep - 0.10)
            * step(1.05, 0.75, steep);
        let mut color = mix(meadow, trees, wooded * 0.92);
        let mut rough = 0.10 + 0.16 * wooded;

        // Valley floors are farmland: lighter and more yellow.
        let floor = step(0.10, 0.03, steep) * step(0.0, -400.0, over_trees) * (1.0 - 0.6 * wooded);
        color = mix(color, tone(FARMLAND, 0.5 + 0.5 * middle + 0.5 * small), 0.6 * floor);

        // Bare where it is too steep for soil, or too high.
        let high =
            step(0.0, 700.0, site.height - 0.5 * (self.snow_line.min(1e6) + self.tree_line.min(1e6)) + 200.0 * middle);
        let bare = step(0.62, 0.92, steep + 0.20 * rough_edge - 0.10 * hollow + 0.34 * high);
        let loose = step(0.46, 0.66, steep + 0.14 * rough_edge + 0.35 * high) * (1.0 - 0.85 * wooded);
        color = mix(color, scree, loose * 0.8);
        color = mix(color, rock, bare);
        rough += 0.10 * loose + 0.22 * bare;

        // Gravel along rivers, sand along the sea.
        let gravel = step(0.72, 0.92, flow) * step(0.20, 0.05, steep) * 0.5;
        color = mix(color, GRAVEL, gravel);
        if let Some(sea) = self.sea {
            let shore = step(9.0, 2.0, site.height - sea + 5.0 * small) * step(0.40, 0.15, steep);
            color = mix(color, SHORE, shore);
            rough *= 1.0 - 0.8 * shore;
        }

        // Snow: lower in shade and in hollows, none on steep slopes.
        let above = site.height - self.snow_line
            + 190.0 * wide
            + 130.0 * middle
            + 50.0 * small
            + 170.0 * north
            + 110.0 * hollow;
        let lies = step(1.25, 0.80, steep + 0.15 * rough_edge - 0.25 * hollow - 0.0003 * above.clamp(0.0, 1500.0));
        let snow = step(-60.0, 140.0, above) * lies;
        color = mix(color, SNOW, snow);
        rough = rough * (1.0 - snow) + 0.05 * snow;
        (color, rough)
    }

    /// Land with little vegetation.
    fn desert(&self, site: &GroundPoint, [east, south, hollow, flow]: [f32; 4]) -> (Light, f32) {
        let steep = (east * east + south * south).sqrt();
        let [wide, middle, small, fine] = self.noises(site, DESERT_WAVES);
        // Beds of some metres within beds of some tens of metres.
        let height = self.above_bedding(site.x, site.y, site.height) + 14.0 * wide + 3.0 * middle;
        let at = f64::from(height) / 42.0;
        let bed = self.grain.at(at, 0.37, 4).value * 1.6 + self.grain.at(at * 3.7, 5.1, 5).value * 0.8;
        let place = (bed * 2.2 + 3.0).clamp(0.0, 4.999);
        let index = place as usize;
        let rock = mix(BEDS[index], BEDS[index + 1], place - index as f32);
        let rock = rock.map(|c| c * (1.0 + 0.12 * small + 0.14 * fine + 0.10 * middle));
        let sand = tone(SAND, 0.5 + 0.5 * middle + 0.3 * fine);
        let bare = step(0.16, 0.42, steep + 0.06 * (middle + small + fine) - 0.05 * hollow);
        let mut color = mix(sand, rock, 0.25 + 0.75 * bare);
        let green = step(0.55, 0.85, flow) * step(0.35, 0.12, steep) * 0.75
            + 0.35 * step(0.05, 0.45, 0.6 * middle + 0.5 * small + 0.5 * fine) * (1.0 - bare);
        color = mix(color, SCRUB, green.min(0.9));
        (color, 0.07 + 0.26 * bare)
    }

    /// Beds of rock: a value from -1 to 1 by height.
    fn strata(&self, height: f32, thickness: f32) -> f32 {
        self.grain.at(f64::from(height / thickness), 0.53, 6).value
    }

    /// The colors of the rock of a block's side.
    pub fn section_rock(&self) -> Tones {
        match self.colors {
            Colors::Desert => [[0.24, 0.10, 0.06], [0.42, 0.25, 0.15]],
            Colors::Clay => [[0.26, 0.23, 0.205], [0.29, 0.255, 0.225]],
            _ => [[0.135, 0.115, 0.098], [0.27, 0.235, 0.20]],
        }
    }

    /// The color of the soil above it, if there is any.
    pub fn section_soil(&self) -> Option<Light> {
        (self.colors != Colors::Clay).then_some(SOIL)
    }

    /// The color of a block's side at a position along it in cells, at a height and a depth below the ground in metres.
    /// `place` is the position on the land.
    pub fn section(&self, along: f64, place: [f64; 2], height: f32, depth: f32, thickness: f32) -> Light {
        // Level layers are bent a little.
        let wave = if self.bedding.is_empty() {
            let scale = f64::from(self.cell) / f64::from(thickness);
            self.grain.at(along * scale * 0.25, 0.7, 7).value
        } else {
            0.0
        };
        let height = self.above_bedding(place[0], place[1], height);
        let at = f64::from((height / thickness + 0.35 * wave) * 1.0);
        let bed = self.grain.at(at * 3.0, 0.41, 4).value + 0.5 * self.grain.at(at * 9.0, 3.3, 5).value;
        let rock = tone(self.section_rock(), (0.5 + 0.55 * bed).clamp(0.0, 1.0));
        let soil = self.section_soil().unwrap_or(rock);
        mix(soil, rock, step(0.015 * thickness, 0.05 * thickness, depth))
    }
}

/// The visibility of a wavelength for a pixel of this width: full from four pixels, zero below one and a half.
fn seen(wavelength: f32, footprint: f32) -> f32 {
    step(1.5, 4.0, wavelength / footprint)
}

/// Smoothstep from 0 at `from` to 1 at `to`; `from` may be the larger. Constant towards infinity.
fn step(from: f32, to: f32, x: f32) -> f32 {
    let t = ((x - from) / (to - from)).clamp(0.0, 1.0);
    if t.is_nan() { 0.0 } else { t * t * (3.0 - 2.0 * t) }
}

fn tone([dark, light]: Tones, share: f32) -> Light {
    mix(dark, light, share)
}

/// Albedo of ground without a height.
pub(super) fn no_height() -> Light {
    NO_DATA.map(|part| decode(part) * MISSING)
}

fn mix(from: Light, to: Light, share: f32) -> Light {
    let share = share.clamp(0.0, 1.0);
    std::array::from_fn(|c| from[c] + (to[c] - from[c]) * share)
}

/// The number, or 0 if it is not finite.
fn finite(number: f32) -> f32 {
    if number.is_finite() { number } else { 0.0 }
}

/// Whether each sample has no finite height; empty if all have one.
fn missing(heights: &Grid) -> Vec<bool> {
    match heights.data().iter().all(|height| height.is_finite()) {
        true => Vec::new(),
        false => heights.data().iter().map(|height| !height.is_finite()).collect(),
    }
}

/// Albedo and roughness of every sample; clay where a value is missing.
fn covered(cover: Option<[&Grid; 4]>, samples: usize) -> Vec<[f32; 4]> {
    match cover {
        Some(layers) => (0..samples).map(|at| layers.map(|layer| layer.data()[at])).collect(),
        None => Vec::new(),
    }
}

/// Slope, concavity and flow of every sample.
fn shape(land: &Land, relief: &Relief) -> Vec<[f32; 4]> {
    let [columns, rows] = relief.samples();
    let (bed, scale) = (relief.bed(), 1.0 / relief.exaggeration() as f32);
    let flows = land.flow.map(Grid::data);
    let area = (relief.cell() * relief.cell()) as f32;
    parallel::samples(rows * columns, |at| {
        let (i, j) = (at % columns, at / columns);
        let (west, east) = (i.saturating_sub(1), (i + 1).min(columns - 1));
        let (north, south) = (j.saturating_sub(1), (j + 1).min(rows - 1));
        let z = |i: usize, j: usize| bed[j * columns + i] * scale;
        let dx = (z(east, j) - z(west, j)) / (east - west) as f32;
        let dy = (z(i, south) - z(i, north)) / (south - north) as f32;
        // Over three cells along each axis: single samples would give spots.
        let (w, e) = (i.saturating_sub(3), (i + 3).min(columns - 1));
        let (n, s) = (j.saturating_sub(3), (j + 3).min(rows - 1));
        let around = (z(w, j) + z(e, j) + z(i, n) + z(i, s)) * 0.25 - z(i, j);
        let flow = flows.map_or(0.0, |flows| {
            let cells = (flows[at] / area).max(1.0);
            // 1 cell gives 0, a hundred thousand cells give 1.
            if cells.is_finite() { (libm::log2f(cells) / 16.6).min(1.0) } else { 0.0 }
        });
        [dx, dy, (around * 0.8).clamp(-1.0, 1.0), flow]
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use orogen_grid::grid::Window;

    /// A ramp that faces south, `rise` metres a metre, from 0 to 4000 m.
    fn ground(rise: f32, colors: Colors, snow_line: Option<f64>) -> GroundCover {
        let window = Window::new(5, 401, 10.0 / f64::from(rise));
        let data = (0..window.len()).map(|at| 4000.0 - 10.0 * (at / 5) as f32).collect();
        let heights = Grid::from_data(window, data).unwrap();
        let land = Land { heights: &heights, surface: None, flow: None, sea_level: None };
        GroundCover::new(
            &land,
            &Relief::new(&land, 1.0).unwrap(),
            &Dress { colors, palette: None, range: None, cover: None, bedding: None, snow_line },
        )
    }

    #[test]
    fn layers_of_rock_follow_the_bedding() {
        let window = Window::new(9, 9, 30.0);
        let heights = Grid::from_data(window, (0..window.len()).map(|at| 40.0 * at as f32).collect()).unwrap();
        let land = Land { heights: &heights, surface: None, flow: None, sea_level: None };
        let relief = Relief::new(&land, 1.0).unwrap();
        let bedding = Grid::from_data(window, (0..window.len()).map(|at| (at % 9) as f32 * 64.0).collect()).unwrap();
        for colors in [Colors::Natural, Colors::Desert] {
            let ground = |bedding: Option<&Grid>| {
                let dress = Dress { colors, palette: None, range: None, cover: None, bedding, snow_line: None };
                GroundCover::new(&land, &relief, &dress)
            };
            let [level, dipping] = [ground(None), ground(Some(&bedding))];
            let rock = |ground: &GroundCover, x: f64, height: f32| {
                ground.desert(&GroundPoint { x, y: 4.0, height, footprint: 1.0 }, [2.0, 0.0, 0.0, 0.0]).0
            };
            assert_eq!(rock(&dipping, 3.0, 1000.0), rock(&level, 3.0, 1000.0 - 192.0));
            assert_eq!(rock(&dipping, 3.5, 1000.0), rock(&level, 3.5, 1000.0 - 224.0));
            assert_eq!(dipping.above_bedding(0.0, 2.0, 70.0), 70.0);
        }
    }

    #[test]
    fn ground_without_a_height_is_grey_in_every_coloring() {
        let window = Window::new(9, 9, 30.0);
        let mut data: Vec<f32> = (0..window.len()).map(|at| 4000.0 - 10.0 * at as f32).collect();
        data[4 * 9 + 4] = f32::NAN;
        let heights = Grid::from_data(window, data).unwrap();
        let layer = Grid::filled(window, 0.3);
        let land = Land { heights: &heights, surface: None, flow: None, sea_level: None };
        let relief = Relief::new(&land, 1.0).unwrap();
        for colors in [Colors::Natural, Colors::Desert, Colors::Surfaces, Colors::Map, Colors::Clay] {
            let dress =
                Dress { colors, palette: None, range: None, cover: Some([&layer; 4]), bedding: None, snow_line: None };
            let ground = GroundCover::new(&land, &relief, &dress);
            let albedo = |x: f64, y: f64| ground.look(&GroundPoint { x, y, height: 3600.0, footprint: 1e6 }).albedo;
            let [red, green, blue] = albedo(4.3, 3.7);
            assert!(red == green && green == blue && (0.15..0.3).contains(&red), "{colors:?}: {red} {green} {blue}");
            let [red, green, blue] = albedo(5.6, 4.0);
            assert!((red, green) != (green, blue) || colors == Colors::Surfaces, "{colors:?}: {red} {green} {blue}");
        }
    }

    fn site(height: f32) -> GroundPoint {
        // From a distance at which no noise is visible.
        GroundPoint { x: 2.0, y: f64::from(4000.0 - height) / 10.0, height, footprint: 1e6 }
    }

    #[test]
    fn gentle_land_goes_from_green_to_white_and_steep_land_is_grey() {
        let gentle = ground(0.2, Colors::Natural, None);
        let [r, g, b] = gentle.look(&site(300.0)).albedo;
        assert!(g > r && g > b, "{r} {g} {b}");
        let [r, _, b] = gentle.look(&site(3900.0)).albedo;
        assert!(r > 0.7 && b > r, "snow");
        let cliff = ground(1.6, Colors::Natural, None).look(&site(3000.0));
        let [r, g, b] = cliff.albedo;
        assert!(r < 0.35 && (r - b).abs() < 0.08 && (r - g).abs() < 0.05, "rock: {r} {g} {b}");
        assert_eq!(cliff.slope[0], 0.0);
        assert!((cliff.slope[1] + 1.6).abs() < 1e-3);
    }

    #[test]
    fn the_snow_line_is_where_it_is_asked_for() {
        let white =
            |line: Option<f64>, height: f32| ground(0.2, Colors::Natural, line).look(&site(height)).albedo[0] > 0.6;
        assert!(white(Some(1000.0), 1600.0) && !white(Some(3000.0), 1600.0) && !white(Some(9000.0), 3990.0));
    }

    #[test]
    fn every_site_has_a_color() {
        for colors in [Colors::Natural, Colors::Desert, Colors::Map, Colors::Clay] {
            let ground = ground(0.5, colors, None);
            for k in 0..300u16 {
                let k = f64::from(k);
                let site =
                    GroundPoint { x: k % 5.0, y: k * 1.3, height: (k * 13.0) as f32, footprint: (k * 0.1) as f32 };
                let look = ground.look(&site);
                assert!(look.albedo.iter().all(|c| (0.0..=1.0).contains(c)), "{colors:?} {k}: {look:?}");
                assert!(look.slope.iter().all(|c| c.is_finite()));
                assert!(ground.section(k, [0.0; 2], 100.0, k as f32, 300.0).iter().all(|c| (0.0..=1.0).contains(c)));
            }
        }
    }
}
