//! The rivers and lakes of a picture, painted on its ground.

use orogen::export::features::options::FeatureOptions;
use orogen::export::features::source::FeatureSource;
use orogen::jobs::map_water;
use orogen::options::Options;
use orogen::recipe::Recipe;
use orogen::{Grid, Progress, Result, Window, World};

/// The least drainage area of a river, and the least area of a lake, as shares of the picture.
const LEAST: [f64; 2] = [1.5e-3, 5e-5];

/// Width of a river in metres, by the square root of its drainage area in square metres (hydraulic geometry).
const WIDTH: f64 = 2e-3;

/// The least width of a river, in samples and as a share of the picture's longer side.
const THIN: [f64; 2] = [1.1, 1.0 / 450.0];

/// The color of fresh water, sRGB.
const COLOR: [f32; 3] = [58.0, 118.0, 172.0];

/// How much of the ground is covered by water.
const COVER: f32 = 0.9;

/// A line of a river in metres, and its width in metres.
#[derive(Debug, Clone, PartialEq)]
struct River {
    points: Vec<[f64; 2]>,
    width: f64,
}

/// Rivers and lakes, in metres of the world.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Rivers {
    rivers: Vec<River>,
    /// The shores of lakes, with islands: closed lines.
    shores: Vec<Vec<[f64; 2]>>,
}

impl Rivers {
    /// Whether the land of a recipe has rivers and lakes. The depressions of bare noise are no lakes.
    #[must_use]
    pub fn are_in(recipe: &Recipe) -> bool {
        map_water::is_drained(recipe)
    }

    /// The rivers and lakes of heights; those of the recipe's own network, if it has one.
    ///
    /// # Errors
    /// If memory does not suffice, or the work was cancelled.
    pub fn of(world: &World, heights: &Grid, progress: &Progress) -> Result<Rivers> {
        let (window, given) = (*heights.window(), Options::default());
        let area = window.len() as f64 * window.cell * window.cell;
        let mut options = FeatureOptions::new(&given, world.recipe())?;
        (options.river, options.lake) = ((area * LEAST[0], 1), area * LEAST[1]);
        let source = if map_water::is_known(world.recipe(), &window) {
            FeatureSource::of(world, &window, &options, 0, progress)?
        } else {
            let sea_level = world.recipe().world.sea_level as f32;
            world.install(|| FeatureSource::from_heights(heights.clone(), sea_level, &window, &options, progress))?
        };
        let sample = source.cell() * source.cell();
        let rivers = source.rivers.iter().map(|river| River {
            points: river.points.iter().map(|[x, y, _]| source.place([*x, *y])).collect(),
            width: WIDTH * (river.drained.max(0.0) * sample).sqrt(),
        });
        let shores = source.lakes.iter().flat_map(|lake| source.parts(&lake.parts)).flatten();
        Ok(Rivers { rivers: rivers.collect(), shores: shores.collect() })
    }

    /// Paints them on the pixels of a window: red, green, blue and 255 for each sample.
    pub fn paint(&self, window: &Window, pixels: &mut [u8]) {
        let mut cover = vec![0.0_f32; window.len()];
        let sample =
            |[east, south]: [f64; 2]| [east / window.cell - window.x as f64, south / window.cell - window.y as f64];
        let thin = THIN[0].max(THIN[1] * window.width.max(window.height) as f64);
        for river in &self.rivers {
            let radius = (river.width / window.cell).max(thin) / 2.0;
            let points: Vec<[f64; 2]> = river.points.iter().map(|at| sample(*at)).collect();
            for ends in points.windows(2) {
                line(&mut cover, window, [ends[0], ends[1]], radius);
            }
        }
        let shores: Vec<Vec<[f64; 2]>> =
            self.shores.iter().map(|shore| shore.iter().map(|at| sample(*at)).collect()).collect();
        fill(&mut cover, window, &shores);
        for (pixel, cover) in pixels.chunks_exact_mut(4).zip(&cover).filter(|(_, cover)| **cover > 0.0) {
            for (channel, water) in pixel.iter_mut().zip(COLOR) {
                let ground = f32::from(*channel);
                *channel = (ground + (water - ground) * cover * COVER).round() as u8;
            }
        }
    }
}

/// Covers the samples along a line, with a soft edge of one sample.
fn line(cover: &mut [f32], window: &Window, [from, to]: [[f64; 2]; 2], radius: f64) {
    let reach = radius + 1.0;
    let range = |k: usize, count: usize| {
        let low = (from[k].min(to[k]) - reach).floor().max(0.0);
        let high = (from[k].max(to[k]) + reach).ceil().min(count as f64 - 1.0);
        (low <= high).then_some(low as usize..=high as usize)
    };
    let (Some(columns), Some(rows)) = (range(0, window.width), range(1, window.height)) else { return };
    let along = [to[0] - from[0], to[1] - from[1]];
    let length = (along[0] * along[0] + along[1] * along[1]).max(1e-12);
    for j in rows {
        for i in columns.clone() {
            let off = [i as f64 - from[0], j as f64 - from[1]];
            let share = ((off[0] * along[0] + off[1] * along[1]) / length).clamp(0.0, 1.0);
            let apart = libm::hypot(off[0] - share * along[0], off[1] - share * along[1]);
            let part = (radius + 0.5 - apart).clamp(0.0, 1.0) as f32;
            if let Some(own) = cover.get_mut(j * window.width + i) {
                *own = own.max(part);
            }
        }
    }
}

/// Covers the samples inside closed lines, by the even-odd rule.
fn fill(cover: &mut [f32], window: &Window, rings: &[Vec<[f64; 2]>]) {
    let mut crossings: Vec<Vec<f64>> = vec![Vec::new(); window.height];
    for ring in rings {
        for (a, b) in ring.iter().zip(ring.iter().cycle().skip(1)) {
            let (low, high) = (a[1].min(b[1]), a[1].max(b[1]));
            let first = low.ceil().max(0.0) as usize;
            let rows = crossings.iter_mut().enumerate().skip(first).take_while(|(j, _)| (*j as f64) < high);
            for (j, crossed) in rows {
                crossed.push(a[0] + (j as f64 - a[1]) / (b[1] - a[1]) * (b[0] - a[0]));
            }
        }
    }
    for (j, mut crossed) in crossings.into_iter().enumerate() {
        crossed.sort_by(f64::total_cmp);
        for ends in crossed.chunks_exact(2) {
            let columns =
                ends[0].ceil().max(0.0) as usize..(ends[1].floor() + 1.0).clamp(0.0, window.width as f64) as usize;
            for i in columns {
                if let Some(own) = cover.get_mut(j * window.width + i) {
                    *own = 1.0;
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use orogen::{Options as SessionOptions, Session, presets};

    const WINDOW: Window = Window { width: 40, height: 30, cell: 10.0, x: 5, y: 0 };

    fn painted(rivers: &Rivers) -> Vec<bool> {
        let mut pixels = [0, 0, 0, 255].repeat(1200);
        rivers.paint(&WINDOW, &mut pixels);
        pixels.chunks_exact(4).map(|pixel| pixel[2] > 60).collect()
    }

    #[test]
    fn lines_and_areas_are_where_they_are_in_the_world() {
        // A river along the row 10, and a lake with an island.
        let ring = |from: f64, to: f64| vec![[from, from], [to, from], [to, to], [from, to]];
        let river = River { points: vec![[0.0, 100.0], [1000.0, 100.0]], width: 5.0 };
        let rivers = Rivers { rivers: vec![river], shores: vec![ring(150.0, 250.0), ring(190.0, 210.0)] };
        let is_wet = painted(&rivers);
        let at = |east: usize, south: usize| is_wet[south / 10 * 40 + east / 10 - 5];
        assert!(at(60, 100) && at(400, 100) && !at(60, 80) && !at(60, 120));
        assert!(at(160, 160) && at(240, 240) && !at(200, 200) && !at(300, 200));
        assert!(!painted(&Rivers::default()).contains(&true));
    }

    #[test]
    fn land_that_is_drained_has_rivers_and_bare_noise_has_none() {
        let recipe = |name: &str| presets::find(name).unwrap().recipe().unwrap();
        assert!(!Rivers::are_in(&recipe("classic")) && Rivers::are_in(&recipe("hills")));
        let world = Session::new(SessionOptions::default()).unwrap().open(recipe("hills")).unwrap();
        let heights = world.window("height", &world.window_fitting(256).unwrap()).unwrap();
        let rivers = Rivers::of(&world, &heights, &Progress::none()).unwrap();
        assert!(rivers.rivers.len() > 5, "{}", rivers.rivers.len());
    }
}
