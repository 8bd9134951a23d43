//! Pictures of the graphics card, compared with the processor's.
//!
//! With `OROGEN_RENDER_PICTURES` set to a folder, every pair is written there, side by side.

use orogen_gpu::gpu::Options;
use orogen_gpu::render::render;
use orogen_gpu::{Choice, Gpu};
use orogen_grid::grid::{Grid, Window};
use orogen_grid::progress::Progress;
use orogen_io::format::png::{self, Picture, Pixel};
use orogen_output::render::camera::{Camera, CameraSpec, View};
use orogen_output::render::device::{Painted, RenderDevice};
use orogen_output::render::relief::Land;
use orogen_output::render::scene::{Colors, Edge, Scene, Style};
use std::sync::OnceLock;
use std::time::Instant;

const SIZE: [usize; 2] = [320, 200];

/// Minimum similarity of two pictures of a scene.
const SIMILAR: f64 = 0.999;

/// Maximum mean difference of their bytes. A coefficient that only one of the two renderers has makes a difference
/// several times as large.
const DIFFERENT: f64 = 0.01;

const ALL: View = View::Around { azimuth: 200.0, elevation: 24.0, distance: None };

/// One card for all tests, so that its driver compiles the shader once.
fn gpu() -> Gpu {
    static CARD: OnceLock<Gpu> = OnceLock::new();
    CARD.get_or_init(opened).clone()
}

fn opened() -> Gpu {
    Gpu::open(&Options::new(Choice::Any)).unwrap()
}

/// Mountains, valleys and some cliffs, from -300 to about 2400 m.
fn height(x: f64, y: f64) -> f64 {
    let wave = |fx: f64, fy: f64, shift: f64| libm::sin(x * fx + y * fy + shift);
    let wide = 700.0 * wave(0.021, 0.013, 0.4) * wave(-0.011, 0.027, 1.9);
    let ridges = 420.0 * (1.0 - (wave(0.05, -0.04, 0.7) + 0.4 * wave(0.11, 0.09, 2.0)).abs());
    let rough = 60.0 * wave(0.31, 0.17, 0.0) * wave(-0.13, 0.41, 1.0) + 18.0 * wave(0.9, 0.7, 3.0);
    700.0 + wide + ridges + rough
}

fn cliffs(x: f64, y: f64) -> f64 {
    let high = height(x, y);
    (high / 240.0).floor() * 240.0 + 0.1 * (high % 240.0)
}

fn grid(window: Window, f: impl Fn(f64, f64) -> f64) -> Grid {
    let at = |k: usize| f((k % window.width) as f64, (k / window.width) as f64) as f32;
    Grid::from_data(window, (0..window.len()).map(at).collect()).unwrap()
}

fn window() -> Window {
    Window::new(260, 220, 30.0)
}

fn paint(scene: &Scene, camera: &Camera, size: [usize; 2]) -> Vec<u8> {
    let mut bytes = vec![0; 3 * size[0] * size[1]];
    scene.paint(camera, size, 0..size[1], &mut bytes, &Progress::none()).unwrap();
    bytes
}

/// The luminance of each pixel, as an sRGB byte value.
fn luminance(bytes: &[u8]) -> Vec<f64> {
    bytes
        .chunks_exact(3)
        .map(|p| 0.2126 * f64::from(p[0]) + 0.7152 * f64::from(p[1]) + 0.0722 * f64::from(p[2]))
        .collect()
}

/// The mean structural similarity of two pictures over all windows of 8 x 8 pixels, or over the whole picture if it is
/// smaller (Z. Wang, A. C. Bovik, H. R. Sheikh, E. P. Simoncelli, "Image quality assessment: from error visibility to
/// structural similarity", 2004).
fn ssim(one: &[f64], other: &[f64], [width, height]: [usize; 2]) -> f64 {
    let (c1, c2) = (0.01f64 * 255.0 * 0.01 * 255.0, 0.03f64 * 255.0 * 0.03 * 255.0);
    let [wide, high] = [width, height].map(|side| side.min(8));
    let count = (wide * high) as f64;
    let (mut sum, mut windows) = (0.0, 0.0);
    for j in 0..=height - high {
        for i in 0..=width - wide {
            let mut sums = [0.0; 5];
            for y in j..j + high {
                for x in i..i + wide {
                    let (a, b) = (one[y * width + x], other[y * width + x]);
                    sums.iter_mut().zip([a, b, a * a, b * b, a * b]).for_each(|(sum, part)| *sum += part);
                }
            }
            let [a, b, aa, bb, ab] = sums.map(|sum| sum / count);
            let (va, vb, cov) = (aa - a * a, bb - b * b, ab - a * b);
            sum += (2.0 * a * b + c1) * (2.0 * cov + c2) / ((a * a + b * b + c1) * (va + vb + c2));
            windows += 1.0;
        }
    }
    sum / windows
}

/// Writes both pictures side by side, if wanted.
fn show(name: &str, one: &[u8], other: &[u8], [width, height]: [usize; 2]) {
    let Ok(folder) = std::env::var("OROGEN_RENDER_PICTURES") else {
        return;
    };
    let rows = one.chunks_exact(3 * width).zip(other.chunks_exact(3 * width));
    let both: Vec<u8> = rows.flat_map(|(one, other)| [one, other].concat()).collect();
    let mut file = std::fs::File::create(format!("{folder}/{name}.png")).unwrap();
    let picture = Picture::new(2 * width, height, Pixel::Rgb8);
    png::write(&mut file, &picture, |rows, bytes| {
        bytes.copy_from_slice(&both[6 * width * rows.start..6 * width * rows.end]);
        Ok(())
    })
    .unwrap();
}

/// A scene and its camera.
struct Case<'a> {
    name: &'a str,
    land: Land<'a>,
    style: Style<'a>,
    view: View,
    fov: f64,
    size: [usize; 2],
}

impl<'a> Case<'a> {
    fn new(name: &'a str, heights: &'a Grid) -> Case<'a> {
        let land = Land { heights, surface: None, flow: None, sea_level: Some(-1000.0) };
        let mut style = Style::default();
        style.samples = 2;
        Case { name, land, style, view: ALL, fov: 40.0, size: SIZE }
    }

    fn styled(mut self, change: impl FnOnce(&mut Style<'a>)) -> Case<'a> {
        change(&mut self.style);
        self
    }

    fn watered(mut self, surface: Option<&'a Grid>, sea_level: f64) -> Case<'a> {
        self.land.surface = surface;
        self.land.sea_level = Some(sea_level);
        self
    }

    fn seen(mut self, view: View, fov: f64) -> Case<'a> {
        (self.view, self.fov) = (view, fov);
        self
    }

    fn sized(mut self, size: [usize; 2]) -> Case<'a> {
        self.size = size;
        self
    }

    fn scene(&self) -> (Scene, Camera) {
        let scene = Scene::new(&self.land, &self.style, &Progress::none()).unwrap();
        let camera = scene.camera(&CameraSpec::new(self.view, self.size).with_fov(self.fov));
        (scene, camera)
    }

    /// Compares the two pictures and returns the card's.
    fn check(&self, gpu: &Gpu) -> Vec<u8> {
        let (scene, camera) = self.scene();
        let expect = paint(&scene, &camera, self.size);
        let start = Instant::now();
        let got = render(gpu, &scene, &camera, self.size, 0..self.size[1], |_| false).unwrap().unwrap();
        let took = start.elapsed();
        show(self.name, &expect, &got, self.size);
        let similar = ssim(&luminance(&expect), &luminance(&got), self.size);
        let differences = expect.iter().zip(&got).map(|(a, b)| f64::from(a.abs_diff(*b)));
        let mean = differences.clone().sum::<f64>() / got.len() as f64;
        println!("{:>14}: SSIM {similar:.6}, mean difference {mean:.5}, {took:.2?}", self.name);
        assert!(similar >= SIMILAR && mean < DIFFERENT, "{}: SSIM {similar}, mean difference {mean}", self.name);
        got
    }
}

#[test]
fn suns_skies_and_surroundings() {
    let gpu = gpu();
    let (heights, steps) = (grid(window(), height), grid(window(), cliffs));
    let flow = grid(window(), |x, y| if (x - y).abs() < 3.0 { 3e7 } else { 900.0 });
    for case in [
        Case::new("high-sun", &heights).styled(|style| style.sun = [150.0, 65.0]),
        Case::new("low-sun", &heights).styled(|style| style.sun = [285.0, 5.0]),
        Case::new("dusk", &heights).styled(|style| style.sun = [285.0, -2.0]),
        Case::new("cliffs", &steps).styled(|style| style.exaggeration = 1.5),
        Case::new("mirrors", &heights)
            .styled(|style| (style.edge, style.sun) = (Some(Edge::Haze), [200.0, 18.0]))
            .seen(View::At { eye: [400.0, 6300.0, 1900.0], look: [4000.0, 1000.0] }, 70.0),
        Case::new("sun-disc", &heights)
            .styled(|style| (style.edge, style.sun) = (Some(Edge::Haze), [0.0, 8.0]))
            .seen(View::At { eye: [3900.0, 6300.0, 2600.0], look: [3900.0, 300.0] }, 60.0),
        Case { land: Land { flow: Some(&flow), ..Case::new("", &heights).land }, ..Case::new("rivers", &heights) },
        Case::new("from-above", &heights).seen(View::Around { azimuth: 10.0, elevation: 90.0, distance: None }, 40.0),
        Case::new("telescope", &heights)
            .seen(View::Around { azimuth: 120.0, elevation: 12.0, distance: Some(400_000.0) }, 1.5),
    ] {
        case.check(&gpu);
    }
}

#[test]
fn seas_and_lakes() {
    let gpu = gpu();
    let bowl = |x: f64, y: f64| {
        let away = libm::hypot((x - 130.0) / 130.0, (y - 110.0) / 110.0);
        height(x, y) - 2600.0 * away * away
    };
    let (heights, island) = (grid(window(), height), grid(window(), bowl));
    let lake = grid(window(), |x, y| if x < 150.0 { 640.0 } else { height(x, y) });
    for case in [
        Case::new("coast", &heights).watered(None, 500.0),
        Case::new("lake", &heights).watered(Some(&lake), 200.0),
        Case::new("island", &island).watered(None, 0.0).styled(|style| style.sun = [180.0, 24.0]),
        Case::new("shore", &island)
            .watered(None, 0.0)
            .styled(|style| (style.samples, style.sun) = (4, [20.0, 22.0]))
            .seen(View::At { eye: [3000.0, 9000.0, 60.0], look: [3900.0, 3300.0] }, 60.0),
        Case::new("flooded", &heights)
            .watered(None, 700.0)
            .styled(|style| (style.edge, style.sun) = (Some(Edge::Haze), [250.0, 25.0]))
            .seen(View::At { eye: [400.0, 6300.0, 900.0], look: [3000.0, 4200.0] }, 70.0),
    ] {
        case.check(&gpu);
    }
}

#[test]
fn grounds() {
    let gpu = gpu();
    let heights = grid(window(), height);
    let low = View::At { eye: [3000.0, 3600.0, 500.0], look: [3900.0, 2400.0] };
    let layers = [0.30, 0.22, 0.12, 0.6]
        .map(|base| grid(window(), |x, y| base * (0.7 + 0.3 * libm::sin(x * 0.1) * libm::cos(y * 0.13))));
    let viridis = orogen_io::palette::named::find("viridis").unwrap().palette();
    for case in [
        Case::new("near-ground", &heights).seen(low, 60.0).styled(|style| style.samples = 4),
        Case::new("desert", &heights).styled(|style| style.colors = Colors::Desert),
        Case::new("near-desert", &heights)
            .seen(low, 60.0)
            .styled(|style| (style.colors, style.samples) = (Colors::Desert, 4)),
        Case::new("map", &heights).watered(None, 300.0).styled(|style| style.colors = Colors::Map),
        Case::new("palette", &heights).styled(|style| (style.colors, style.palette) = (Colors::Map, Some(&viridis))),
        Case::new("clay", &heights).styled(|style| (style.colors, style.haze) = (Colors::Clay, 0.0)),
        Case::new("surfaces", &heights)
            .styled(|style| (style.colors, style.cover) = (Colors::Surfaces, Some(layers.each_ref()))),
        Case::new("snow", &heights).styled(|style| style.snow_line = Some(900.0)),
    ] {
        case.check(&gpu);
    }
}

#[test]
fn lands_far_out_look_the_same() {
    let gpu = gpu();
    let near = grid(window(), height);
    // 1 000 km east and south of the world's origin.
    let far = Grid::from_data(window().at(33_333, 33_333), near.data().to_vec()).unwrap();
    let [near, far] = [("near", &near, 0.0), ("far", &far, 33_333.0 * 30.0)].map(|(name, heights, off)| {
        let view = View::At { eye: [3000.0 + off, 3600.0 + off, 500.0], look: [3900.0 + off, 2400.0 + off] };
        Case::new(name, heights).seen(view, 60.0).check(&gpu)
    });
    assert!(ssim(&luminance(&near), &luminance(&far), SIZE) > 0.9999);
    // At the far end of a long world, from close up.
    let long = grid(Window::new(6000, 40, 30.0), |x, y| height(x - 5900.0, y));
    let view = View::At { eye: [179_000.0, 1100.0, 800.0], look: [179_500.0, 500.0] };
    Case::new("far-end", &long).seen(view, 60.0).check(&gpu);
}

#[test]
fn odd_sizes_and_senseless_lands() {
    let gpu = gpu();
    let heights = grid(window(), height);
    for size in [[1, 1], [37, 23], [1, 50], [333, 5]] {
        Case::new("odd", &heights).sized(size).check(&gpu);
    }
    let mut holes = heights.clone();
    for at in (0..holes.data().len()).step_by(37) {
        holes.data_mut()[at] = [f32::NAN, f32::INFINITY, f32::NEG_INFINITY][at % 3];
    }
    let small = |columns, rows| Window::new(columns, rows, 30.0);
    let lands = [
        ("holes", holes),
        ("patch", grid(small(2, 2), |_, _| 5.0)),
        ("flat", grid(small(40, 30), |_, _| 0.0)),
        ("strip", grid(small(3, 200), |x, y| x * y)),
    ];
    for (name, heights) in &lands {
        for edge in [Edge::Cut, Edge::Haze] {
            Case::new(name, heights).styled(|style| style.edge = Some(edge)).sized([120, 80]).check(&gpu);
        }
    }
}

#[test]
fn a_low_limit_gives_the_same_picture() {
    let gpu = opened();
    let heights = grid(Window::new(90, 70, 30.0), height);
    let case = Case::new("limited", &heights).sized([100, 60]);
    let (scene, camera) = case.scene();
    let draw = |gpu: &Gpu| render(gpu, &scene, &camera, case.size, 0..case.size[1], |_| false);
    let expect = draw(&gpu).unwrap().unwrap();
    let limited = |bytes: u64| Gpu::open(&Options::new(Choice::Any).with_buffer(bytes)).unwrap();
    // The scene, and room for seven rows.
    let scene_bytes: usize = 4 * scene.encode(&camera, case.size).samples();
    let bands = limited((scene_bytes + 7 * 12 * 100) as u64);
    assert!(draw(&bands).unwrap().unwrap() == expect);
    let error = draw(&limited(scene_bytes as u64)).unwrap_err().to_string();
    assert!(error.contains("a buffer has at most"), "{error}");
    // Only some rows.
    let rows = render(&gpu, &scene, &camera, case.size, 13..21, |_| false).unwrap().unwrap();
    assert!(rows == expect[3 * 100 * 13..3 * 100 * 21]);
    assert_eq!(gpu.shaders_compiled(), 1);
}

#[test]
fn the_light_of_the_sky_is_that_of_the_processor() {
    let gpu = gpu();
    for (name, [columns, rows]) in [("wide", [260, 220]), ("high", [90, 300]), ("two", [2, 2]), ("thin", [3, 200])] {
        let heights = grid(Window::new(columns, rows, 30.0), height);
        let case = Case::new(name, &heights).styled(|style| style.sun = [285.0, 4.0]);
        let (expect, camera) = case.scene();
        let lit = Scene::prepared(&case.land, &case.style, Some(&gpu), &Progress::none()).unwrap();
        let [one, other] = [&expect, &lit].map(|scene| {
            let data = scene.encode(&camera, SIZE);
            data.grids.into_iter().find(|(name, _)| *name == "SKYLIGHT").unwrap().1.concat()
        });
        let most = one.iter().copied().fold(0.0f32, f32::max);
        let off = one.iter().zip(&other).map(|(a, b)| (a - b).abs()).fold(0.0f32, f32::max);
        println!("{name:>14}: light off by at most {:.2e}", off / most);
        assert!(off <= 1e-3 * most && one != other, "{name}: {off} of {most}");
        let [one, other] = [&expect, &lit].map(|scene| luminance(&paint(scene, &camera, SIZE)));
        assert!(ssim(&one, &other, SIZE) > 0.999);
    }
}

#[test]
fn it_can_be_cancelled_and_lost() {
    let gpu = opened();
    let heights = grid(Window::new(90, 70, 30.0), height);
    let case = Case::new("cancelled", &heights).sized([64, 40]);
    let (scene, camera) = case.scene();
    let mut bytes = vec![0; 3 * 64 * 40];
    assert_eq!(render(&gpu, &scene, &camera, case.size, 0..40, |_| true), Ok(None));
    let progress = Progress::none();
    let painted = gpu.paint(&scene, &camera, case.size, 0..40, &mut bytes, &progress).unwrap();
    assert!(painted == Painted::Done && bytes.iter().any(|byte| *byte > 20));
    progress.cancel();
    assert!(gpu.paint(&scene, &camera, case.size, 0..40, &mut bytes, &progress).is_err());
    gpu.lose();
    let painted = gpu.paint(&scene, &camera, case.size, 0..40, &mut bytes, &Progress::none()).unwrap();
    assert!(matches!(painted, Painted::Refused(why) if why.contains("lost")));
}

#[test]
#[ignore = "long: a measurement"]
fn time_of_a_large_picture() {
    let gpu = gpu();
    let heights = grid(Window::new(1024, 1024, 10.0), |x, y| height(x * 0.3, y * 0.3));
    let case = Case::new("large", &heights).styled(|style| style.samples = 5).sized([1920, 1080]);
    let start = Instant::now();
    let (scene, camera) = case.scene();
    println!("{}: scene {:.2?}", gpu.adapter(), start.elapsed());
    for _ in 0..2 {
        let start = Instant::now();
        Scene::prepared(&case.land, &case.style, Some(&gpu), &Progress::none()).unwrap();
        println!("scene with the card {:.2?}", start.elapsed());
    }
    for _ in 0..2 {
        let start = Instant::now();
        let got = render(&gpu, &scene, &camera, case.size, 0..1080, |_| false).unwrap().unwrap();
        println!("card {:.2?}", start.elapsed());
        let start = Instant::now();
        let expect = paint(&scene, &camera, case.size);
        println!("processor {:.2?}", start.elapsed());
        println!("SSIM {:.5}", ssim(&luminance(&expect), &luminance(&got), case.size));
    }
}
