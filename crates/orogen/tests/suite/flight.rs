//! Flights over the preset `endless`: successive views show the same land, and views of the next level nearly the same.

use orogen::grid::resample::{self, LayerKind};
use orogen::{Grid, Options, Points, Progress, Session, Window, World, presets};

/// The layers of a view.
const LAYERS: [&str; 3] = ["height", "flow", "receiver"];

fn endless() -> World {
    let session = Session::new(Options { threads: Some(2), ..Options::default() }).unwrap();
    session.open(presets::find("endless").unwrap().recipe().unwrap()).unwrap()
}

/// A straight flight: square views, each one step further than the previous one.
#[derive(Debug)]
struct Flight {
    cell: f64,
    /// Samples along the sides of a view.
    side: usize,
    /// First sample of the first view.
    start: [i64; 2],
    /// Step from one view to the next, in samples.
    step: [i64; 2],
    kilometres: f64,
}

impl Flight {
    fn views(&self) -> impl Iterator<Item = Window> + use<> {
        let Flight { cell, side, start: [x, y], step: [east, south], kilometres } = *self;
        let metres = cell * ((east * east + south * south) as f64).sqrt();
        let count = (kilometres * 1000.0 / metres).ceil() as i64;
        (0..=count).map(move |k| Window::new(side, side, cell).at(x + k * east, y + k * south))
    }

    /// Makes the views alternately in two sessions, so that successive views share nothing, and compares them where
    /// they overlap. Returns the number of views and of samples that were compared.
    fn run(&self) -> (usize, usize) {
        let worlds = [endless(), endless()];
        let mut last: Option<Vec<Grid>> = None;
        let (mut views, mut compared) = (0, 0);
        for view in self.views() {
            let made = worlds[views % 2].grids(&LAYERS, &view, &Progress::none()).unwrap();
            for (layer, (one, other)) in LAYERS.iter().zip(last.iter().flatten().zip(&made)) {
                let overlap = one.window().intersection(&view);
                let [one, other] = [one, other].map(|grid| grid.crop(&overlap).unwrap());
                let same = one.data().iter().zip(other.data()).all(|(a, b)| a.to_bits() == b.to_bits());
                assert!(
                    same && !overlap.is_empty(),
                    "{layer} of view {views} differs from the view before: {overlap:?}"
                );
                compared += overlap.len();
            }
            views += 1;
            last = Some(made);
        }
        println!("{self:?}: {views} views, {compared} samples in two views");
        (views, compared)
    }
}

/// The difference between a level and the next finer one at their common samples.
#[derive(Debug)]
struct Change {
    cell: f64,
    /// Root of the mean squared difference of heights, in metres.
    rms: f64,
    /// Mean of the differences between the highest and the lowest sample of a view, in metres.
    relief: f64,
}

/// Zooms in at positions, from level to level: every view has half the width of the previous one.
fn zoom(cells: impl Iterator<Item = f64>, side: usize, places: &[[f64; 2]]) -> Vec<Change> {
    let world = endless();
    let mut changes = Vec::new();
    for cell in cells {
        let (mut squares, mut samples, mut relief) = (0.0, 0, 0.0);
        for place in places {
            let [x, y] = place.map(|metres| (metres / (2.0 * cell)).round() as i64 - side as i64 / 2);
            let coarse = Window::new(side, side, 2.0 * cell).at(x, y);
            // The middle of the coarse view.
            let fine = Window::new(side, side, cell).at(2 * x + side as i64 / 2, 2 * y + side as i64 / 2);
            let [coarse, fine] = [coarse, fine].map(|view| world.window("height", &view).unwrap());
            for (i, j) in (0..side / 2).flat_map(|j| (0..side / 2).map(move |i| (i, j))) {
                let difference = f64::from(coarse[(side / 4 + i, side / 4 + j)] - fine[(2 * i, 2 * j)]);
                squares += difference * difference;
                samples += 1;
            }
            let [low, high] = [f32::min, f32::max].map(|of| fine.data().iter().copied().reduce(of).unwrap());
            relief += f64::from(high - low) / places.len() as f64;
        }
        changes.push(Change { cell, rms: (squares / samples as f64).sqrt(), relief });
    }
    changes
}

/// The largest difference of the finest levels from the next finer one, in metres: the bounds of docs/resolution.md for
/// 2, 4 and 8 times the finest cell.
const FINEST: [f64; 3] = [18.0, 48.0, 104.0];

/// The largest difference of the levels above, as a share of the relief of a view.
const COARSE: f64 = 0.06;

fn zoom_without_a_pop(count: usize, side: usize) {
    let places: Vec<[f64; 2]> =
        (0..count).map(|k| [1e6 * k as f64 / count as f64, 3.3e5 * k as f64 / count as f64]).collect();
    let cells = (0..8).map(|halvings| 60.0 * f64::from(1 << halvings));
    for (k, Change { cell, rms, relief }) in zoom(cells, side, &places).into_iter().enumerate() {
        println!("{} m to {cell} m: {rms:.2} m, {:.2} % of {relief:.0} m", 2.0 * cell, 100.0 * rms / relief);
        let most = FINEST.get(k).copied().unwrap_or(COARSE * relief);
        assert!(rms <= most, "{cell} m: {rms} m of {relief} m, at most {most} m");
    }
}

#[test]
fn views_of_a_flight_agree() {
    let over = Flight { cell: 480.0, side: 100, start: [-40, -60], step: [50, 17], kilometres: 250.0 };
    assert!(over.run().0 > 9);
    let low = Flight { cell: 60.0, side: 100, start: [-40, -60], step: [75, -25], kilometres: 20.0 };
    assert!(low.run().0 > 4);
}

#[test]
fn zooms_change_little_from_level_to_level() {
    zoom_without_a_pop(3, 64);
}

#[test]
#[ignore = "long: 1000 km at 60 m and at 480 m, and zooms at 40 places"]
fn a_thousand_kilometres_without_a_pop() {
    let (views, compared) =
        Flight { cell: 60.0, side: 300, start: [-150, -150], step: [150, 50], kilometres: 1000.0 }.run();
    assert!(views > 100 && compared > 10_000_000);
    let (views, compared) =
        Flight { cell: 480.0, side: 300, start: [-150, -150], step: [75, 25], kilometres: 1000.0 }.run();
    assert!(views > 25 && compared > 4_000_000);
    zoom_without_a_pop(40, 128);
}

/// Between two levels, a zoom shows the finer one; below the finest level, it shows that level interpolated.
#[test]
fn views_between_two_levels_show_the_finer() {
    let world = endless();
    for (cell, finer) in [(0.7, 0.9375), (7.3, 3.75), (29.0, 15.0), (61.0, 60.0), (85.0, 60.0), (119.0, 60.0)] {
        let first = |metres: f64| (metres / cell) as i64 + 1;
        let view = Window::new(40, 35, cell).at(first(10.0 * 60.0), first(330.0 * 60.0));
        let start = |metres: f64| (metres / finer) as i64 - 4;
        let side = (40.0 * cell / finer) as usize + 10;
        let around = Window::new(side, side, finer).at(start(view.east(0)), start(view.south(0)));
        let level = world.window("height", &around).unwrap();
        let mut expect = vec![0.0; view.len()];
        let (xs, ys) = (view.eastings(), view.southings());
        resample::read(&level, LayerKind::Height, &Points::Lattice { xs: &xs, ys: &ys }, &mut expect);
        assert_eq!(world.window("height", &view).unwrap().data(), expect, "{cell} m");
    }
}
