//! The rivers and lakes of a picture, painted on its ground.

use orogen::export::features::options::FeatureOptions;
use orogen::export::features::source::FeatureSource;
use orogen::io::palette::Rgb;
use orogen::jobs::map_water;
use orogen::options::Options;
use orogen::output::sheet::geometry::{Point, Size};
use orogen::output::sheet::raster::draw_over;
use orogen::output::sheet::scene::{Scene, Step};
use orogen::recipe::Recipe;
use orogen::{Grid, Progress, Result, Window, World};
use serde::{Deserialize, Serialize};

/// The least drainage area of a river, and the least area of a lake, as shares of the picture.
const LEAST: [f64; 2] = [1.5e-3, 5e-5];

/// Width of a river in metres, by the square root of its drainage area in square metres (hydraulic geometry).
const WIDTH: f64 = 2e-3;

/// The least width of a river, in samples and as a share of the picture's longer side.
const THIN: [f64; 2] = [1.1, 1.0 / 450.0];

/// The color of fresh water, sRGB.
const COLOR: Rgb = [58, 118, 172];

/// How much of the ground is covered by water.
const COVER: f32 = 0.9;

/// A line of a river in metres, and its width in metres.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
struct River {
    points: Vec<[f64; 2]>,
    width: f64,
}

/// Rivers and lakes, in metres of the world.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Rivers {
    rivers: Vec<River>,
    /// The parts of lakes: a shore and those of its islands, which are closed lines.
    lakes: Vec<Vec<Vec<[f64; 2]>>>,
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
        let lakes = source.lakes.iter().flat_map(|lake| source.parts(&lake.parts));
        Ok(Rivers { rivers: rivers.collect(), lakes: lakes.collect() })
    }

    /// Paints them on the pixels of a window: red, green, blue and 255 for each sample.
    pub fn paint(&self, window: &Window, pixels: &mut [u8]) {
        let at = |[east, south]: &[f64; 2]| {
            // Samples are at the centers of pixels.
            let place = |metres: f64, first: i64| (metres / window.cell - first as f64 + 0.5) as f32;
            Point { x: place(*east, window.x), y: place(*south, window.y) }
        };
        let size = Size { width: window.width as f32, height: window.height as f32 };
        let mut scene = Scene::new(size, "");
        for lake in &self.lakes {
            let ring = |ring: &Vec<[f64; 2]>| {
                let mut places = ring.iter().map(at);
                places.next().map(Step::Move).into_iter().chain(places.map(Step::Line)).collect::<Vec<Step>>()
            };
            scene.area(lake.iter().flat_map(ring).collect(), COLOR, COVER);
        }
        let thin = THIN[0].max(THIN[1] * window.width.max(window.height) as f64);
        for river in &self.rivers {
            let width = (river.width / window.cell).max(thin) as f32;
            scene.lines(vec![river.points.iter().map(at).collect()], width, COLOR, COVER);
        }
        let mut colors: Vec<u8> = pixels.as_chunks::<4>().0.iter().flat_map(|pixel| &pixel[..3]).copied().collect();
        draw_over(&scene, 1.0, Point::default(), 0, window.width, &mut colors);
        for (pixel, color) in pixels.as_chunks_mut::<4>().0.iter_mut().zip(colors.as_chunks::<3>().0) {
            pixel[..3].copy_from_slice(color);
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
        let ring = |from: f64, to: f64| vec![[from, from], [to, from], [to, to], [from, to], [from, from]];
        let island = ring(190.0, 210.0).into_iter().rev().collect();
        let river = River { points: vec![[0.0, 100.0], [1000.0, 100.0]], width: 5.0 };
        let rivers = Rivers { rivers: vec![river], lakes: vec![vec![ring(150.0, 250.0), island]] };
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
