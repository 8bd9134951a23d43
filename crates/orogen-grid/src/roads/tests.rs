use super::*;
use crate::parallel;

const CELL: f64 = 10.0;

/// Ground from a function of metres east and south.
fn ground(width: usize, height: usize, at: impl Fn(f64, f64) -> f64) -> Grid {
    let window = Window::new(width, height, CELL);
    let data = (0..window.len()).map(|k| at((k % width) as f64 * CELL, (k / width) as f64 * CELL) as f32);
    Grid::from_data(window, data.collect()).unwrap()
}

fn land<'a>(ground: &'a Grid, water: Option<&'a Grid>) -> Land<'a> {
    Land { ground, water, cost: None, sea_level: None, domain: *ground.window() }
}

fn run(roads: &Roads, land: &Land, places: &[&[[f64; 2]]]) -> Result<RoadLayers> {
    let places: Vec<Vec<[f64; 3]>> =
        places.iter().map(|line| line.iter().map(|[x, y]| [*x, *y, 0.0]).collect()).collect();
    roads.run(land, &places, &Progress::none())
}

fn distance(a: [f64; 3], b: [f64; 3]) -> f64 {
    libm::hypot(a[0] - b[0], a[1] - b[1])
}

fn length(line: &RoadLine) -> f64 {
    line.points.windows(2).map(|pair| distance(pair[0], pair[1])).sum()
}

/// The largest grade of a line.
fn grade(line: &RoadLine) -> f64 {
    let grades = line.points.windows(2).map(|pair| (pair[1][2] - pair[0][2]).abs() / distance(pair[0], pair[1]));
    grades.fold(0.0, f64::max)
}

/// Hills with steep sides.
fn hills(x: f64, y: f64) -> f64 {
    let wave = |x: f64, y: f64, length: f64| libm::sin(x / length + 1.3 * libm::sin(y / length));
    400.0 + 110.0 * wave(x, y, 330.0) + 30.0 * wave(y, x, 130.0)
}

#[test]
fn the_grade_is_kept_on_lines_and_on_the_ground() {
    let ground = ground(200, 160, hills);
    for limit in [0.05, 0.08, 0.12] {
        let roads = Roads::default().with_grade(limit);
        let made = run(&roads, &land(&ground, None), &[&[[100.0, 100.0], [1850.0, 1450.0]]]).unwrap();
        assert_eq!(made.lines.len(), 1);
        let line = &made.lines[0];
        assert!(grade(line) <= limit * 1.0001, "{}", grade(line));
        assert!(length(line) > 2200.0);
        // The samples on the road have the heights of the line.
        let mut on_ground = 0;
        for (point, kind) in line.points.iter().zip(&line.kinds).filter(|(_, kind)| **kind == RoadKind::Road) {
            let [i, j] = [point[0], point[1]].map(|at| (at / CELL).round() as usize);
            let off = distance(*point, [i as f64 * CELL, j as f64 * CELL, 0.0]);
            let made = f64::from(made.height[(i, j)]);
            if off < 3.0 && *kind == RoadKind::Road {
                on_ground += 1;
                assert!((made - point[2]).abs() < limit * 8.0 + 0.01, "{point:?}: {made} m");
            }
        }
        assert!(on_ground > 20, "{on_ground}");
    }
}

#[test]
fn a_steep_slope_gets_switchbacks() {
    // A slope of 40 % over 160 m of height: at 8 % the road must be 2 km long, on 400 m.
    let ground = ground(160, 100, |_, y| 0.4 * (y - 300.0).clamp(0.0, 400.0));
    let roads = Roads::default().with_longest_tunnel(0.0);
    let made = run(&roads, &land(&ground, None), &[&[[800.0, 200.0], [800.0, 800.0]]]).unwrap();
    let line = &made.lines[0];
    assert!((1700.0..3500.0).contains(&length(line)), "{}", length(line));
    assert!(grade(line) <= 0.08001, "{}", grade(line));
    // East and west alternate.
    let mut signs: Vec<bool> = Vec::new();
    for pair in line.points.windows(2) {
        let east = pair[1][0] - pair[0][0];
        if east.abs() > 3.0 && signs.last() != Some(&(east > 0.0)) {
            signs.push(east > 0.0);
        }
    }
    assert!(signs.len() >= 2, "{signs:?}");
}

#[test]
fn cuts_and_embankments_have_their_slopes() {
    // A ridge and a valley across the road, too low for a tunnel and a bridge.
    let ground = ground(120, 61, |x, _| {
        100.0 + 8.0 * libm::exp(-(x - 400.0) * (x - 400.0) / 900.0)
            - 8.0 * libm::exp(-(x - 800.0) * (x - 800.0) / 900.0)
    });
    let roads = Roads::default().with_width(20.0).with_cut_slope(0.5).with_embankment_slope(0.4).with_grade(0.03);
    let made = run(&roads, &land(&ground, None), &[&[[100.0, 300.0], [1100.0, 300.0]]]).unwrap();
    let line = &made.lines[0];
    let (mut cut, mut filled) = (0, 0);
    for j in 10..50 {
        for i in 15..105 {
            let at = [i as f64 * CELL, j as f64 * CELL, 0.0];
            let near = line.points.iter().min_by(|a, b| distance(**a, at).total_cmp(&distance(**b, at))).unwrap();
            let beside = (distance(*near, at) - 10.0).max(0.0);
            let [least, most] = [near[2] - 0.4 * beside, near[2] + 0.5 * beside];
            let [before, after] = [ground[(i, j)], made.height[(i, j)]].map(f64::from);
            if beside < 15.0 {
                // The nearest point of the line is not the nearest one of its straight pieces.
                assert!((after - before.clamp(least, most)).abs() < 0.4, "{at:?}: {after} m, {least} to {most}");
                cut += usize::from(beside > 1.0 && before > most + 0.5);
                filled += usize::from(beside > 1.0 && before < least - 0.5);
            }
        }
    }
    assert!(cut > 5 && filled > 5, "{cut} {filled}");
    assert_eq!(made.change[(40, 10)], 0.0);
}

/// A river along the column, with gently sloping banks.
fn river(width: usize, height: usize) -> (Grid, Grid) {
    let bed = ground(width, height, |x, y| 50.0 + 0.01 * y + 0.02 * (x - 700.0).abs());
    let water = ground(width, height, |x, _| if (x - 700.0).abs() < 25.0 { 2.0 } else { 0.0 });
    (bed, water)
}

#[test]
fn water_is_crossed_by_bridges_only() {
    let (bed, water) = river(141, 101);
    let made = run(&Roads::default(), &land(&bed, Some(&water)), &[&[[100.0, 200.0], [1300.0, 800.0]]]).unwrap();
    let line = &made.lines[0];
    let mut crossed = 0;
    for (point, kind) in line.points.iter().zip(&line.kinds) {
        let [i, j] = [point[0], point[1]].map(|at| (at / CELL).round() as usize);
        if water[(i, j)] > 0.0 {
            crossed += 1;
            assert_eq!(*kind, RoadKind::Bridge, "{point:?}");
            assert!(point[2] > f64::from(bed[(i, j)]) + 0.9, "over the water");
        }
    }
    assert!(crossed > 3);
    let bridges: Vec<_> = line.stretches().into_iter().filter(|(kind, _)| *kind == RoadKind::Bridge).collect();
    assert_eq!(bridges.len(), 1);
    let span: f64 = line.points[bridges[0].1.clone()].windows(2).map(|pair| distance(pair[0], pair[1])).sum();
    assert!((50.0..150.0).contains(&span), "{span}");
    // The river bed stays open under the bridge, away from its abutments.
    let open = (0..101).filter(|j| made.change[(70, *j)] == 0.0).count();
    assert!(open > 90, "{open}");
    assert!(made.kind.data().contains(&2.0));
}

#[test]
fn a_diagonal_river_of_one_sample_has_no_gaps() {
    let bed = ground(121, 121, |x, y| 100.0 + 0.01 * (x + y - 1200.0).abs());
    let water = ground(121, 121, |x, y| if ((x + y) - 1200.0).abs() < 1.0 { 1.0 } else { 0.0 });
    let roads = Roads::default().with_longest_bridge(0.0).with_spacing(10.0);
    let failed = run(&roads, &land(&bed, Some(&water)), &[&[[100.0, 100.0], [1100.0, 1100.0]]]).unwrap_err();
    assert!(failed.to_string().contains("wider than the longest bridge"), "{failed}");
}

#[test]
fn a_ridge_is_crossed_in_a_tunnel_and_a_gorge_by_a_bridge() {
    let gauss = |x: f64| libm::exp(-x * x / 10_000.0);
    let ground = ground(161, 81, |x, _| 100.0 + 150.0 * gauss(x - 500.0) - 60.0 * gauss(1.6 * (x - 1100.0)));
    let roads = Roads::default();
    let made = run(&roads, &land(&ground, None), &[&[[100.0, 400.0], [1500.0, 400.0]]]).unwrap();
    let line = &made.lines[0];
    let kinds: Vec<RoadKind> = line.stretches().into_iter().map(|(kind, _)| kind).collect();
    assert_eq!(kinds, [RoadKind::Road, RoadKind::Tunnel, RoadKind::Road, RoadKind::Bridge, RoadKind::Road]);
    // The ridge stays above the tunnel, and the gorge under the bridge.
    assert!(made.change[(50, 40)] == 0.0 && made.change[(110, 40)] == 0.0);
    let low = run(
        &roads.with_tunnel_cost(500.0).with_bridge_cost(500.0),
        &land(&ground, None),
        &[&[[100.0, 400.0], [1500.0, 400.0]]],
    );
    assert!(length(&low.unwrap().lines[0]) > 1.3 * length(line));
}

#[test]
fn places_are_reached_and_a_second_road_joins_the_first() {
    let ground = ground(201, 161, hills);
    let one: &[[f64; 2]] = &[[100.0, 800.0], [1900.0, 800.0]];
    let two: &[[f64; 2]] = &[[130.0, 300.0], [1900.0, 800.0]];
    let made = run(&Roads::default(), &land(&ground, None), &[one, two]).unwrap();
    for place in one.iter().chain(two) {
        let ends = made.lines.iter().flat_map(|line| [line.points[0], line.points[line.points.len() - 1]]);
        let nearest = ends.map(|end| distance(end, [place[0], place[1], 0.0])).fold(f64::INFINITY, f64::min);
        assert!(nearest <= CELL, "{place:?}: {nearest} m");
    }
    let alone = run(&Roads::default(), &land(&ground, None), &[two]).unwrap();
    let second: Vec<&RoadLine> = made.lines.iter().filter(|line| line.road == 1).collect();
    let built: f64 = second.iter().map(|line| length(line)).sum();
    assert!(built < 0.7 * length(&alone.lines[0]), "{built} of {}", length(&alone.lines[0]));
    // It ends on a point of the first road, at its height.
    let end = *second[0].points.last().unwrap();
    let near = made.lines[0].points.iter().copied().min_by(|a, b| distance(*a, end).total_cmp(&distance(*b, end)));
    let near = near.unwrap();
    assert!(distance(near, end) < 1e-9 && (near[2] - end[2]).abs() < 1e-9, "{near:?} {end:?}");
    assert!(second.iter().all(|line| grade(line) < 0.0801));
}

#[test]
fn the_threads_do_not_matter() {
    let ground = ground(161, 141, hills);
    let water = ground_water(&ground);
    let places: &[&[[f64; 2]]] =
        &[&[[100.0, 100.0], [1500.0, 1200.0], [200.0, 1300.0]], &[[1500.0, 200.0], [150.0, 700.0]]];
    let of = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| {
            assert_eq!(parallel::threads(), threads);
            run(&Roads::default(), &land(&ground, Some(&water)), places).unwrap()
        })
    };
    assert_eq!(of(1), of(3));
}

/// Ponds in hollows.
fn ground_water(ground: &Grid) -> Grid {
    let depth = ground.data().iter().map(|height| (310.0 - height).max(0.0));
    Grid::from_data(*ground.window(), depth.collect()).unwrap()
}

#[test]
fn a_mirrored_land_has_a_road_of_the_same_cost() {
    let (width, height) = (141, 121);
    let ground = ground(width, height, hills);
    let mut mirrored = ground.clone();
    for j in 0..height {
        mirrored.row_mut(j).reverse();
    }
    let roads = Roads::default();
    let cost = |ground: &Grid, places: [[f64; 2]; 2]| {
        let land = land(ground, None);
        let lattice = Lattice::new(&roads, &land);
        let ways = ways::Ways::new(&roads, &land, &lattice, &Progress::none()).unwrap();
        let nodes = places.map(|at| lattice.nearest(at).unwrap());
        let mut search = route::Search::new(&roads, &lattice, &ways);
        search.run(nodes, &route::Existing::default(), &Progress::none()).unwrap().unwrap().1
    };
    let one = cost(&ground, [[100.0, 100.0], [1300.0, 1100.0]]);
    let other = cost(&mirrored, [[1300.0, 100.0], [100.0, 1100.0]]);
    assert!((one / other - 1.0).abs() < 0.01, "{one} {other}");
}

#[test]
fn what_cannot_be_built_is_said() {
    let island =
        ground(121, 121, |x, y| 40.0 - 0.2 * libm::hypot(x - 300.0, y - 300.0).min(libm::hypot(x - 900.0, y - 900.0)));
    let sea = |places: &[&[[f64; 2]]]| {
        let land = Land { sea_level: Some(0.0), ..land(&island, None) };
        run(&Roads::default(), &land, places).map_err(|error| error.to_string())
    };
    let said = sea(&[&[[300.0, 300.0], [900.0, 900.0]]]).unwrap_err();
    assert!(said.contains("no road leads from place 1 (300, 300) to place 2 (900, 900)"), "{said}");
    let said = sea(&[&[[300.0, 300.0], [310.0, 250.0]], &[[300.0, 300.0], [600.0, 600.0]]]).unwrap_err();
    assert!(said.contains("place 2 of road 2 (600, 600) is in water"), "{said}");
    let said = sea(&[&[[300.0, 300.0], [-10.0, 250.0]]]).unwrap_err();
    assert!(said.contains("(-10, 250) is outside of the world, which is 0 to 1200 m east"), "{said}");
}

#[test]
fn degenerate_lands_and_places() {
    let flat = ground(61, 61, |_, _| 10.0);
    for places in [&[][..], &[&[][..]][..], &[&[[100.0, 100.0]][..]][..], &[&[[100.0, 100.0], [100.0, 100.0]][..]][..]]
    {
        let made = run(&Roads::default(), &land(&flat, None), places).unwrap();
        assert!(made.lines.is_empty() && made.height == flat, "{places:?}");
    }
    let mut holes = flat.clone();
    for j in 0..50 {
        holes.row_mut(j)[30] = f32::NAN;
    }
    let places: &[&[[f64; 2]]] = &[&[[100.0, 100.0], [500.0, 100.0]]];
    let made = run(&Roads::default(), &land(&holes, None), places).unwrap();
    assert!(made.height[(30, 20)].is_nan() && length(&made.lines[0]) > 800.0, "around the hole");
    let bits = |grid: &Grid| grid.data().iter().map(|height| height.to_bits()).collect::<Vec<_>>();
    let void = ground(61, 61, |_, _| f64::NAN);
    assert!(run(&Roads::default(), &land(&void, None), places).unwrap_err().to_string().contains("has no height"));
    assert_eq!(bits(&run(&Roads::default(), &land(&void, None), &[]).unwrap().height), bits(&void));
    for (width, height) in [(1, 1), (2, 1), (1, 7)] {
        run(&Roads::default(), &land(&ground(width, height, |_, _| 0.0), None), &[&[[0.0, 0.0], [0.0, 0.0]]]).unwrap();
    }
}

#[test]
fn lines_are_kept_as_numbers() {
    let line = RoadLine {
        road: 2,
        points: vec![[1.0, 2.0, 3.0], [4.0, 5.0, 6.0], [7.0, 8.0, 9.0]],
        kinds: vec![RoadKind::Road, RoadKind::Bridge, RoadKind::Bridge],
    };
    let lines = vec![line.clone(), RoadLine { road: 0, points: Vec::new(), kinds: Vec::new() }];
    assert_eq!(RoadLine::from_numbers(&RoadLine::to_numbers(&lines)), lines);
    assert_eq!(line.stretches(), [(RoadKind::Road, 0..2), (RoadKind::Bridge, 1..3)]);
    assert!(RoadLine::from_numbers(&[0.0]).is_empty());
}

#[test]
fn a_road_does_not_cross_itself() {
    // A gorge with a steep end, where turning around is easier by a loop.
    let gorge = ground(141, 141, |x, y| 0.9 * (x - 700.0).abs().min(260.0) + 0.18 * (1400.0 - y));
    let roads = Roads::default().with_longest_tunnel(0.0).with_longest_bridge(0.0).with_radius(60.0);
    let made = run(&roads, &land(&gorge, None), &[&[[700.0, 1350.0], [700.0, 100.0]]]).unwrap();
    let points = &made.lines[0].points;
    let nearest = |k: usize| {
        let others = points.iter().enumerate().filter(|(other, _)| other.abs_diff(k) > 8);
        others.map(|(_, other)| distance(*other, points[k])).fold(f64::INFINITY, f64::min)
    };
    let least = (0..points.len()).map(nearest).fold(f64::INFINITY, f64::min);
    assert!(least > 2.5, "{least} m, {} m long", length(&made.lines[0]));
}
