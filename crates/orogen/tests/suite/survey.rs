//! Measurements of terrain with known results.

use orogen::output::survey::page::{Title, draw};
use orogen::output::survey::real::{FIGURES, table};
use orogen::output::survey::{Land, Measures};
use orogen::{Grid, Window, World, presets};

fn grid(side: usize, cell: f64, f: impl Fn(f64, f64) -> f64) -> Grid {
    let window = Window::new(side, side, cell);
    let data = (0..side * side).map(|k| f(window.east(k % side), window.south(k / side)) as f32).collect();
    Grid::from_data(window, data).unwrap()
}

fn figure(measures: &Measures, key: &str) -> f64 {
    FIGURES.iter().find(|figure| figure.key == key).unwrap().value(measures).unwrap()
}

#[test]
fn a_plane_is_what_it_is() {
    // The land falls to the south-west at 45 degrees.
    let measures = Measures::of(&grid(128, 10.0, |x, y| (x - y) / 2f64.sqrt()), None).unwrap();
    assert!((figure(&measures, "slope_mean") - 45.0).abs() < 1e-3);
    assert!((figure(&measures, "hypsometric_integral") - 0.5).abs() < 1e-3);
    assert!(figure(&measures, "slope_spread") < 1e-4 && figure(&measures, "curvature") < 0.05);
    assert_eq!((measures.slopes.len(), measures.aspects.len()), (45, 36));
    assert!(measures.slopes[21] + measures.slopes[22] > 0.999);
    // 225 degrees is between two of the 10-degree bins.
    assert!(measures.aspects[22] + measures.aspects[23] > 0.999, "{:?}", measures.aspects);
    assert!((figure(&measures, "grid_bias") - 1.0).abs() < 1e-6);
    assert!((figure(&measures, "slopes") - 100.0).abs() < 1e-9 && figure(&measures, "depressions") == 0.0);
}

#[test]
fn the_sea_is_no_land() {
    let cone = grid(160, 10.0, |x, y| 500.0 - libm::hypot(x - 800.0, y - 800.0));
    let all = Measures::of(&cone, None).unwrap();
    let land = Measures::of(&cone, Some(0.0)).unwrap();
    assert!(land.land < all.land && land.heights[0] > 0.0 && all.heights[0] < -500.0);
    // A disc of 500 m.
    let share = std::f64::consts::PI * 500.0 * 500.0 / (1600.0 * 1600.0);
    assert!((land.land_share - share).abs() < 0.01, "{}", land.land_share);
    // The mean height of a cone is a third of its height.
    assert!((figure(&land, "hypsometric_integral") - 1.0 / 3.0).abs() < 0.02);
    assert!(Measures::of(&cone, Some(600.0)).is_none());
    assert!(Measures::of(&grid(63, 10.0, |x, _| x), None).is_none());
    assert!(Measures::of(&grid(90, 10.0, |_, _| 7.0), None).is_none());
}

#[test]
fn real_ranges_are_in_order_and_every_figure_can_be_had() {
    let world = World::open(presets::find("hills").unwrap().recipe().unwrap()).unwrap();
    let cell = world.recipe().world.cell;
    let heights = world.window("height", &Window::new(192, 160, cell)).unwrap();
    let measures = Measures::of(&heights, None).unwrap();
    for figure in FIGURES {
        let [low, middle, high] = figure.real;
        assert!(low < middle && middle < high, "{}", figure.key);
        assert_eq!(figure.place(middle), 0.0);
        assert!((figure.place(low) + 1.0).abs() < 1e-9 && (figure.place(high) - 1.0).abs() < 1e-9, "{}", figure.key);
        assert_eq!(figure.verdict(middle), "as real land");
    }
    let text = table(&measures);
    assert_eq!(text.lines().count(), FIGURES.len() + 3, "{text}");
    // The page is drawn with the same width for any terrain.
    for heights in
        [heights, grid(64, 1e-3, |x, y| x * y), grid(700, 5000.0, |x, y| libm::sin(x / 9000.0) * 500.0 + y / 1e4)]
    {
        let measures = Measures::of(&heights, None).unwrap();
        let page = draw(&Title::new("A").with_about("b"), &Land::in_memory(&heights, None), &measures).unwrap();
        assert_eq!(page.width(), 1500);
    }
}
