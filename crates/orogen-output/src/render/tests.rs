//! Pictures of terrain with known results.

use super::camera::{CameraSpec, View};
use super::relief::Land;
use super::scene::{Colors, Edge, Scene, Style};
use orogen_grid::grid::{Grid, Window};
use orogen_grid::progress::Progress;

const SIZE: [usize; 2] = [64, 36];

fn grid(columns: usize, rows: usize, f: impl Fn(f64, f64) -> f64) -> Grid {
    let window = Window::new(columns, rows, 10.0);
    let data = (0..window.len()).map(|at| f((at % columns) as f64, (at / columns) as f64) as f32).collect();
    Grid::from_data(window, data).unwrap()
}

fn land(heights: &Grid, sea_level: f64) -> Land<'_> {
    Land { heights, surface: None, flow: None, sea_level: Some(sea_level) }
}

fn paint(land: &Land, style: &Style, view: &View, fov: f64) -> Vec<u8> {
    let scene = Scene::new(land, style, &Progress::none()).unwrap();
    let camera = scene.camera(&CameraSpec::new(*view, SIZE).with_fov(fov));
    let mut bytes = vec![0; SIZE[0] * SIZE[1] * 3];
    scene.paint(&camera, SIZE, 0..SIZE[1], &mut bytes, &Progress::none()).unwrap();
    bytes
}

const AROUND: View = View::Around { azimuth: 200.0, elevation: 30.0, distance: None };

fn pixel(bytes: &[u8], i: usize, j: usize) -> [i32; 3] {
    [0, 1, 2].map(|c| i32::from(bytes[3 * (j * SIZE[0] + i) + c]))
}

fn brightness(pixel: [i32; 3]) -> i32 {
    pixel.iter().sum()
}

fn hills() -> Grid {
    grid(90, 70, |x, y| 200.0 + 120.0 * libm::sin(x * 0.13) * libm::cos(y * 0.17) + 30.0 * libm::sin(x * y * 0.01))
}

#[test]
fn threads_and_bands_change_nothing() {
    let heights = hills();
    let land = land(&heights, 150.0);
    let style = Style { samples: 2, ..Style::default() };
    let whole = paint(&land, &style, &AROUND, 40.0);
    let one = rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap();
    assert!(one.install(|| paint(&land, &style, &AROUND, 40.0)) == whole);
    let scene = Scene::new(&land, &style, &Progress::none()).unwrap();
    let camera = scene.camera(&CameraSpec::new(AROUND, SIZE));
    let mut rows = vec![0; 3 * SIZE[0] * 7];
    scene.paint(&camera, SIZE, 11..18, &mut rows, &Progress::none()).unwrap();
    assert!(rows == whole[3 * SIZE[0] * 11..3 * SIZE[0] * 18]);
}

#[test]
fn the_picture_is_the_one_it_always_was() {
    use sha2::{Digest, Sha256};
    let heights = hills();
    let surface = grid(90, 70, |x, y| if (30.0..50.0).contains(&x) && y > 40.0 { 230.0 } else { 0.0 });
    let land = Land { surface: Some(&surface), flow: Some(&surface), ..land(&heights, 150.0) };
    let mut hash = Sha256::new();
    for colors in [Colors::Natural, Colors::Desert, Colors::Map, Colors::Clay] {
        for edge in [Edge::Cut, Edge::Haze] {
            let style = Style { samples: 2, colors, edge: Some(edge), ..Style::default() };
            hash.update(paint(&land, &style, &AROUND, 40.0));
        }
    }
    let hash: String = hash.finalize().iter().take(8).map(|byte| format!("{byte:02x}")).collect();
    // Update this hash if pictures are meant to change.
    assert_eq!(hash, "072134ea89c2dc3b");
}

#[test]
fn senseless_lands_have_a_picture() {
    let mut holes = hills();
    for at in (0..holes.data().len()).step_by(11) {
        holes.data_mut()[at] = [f32::NAN, f32::INFINITY, f32::NEG_INFINITY][at % 3];
    }
    let lands = [
        grid(2, 2, |_, _| 5.0),
        grid(40, 30, |_, _| -3000.0),
        grid(40, 30, |_, _| 0.0),
        holes,
        grid(3, 200, |x, y| x * y),
    ];
    for heights in &lands {
        for edge in [None, Some(Edge::Cut), Some(Edge::Haze)] {
            for sun in [[0.0, 90.0], [123.0, -6.0], [290.0, 0.0]] {
                let style = Style { samples: 1, edge, sun, exaggeration: 3.0, ..Style::default() };
                let scene = Scene::new(&land(heights, 0.0), &style, &Progress::none()).unwrap();
                for view in [AROUND, View::Around { azimuth: 0.0, elevation: 90.0, distance: Some(1.0) }] {
                    let camera = scene.camera(&CameraSpec::new(view, [16, 9]).with_fov(60.0));
                    let mut bytes = vec![0; 16 * 9 * 3];
                    scene.paint(&camera, [16, 9], 0..9, &mut bytes, &Progress::none()).unwrap();
                    assert!(sun[1] < 40.0 || bytes.iter().any(|byte| *byte > 20));
                }
            }
        }
    }
}

#[test]
fn the_horizon_lies_where_the_eye_is_level() {
    // Level ground without bounds; the camera is 14 m high and looks down by 14 in 100.
    let heights = grid(20, 20, |_, _| 0.0);
    let view = View::At { eye: [100.0, 190.0, 14.0], look: [100.0, 90.0] };
    let style = Style { samples: 1, colors: Colors::Clay, haze: 0.0, edge: Some(Edge::Haze), ..Style::default() };
    let bytes = paint(&land(&heights, -100.0), &style, &view, 60.0);
    // Half the picture's height is 36/64 of half its width, which corresponds to the tangent of 30 degrees.
    let half = libm::tan(30f64.to_radians()) * SIZE[1] as f64 / SIZE[0] as f64;
    let expect = (0.5 - 0.5 * 0.14 / half) * SIZE[1] as f64;
    let blue = |j: usize| pixel(&bytes, 32, j)[2] - pixel(&bytes, 32, j)[0];
    let line = (0..SIZE[1]).find(|j| blue(*j) < 0).unwrap();
    assert!((line as f64 - expect).abs() <= 1.5, "{line} {expect}");
    assert!((line..SIZE[1]).all(|j| blue(j) < 0), "nothing but ground below");
}

#[test]
fn a_wall_throws_its_shadow_away_from_the_sun() {
    // A wall 80 m high runs north to south at x = 400 m; the sun is in the west at 45 degrees: the ground is dark for
    // 80 m to the east.
    let heights = grid(81, 41, |x, _| if x == 40.0 { 80.0 } else { 0.0 });
    let style = Style {
        samples: 1,
        colors: Colors::Clay,
        haze: 0.0,
        edge: Some(Edge::Cut),
        sun: [270.0, 45.0],
        ..Style::default()
    };
    let scene = Scene::new(&land(&heights, -10.0), &style, &Progress::none()).unwrap();
    let view = View::Around { azimuth: 180.0, elevation: 90.0, distance: Some(4000.0) };
    let camera = scene.camera(&CameraSpec::new(view, SIZE).with_fov(14.0));
    let bytes = paint(&land(&heights, -10.0), &style, &view, 14.0);
    let light = |x: f64| {
        let at = camera.project(super::vector::Vector::new(x, 20.0, 0.0)).unwrap();
        let [i, j] = [0, 1].map(|axis| (0.5 * (at[axis] + 1.0) * SIZE[axis] as f64) as usize);
        brightness(pixel(&bytes, i, j))
    };
    let (lit, shaded) = (light(30.0), light(44.0));
    assert!(lit > shaded + 150, "{lit} {shaded}");
    assert!((light(46.0) - shaded).abs() < 40 && (light(51.0) - lit).abs() < 40, "{} {}", light(46.0), light(51.0));
}

#[test]
fn still_water_mirrors_the_mountain_behind_it() {
    // A white mountain in the north, the sea in front of it: from just above the water, the camera sees the mountain
    // and its reflection.
    let mountain = |top: f64| grid(60, 60, move |_, y| if y < 30.0 { top * (30.0 - y) / 30.0 } else { -40.0 });
    let style = Style {
        samples: 2,
        haze: 0.0,
        edge: Some(Edge::Haze),
        sun: [180.0, 35.0],
        snow_line: Some(-100.0),
        ..Style::default()
    };
    let view = View::At { eye: [300.0, 585.0, 12.0], look: [300.0, 330.0] };
    let [with, without] = [240.0, 0.5].map(|top| paint(&land(&mountain(top), 0.0), &style, &view, 50.0));
    // As far below the shore as the mountain is above the shore.
    let shore = |bytes: &[u8], j: usize| (20..44).map(|i| brightness(pixel(bytes, i, j))).sum::<i32>() / 24;
    let (near, far) = (shore(&with, 24), shore(&without, 24));
    assert!((near - far).abs() > 25, "{near} {far}");
}

#[test]
fn the_camera_sees_the_land_from_where_it_stands() {
    // One corner of the land is a peak: seen from the south it is far away on the right, from the north near on the
    // left.
    let heights = grid(40, 40, |x, y| if x > 30.0 && y < 9.0 { 300.0 } else { 0.0 });
    let style = Style { samples: 1, colors: Colors::Clay, haze: 0.0, sun: [180.0, 50.0], ..Style::default() };
    let scene = Scene::new(&land(&heights, -10.0), &style, &Progress::none()).unwrap();
    for (azimuth, right) in [(180.0, true), (0.0, false)] {
        let view = View::Around { azimuth, elevation: 35.0, distance: None };
        let camera = scene.camera(&CameraSpec::new(view, SIZE));
        let peak = camera.project(super::vector::Vector::new(35.0, 4.0, 30.0)).unwrap();
        assert_eq!(peak[0] > 0.0, right);
        let hit = scene.relief().hit(&camera.ray(0.5 * (peak[0] + 1.0), 0.5 * (peak[1] + 1.0)), 0.0).unwrap();
        assert!(hit.distance > 0.0);
    }
}

#[test]
fn work_that_is_cancelled_stops() {
    let heights = hills();
    let progress = Progress::none();
    let scene = Scene::new(&land(&heights, 0.0), &Style::default(), &progress).unwrap();
    progress.cancel();
    let camera = scene.camera(&CameraSpec::new(AROUND, SIZE));
    let mut bytes = vec![0; SIZE[0] * SIZE[1] * 3];
    assert!(scene.paint(&camera, SIZE, 0..SIZE[1], &mut bytes, &progress).is_err());
    assert!(Scene::new(&land(&heights, 0.0), &Style::default(), &progress).is_err());
}

#[test]
fn a_shallow_lake_is_one_water_and_not_a_marsh() {
    // Water of two to eight metres over a bumpy bed, with cells wider than the bumps are high, at an angle where the
    // bed must not be visible in spots.
    let heights = grid(90, 70, |x, y| 95.0 + 3.0 * libm::sin(x * 0.9) * libm::cos(y * 0.7));
    let wide = |grid: &Grid| Grid::from_data(Window::new(90, 70, 60.0), grid.data().to_vec()).unwrap();
    let (heights, surface) = (wide(&heights), wide(&grid(90, 70, |_, _| 100.0)));
    let land = Land { surface: Some(&surface), ..land(&heights, 0.0) };
    let bytes = paint(&land, &Style { haze: 0.0, ..Style::default() }, &AROUND, 20.0);
    let middle = |j: usize| (SIZE[0] / 3..2 * SIZE[0] / 3).map(move |i| [i, j]);
    let mut bright: Vec<i32> =
        (15..22).flat_map(middle).map(|[i, j]| brightness(pixel(&bytes, i, j))).collect::<Vec<i32>>();
    bright.sort_unstable();
    let [low, half, high] = [5, 50, 95].map(|share| bright[bright.len() * share / 100]);
    // A visible bed makes three times the difference.
    assert!(high - low < half / 8, "{low} {half} {high}");
}
