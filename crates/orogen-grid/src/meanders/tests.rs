use super::migration::migrate;
use super::*;

/// A straight valley of 200 widths.
const STRAIGHT: [[f64; 2]; 2] = [[0.0, 0.0], [12_000.0, 0.0]];

fn length(line: &[[f64; 2]]) -> f64 {
    line.windows(2).map(|pair| distance(pair[0], pair[1])).sum()
}

fn present(history: &History) -> &[[f64; 2]] {
    history.courses.last().unwrap()
}

#[test]
fn bends_grow_until_they_are_cut_off() {
    for seed in 0..4 {
        let after = |migration| migrate(&Meanders::default().with_migration(migration).with_seed(seed), &STRAIGHT, 0);
        let sinuosity = |history: &History| length(present(history)) / 12_000.0;
        let [young, grown, old] = [5.0, 50.0, 400.0].map(after);
        assert!(sinuosity(&young) < 1.1 && young.oxbows.is_empty(), "{}", sinuosity(&young));
        assert!(sinuosity(&grown) > 1.4, "{}", sinuosity(&grown));
        // Rivers that meander freely have about pi in the mean (Stolum 1996).
        assert!((2.2..4.2).contains(&sinuosity(&old)) && old.oxbows.len() > 20, "{}", sinuosity(&old));
        for history in [&young, &grown, &old] {
            let line = present(history);
            assert_eq!([line[0], line[line.len() - 1]], STRAIGHT);
        }
    }
}

/// The length of a bend and the next one in the direction of the valley is 10 to 14 widths in rivers (Leopold and
/// Wolman 1960).
#[test]
fn bends_are_as_long_as_those_of_rivers() {
    let lengths = (0..6).map(|seed| {
        let history = migrate(&Meanders::default().with_migration(40.0).with_seed(seed), &STRAIGHT, 0);
        let line = present(&history);
        let inner = &line[line.len() / 4..line.len() * 3 / 4];
        let crossings = inner.windows(2).filter(|pair| (pair[0][1] > 0.0) != (pair[1][1] > 0.0)).count();
        2.0 * (inner[inner.len() - 1][0] - inner[0][0]) / crossings as f64 / 60.0
    });
    let mean = lengths.sum::<f64>() / 6.0;
    assert!((9.0..18.0).contains(&mean), "{mean}");
}

#[test]
fn a_river_does_not_touch_itself() {
    let history = migrate(&Meanders::default().with_migration(300.0), &STRAIGHT, 0);
    let line = present(&history);
    for (k, point) in line.iter().enumerate() {
        for other in &line[(k + 20).min(line.len())..] {
            assert!(distance(*point, *other) > 60.0, "{point:?} {other:?}");
        }
    }
}

#[test]
fn a_river_stays_in_its_valley() {
    let river = Meanders::default().with_migration(300.0).with_valley(900.0);
    let history = migrate(&river, &STRAIGHT, 0);
    let furthest = history.courses.iter().flatten().map(|[_, y]| y.abs()).fold(0.0, f64::max);
    assert!((300.0..460.0).contains(&furthest), "{furthest}");
    let free = migrate(&river.with_valley(0.0), &STRAIGHT, 0);
    assert!(free.courses.iter().flatten().any(|[_, y]| y.abs() > 600.0));
}

#[test]
fn the_floodplain_has_a_channel_lakes_and_bars() {
    let river = Meanders::default().with_seed(3);
    let line = vec![STRAIGHT.map(|[x, y]| [x, y, 0.0]).to_vec()];
    let (plain, history) = (river.floodplain(&line), migrate(&river, &STRAIGHT, 0));
    for point in present(&history) {
        let ground = plain.at(*point);
        assert!((ground.height + 3.0).abs() < 1e-6 && ground.age == 0.0, "{ground:?}");
        assert_eq!((ground.inside, ground.oxbow), (1.0, 0.0));
    }
    let far = plain.at([6000.0, 9000.0]);
    assert!((far.height, far.inside, far.oxbow, far.age) == (0.0, 0.0, 0.0, 1.0), "{far:?}");
    // The middle of the last oxbow, unless the river has come there again, is a lake.
    let lakes = history.oxbows.iter().rev().take(6).filter(|oxbow| {
        let ground = plain.at(oxbow.line[oxbow.line.len() / 2]);
        ground.oxbow > 0.99 && ground.height < -0.5 && ground.inside == 0.0
    });
    assert!(lakes.count() >= 3);
    // Where the river was, the ground has a relief of some decimetres, and it was there before.
    let (mut bars, mut ages) = (Vec::new(), Vec::new());
    for (i, j) in (0..300).flat_map(|i| (0..80).map(move |j| (i, j))) {
        let ground = plain.at([f64::from(i) * 40.0, f64::from(j) * 40.0 - 1600.0]);
        if ground.age < 1.0 && ground.inside == 0.0 && ground.oxbow == 0.0 {
            bars.push(ground.height);
            ages.push(ground.age);
        }
    }
    assert!(bars.len() > 2000 && bars.iter().all(|height| height.abs() < 1.0));
    let spread = bars.iter().map(|height| height * height).sum::<f64>() / bars.len() as f64;
    assert!(spread.sqrt() > 0.05, "{spread}");
    assert!(ages.iter().all(|age| (0.0..1.0).contains(age)));
}

#[test]
fn a_history_depends_on_its_line_and_its_seed() {
    let river = Meanders::default();
    let line = |y: f64| vec![[0.0, y, 0.0], [6000.0, y, 0.0]];
    let at = |plain: &Floodplain| [[1000.0, 50.0], [3000.0, -80.0], [5000.0, 20.0]].map(|at| plain.at(at));
    let alone = at(&river.floodplain(&[line(0.0)]));
    assert_eq!(at(&river.floodplain(&[line(0.0)])), alone);
    // A second river, far away, changes nothing.
    assert_eq!(at(&river.floodplain(&[line(0.0), line(50_000.0)])), alone);
    assert_ne!(at(&river.with_seed(1).floodplain(&[line(0.0)])), alone);
}

#[test]
fn lines_without_a_length_are_rivers_that_stay() {
    for lines in [
        vec![],
        vec![vec![[5.0, 5.0, 0.0]]],
        vec![vec![[5.0, 5.0, 0.0]; 3]],
        vec![vec![[0.0, 0.0, 0.0], [10.0, 0.0, 0.0]]],
        vec![vec![[-1e9, 0.0, 0.0], [1e9, 1e9, 0.0]]],
    ] {
        let plain = Meanders::default().with_migration(20.0).floodplain(&lines);
        let ground = plain.at([5.0, 5.0]);
        assert!(ground.height.is_finite() && (0.0..=1.0).contains(&ground.age), "{ground:?}");
        assert_eq!(plain.nearest([0.0, 0.0]).is_none(), lines.is_empty());
    }
}
