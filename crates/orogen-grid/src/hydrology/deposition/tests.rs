use super::*;
use crate::checks::never;
use crate::grid::Window;
use crate::hydrology::accumulation::accumulate;
use crate::hydrology::direction::DISTANCES;
use crate::hydrology::erosion::{Erosion, ErosionRun};
use crate::hydrology::steepest::Descent;
use crate::hydrology::{drainage, samples};
use crate::progress::Progress;

fn law() -> StreamPower {
    StreamPower { erodibility: 2e-5, uplift: 1e-3, max_slope: 0.7, ..StreamPower::default() }
}

fn run_on(heights: &Grid, erosion: Erosion, sea: Option<f32>) -> (Grid, Deposits) {
    let mut out = heights.clone();
    let substrate = Substrate::default();
    let mut run = ErosionRun::new(erosion, heights, &substrate, sea);
    for _ in 0..erosion.steps {
        run.step(&mut out, &Progress::none()).unwrap();
    }
    (out, run.deposits().unwrap().clone())
}

/// Ten steps of 10 000 years, with the deposition coefficient `g`.
fn erosion(g: f64) -> Erosion {
    Erosion { scattered: Some(1), deposition: g, ..Erosion::new(law(), 1e5, 10) }
}

/// Hills of 600 m with depressions, on cells of 100 m.
fn hills(seed: i64) -> Grid {
    let heights = samples::hills(90, 70, seed);
    Grid::from_data(Window { cell: 100.0, ..*heights.window() }, heights.into_data()).unwrap()
}

#[test]
fn what_is_eroded_is_laid_or_leaves() {
    for (n, jitter, sea) in [(1.0, 0.0, None), (1.0, 1.0, Some(150.0)), (1.6, 0.0, Some(150.0)), (0.7, 1.0, None)] {
        for g in [0.2, 1.0, 10.0] {
            let heights = hills(3);
            let law = StreamPower { slope_exponent: n, ..law() };
            let erosion = Erosion { law, jitter, ..erosion(g) };
            let (out, deposits) = run_on(&heights, erosion, sea);
            let SedimentBalance { eroded, laid, left } = deposits.balance;
            assert!(laid > 0.0 && left > 0.0 && left < eroded);
            assert!((eroded - laid - left).abs() < 1e-6 * eroded, "{n} {g}: {eroded} - {laid} - {left}");
            // The same from the heights alone: what uplift has added and is not there any more.
            let outlets = Outlets::new(&heights, sea);
            let lost: f64 = (0..heights.data().len())
                .filter(|c| !outlets.at(*c))
                .map(|c| f64::from(heights.data()[c]) + 100.0 - f64::from(out.data()[c]))
                .sum();
            assert!((lost * 1e4 - left).abs() < 1e-5 * eroded, "{n} {g}: {} and {left}", lost * 1e4);
        }
    }
}

#[test]
fn a_catchment_loses_what_its_river_carries_out() {
    let heights = hills(5);
    let outlets = Outlets::new(&heights, Some(150.0));
    let drainage = drainage::route_carving(&heights, &outlets, Descent::Steepest);
    let drained = accumulate(&drainage.receivers);
    let mut out = heights.clone();
    let mut deposits = Deposits::new(&outlets, 2.0);
    let law = StreamPower { uplift: 0.0, ..law() };
    let Ok(()) = deposits.step(&law, &mut out, &outlets, &drainage, &drained, &Substrate::default(), 1e4, &never);
    let mut lost = vec![0.0; heights.data().len()];
    for c in 0..heights.data().len() {
        let mut end = c;
        while drainage.receivers.of(end) != end {
            end = drainage.receivers.of(end);
        }
        lost[end] += f64::from(heights.data()[c]) - f64::from(out.data()[c]);
    }
    let mut large = 0;
    for (c, lost) in lost.iter().enumerate().filter(|(c, _)| outlets.at(*c)) {
        // Sediment may be spread over a divide, and is then missing on one side only within this distance.
        if drained.area.data()[c] > 100 && deposits.flux[c] > 10.0 {
            large += 1;
            assert!((lost - deposits.flux[c]).abs() < 0.02 * deposits.flux[c], "{lost}, not {}", deposits.flux[c]);
        }
    }
    assert!(large > 5, "{large}");
}

#[test]
fn rivers_in_balance_are_steeper_by_the_deposition() {
    // With uniform uplift Q / A = U, so S = (U (1 + G) / K)^(1/n) A^(-m/n) (Yuan and others 2019).
    for (n, m, g) in [(1.0, 0.45, 1.0), (1.0, 0.45, 5.0), (2.0, 0.9, 1.0), (0.8, 0.4, 0.5)] {
        let window = Window::new(60, 3, 100.0);
        let mut receivers = Receivers::none(window);
        receivers.codes_mut()[61..119].fill(0);
        let mut heights = Grid::filled(window, 0.0);
        let outlets = Outlets::new(&heights, None);
        let drained = accumulate(&receivers);
        let basins = Basins { labels: vec![OUTSIDE; 180], spills: Vec::new(), order: Vec::new() };
        let drainage = Drainage { receivers, basins };
        let law = StreamPower {
            area_exponent: m,
            slope_exponent: n,
            max_slope: 1e9,
            min_slope: 0.0,
            ..StreamPower::default()
        };
        let mut deposits = Deposits::new(&outlets, g);
        for _ in 0..900 {
            let Ok(()) =
                deposits.step(&law, &mut heights, &outlets, &drainage, &drained, &Substrate::default(), 1e5, &never);
        }
        for c in 61..118 {
            let slope = f64::from(heights.data()[c] - heights.data()[c + 1]) / 100.0;
            let area = f64::from(drained.area.data()[c]) * 1e4;
            let expect = libm::pow((1.0 + g) * law.uplift / law.erodibility, 1.0 / n) * libm::pow(area, -m / n);
            assert!((slope / expect - 1.0).abs() < 5e-3, "n {n}, G {g}, cell {c}: {slope}, not {expect}");
        }
    }
}

#[test]
fn any_number_of_threads_makes_the_same() {
    // More rows than a band has.
    let heights = samples::hills(150, 400, 3);
    let run = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| {
            let (out, deposits) = run_on(&heights, Erosion { jitter: 1.0, steps: 4, ..erosion(2.0) }, Some(100.0));
            (out, deposits.thickness, deposits.balance)
        })
    };
    let one = run(1);
    assert!([2, 3, 8].map(run).iter().all(|other| *other == one));
}

#[test]
fn a_closed_basin_gets_a_level_floor() {
    // A bowl of 4 km with a hill beside it, which drains into it, within high walls.
    let window = Window::new(60, 60, 100.0);
    let mut heights = Grid::filled(window, 1000.0);
    for j in 1..59 {
        for i in 1..59 {
            let (x, y) = (i as f64 - 29.5, j as f64 - 29.5);
            let rough = (crate::hydrology::direction::hashed(i as i64, j as i64) >> 28) as f64;
            heights.row_mut(j)[i] = (300.0 + 15.0 * (x * x + y * y).sqrt() + rough) as f32;
        }
    }
    let law = StreamPower { uplift: 0.0, erodibility: 1e-5, ..law() };
    let (out, deposits) = run_on(&heights, Erosion { law, ..erosion(1.0) }, None);
    assert_eq!(deposits.balance.left, 0.0, "nothing leaves before it is full");
    let lowest = out.data().iter().copied().fold(f32::INFINITY, f32::min);
    let floor = out.data().iter().filter(|h| **h == lowest).count();
    assert!(lowest > 305.0 && floor > 20, "{floor} cells at {lowest}");
    let substrate = Substrate::default();
    let mut run = ErosionRun::new(Erosion { law, ..erosion(1.0) }, &heights, &substrate, None);
    run.step(&mut heights.clone(), &Progress::none()).unwrap();
    let mut settled = out.clone();
    run.settle(&mut settled, &Progress::none()).unwrap();
    let furthest = settled.data().iter().zip(out.data()).map(|(a, b)| (a - b).abs()).fold(0.0, f32::max);
    assert!(furthest < 0.1, "a closed basin stays as it is: {furthest}");
}

#[test]
fn fans_are_concave_and_lie_before_mountains() {
    // Mountains in the north rise above a plain that the border limits in the south.
    let window = Window::new(160, 120, 200.0);
    let mut heights = Grid::filled(window, 0.0);
    let mut uplift = Grid::filled(window, 0.0);
    for j in 1..119 {
        for i in 1..159 {
            heights.row_mut(j)[i] = (crate::hydrology::direction::hashed(i as i64, j as i64) >> 24) as f32 / 50.0;
        }
        uplift.row_mut(j).fill(if j < 60 { 1.0 } else { 0.0 });
    }
    let law = StreamPower { uplift: 3e-4, erodibility: 2e-5, max_slope: 0.67, ..StreamPower::default() };
    let erosion = Erosion { jitter: 1.0, deposition: 8.0, scattered: Some(1), ..Erosion::new(law, 2e6, 200) };
    let substrate = Substrate::default().with_uplift_factor(Some(&uplift));
    let mut run = ErosionRun::new(erosion, &heights, &substrate, None);
    let mut out = heights.clone();
    for _ in 0..erosion.steps {
        run.step(&mut out, &Progress::none()).unwrap();
    }
    let mean = |j: usize| (30..130).map(|i| f64::from(out[(i, j)])).sum::<f64>() / 100.0;
    let slopes: Vec<f64> = [62, 68, 74, 80].iter().map(|j| (mean(*j) - mean(j + 4)) / 800.0).collect();
    assert!(slopes.windows(2).all(|pair| pair[0] > 1.3 * pair[1]), "{slopes:?}");
    assert!((0.03..0.15).contains(&slopes[0]) && slopes[3] < 0.02, "{slopes:?}");
    let thickness = &run.deposits().unwrap().thickness;
    let laid = |from: usize, to: usize| {
        let cells = (to - from) * 100;
        (from..to).flat_map(|j| (30..130).map(move |i| (i, j))).map(|at| f64::from(thickness[at])).sum::<f64>()
            / cells as f64
    };
    assert!(laid(20, 50) < 1.0 && laid(62, 80) > 20.0, "{} {}", laid(20, 50), laid(62, 80));
}

#[test]
fn all_grids_are_eroded_and_drain() {
    for heights in samples::grids() {
        for (sea, jitter) in [(None, 0.0), (Some(250.0), 1.0)] {
            let erosion = Erosion { jitter, creep: 1e-6, steps: 3, ..erosion(3.0) };
            let mut out = heights.clone();
            erosion.run(&mut out, &Substrate::default(), sea, &Progress::none()).unwrap();
            let outlets = Outlets::new(&heights, sea);
            let routed = drainage::route_carving(&out, &outlets, Descent::Steepest);
            for c in 0..out.data().len() {
                match outlets.at(c) {
                    true => assert_eq!(out.data()[c].to_bits(), heights.data()[c].to_bits()),
                    false => assert!(out.data()[c].is_finite()),
                }
            }
            // Few depressions are left, and none that a millimetre of sediment would drain.
            for basin in &routed.basins.order {
                let spill = &routed.basins.spills[*basin as usize];
                assert!(spill.level - out.data()[spill.pit as usize] > 1e-3);
            }
        }
    }
}

#[test]
fn slopes_stay_below_their_limit() {
    let heights = hills(7);
    let erosion = Erosion { scattered: None, ..erosion(1.0) };
    let (out, _) = run_on(&heights, erosion, None);
    let outlets = Outlets::new(&heights, None);
    let receivers = crate::hydrology::steepest::receivers(&out, &outlets, Descent::Steepest);
    let steep = (0..out.data().len()).filter(|c| receivers.of(*c) != *c).filter(|c| {
        let away = DISTANCES[usize::from(receivers.code(*c))] * 100.0;
        f64::from(out.data()[*c] - out.data()[receivers.of(*c)]) > 1.05 * 0.7 * away
    });
    // Sediment that a cell cannot keep leaves it afterwards.
    assert!(steep.count() < 5);
}
