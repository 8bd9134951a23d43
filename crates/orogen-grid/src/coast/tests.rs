use super::*;

const CELL: f64 = 20.0;

/// Ground from a function of metres east and south.
fn ground(width: usize, height: usize, at: impl Fn(f64, f64) -> f64) -> Grid {
    let window = Window::new(width, height, CELL);
    let data = (0..window.len()).map(|k| at((k % width) as f64 * CELL, (k / width) as f64 * CELL) as f32);
    Grid::from_data(window, data.collect()).unwrap()
}

/// Rough hills in a shallow sea.
fn hills(x: f64, y: f64) -> f64 {
    let wave = |x: f64, y: f64, length: f64| libm::sin(x / length + 1.3 * libm::sin(y / length));
    60.0 * wave(x, y, 310.0) + 25.0 * wave(y, x, 130.0) + 8.0 * wave(x + y, x - y, 57.0) - 10.0
}

/// A straight coast that faces west, with land that rises from 2000 m east on.
fn west_coast(x: f64, _: f64) -> f64 {
    (0.08 * (x - 2003.0)).max(-25.0)
}

fn run(law: &Coast, ground: &Grid) -> CoastLayers {
    law.run(ground, None, &Progress::none()).unwrap()
}

/// Position in metres at which a row rises over the sea.
fn shore_of(row: &[f32]) -> f64 {
    let i = row.windows(2).position(|pair| pair[0] <= 0.0 && pair[1] > 0.0).unwrap();
    (i as f64 + f64::from(row[i] / (row[i] - row[i + 1]))) * CELL
}

#[test]
fn waves_grow_with_their_fetch_and_the_wind() {
    // Wind of 14 m/s over 200 km: about 3 m and 7 s in the curves of the Shore Protection Manual.
    let [height, period] = waves::wave(14.0, 200e3);
    assert!((2.5..3.8).contains(&height) && (6.5..9.0).contains(&period), "{height} m, {period} s");
    let [less, _] = waves::wave(14.0, 10e3);
    let [more, _] = waves::wave(20.0, 10e3);
    assert!(less < 0.5 * height && more > less);
    assert_eq!(waves::wave(14.0, 0.0), [0.0; 2]);
    let law = Coast::default().with_wind_direction(200.0).with_wind_share(0.7);
    let sum: f64 = waves::winds(&law).iter().map(|wind| wind.share).sum();
    assert!((sum - 1.0).abs() < 1e-12, "{sum}");
}

#[test]
fn the_fetch_is_the_distance_over_water() {
    let window = Window::new(60, 50, CELL);
    // Land in the 20 westernmost columns.
    let water: Vec<bool> = (0..window.len()).map(|cell| cell % 60 >= 20).collect();
    for degrees in [250.0f64, 270.0, 290.0] {
        let angle = degrees.to_radians();
        let from = [libm::sin(angle), -libm::cos(angle)];
        let fetch = fetch::sweep(&water, &window, from, 1e6);
        let expected = 20.5 * CELL / from[0].abs();
        let got = f64::from(fetch[25 * 60 + 40]);
        assert!((got / expected - 1.0).abs() < 0.05, "{got} m from {degrees} degrees, expected {expected}");
        let other = fetch::sweep(&water, &window, [-from[0], -from[1]], 1e6);
        assert_eq!(other[25 * 60 + 40], 1e6, "the sea goes on");
    }
}

#[test]
fn an_open_straight_coast_has_an_exposure_of_one() {
    let after = run(&Coast::default().with_years(0.0), &ground(160, 80, west_coast));
    let exposure = after.exposure.row(40)[60];
    assert!((0.8..1.2).contains(&exposure), "{exposure}");
    let lee = run(&Coast::default().with_years(0.0).with_wind_direction(90.0), &ground(160, 80, west_coast));
    assert!(lee.exposure.row(40)[98] < 0.6, "behind the wind: {}", lee.exposure.row(40)[98]);
}

#[test]
fn the_front_of_a_point_is_a_circle() {
    let window = Window::new(81, 81, CELL);
    let start = march::Start { cell: 40 * 81 + 40, time: 0.0, carried: [3.0, 1.0] };
    let front = march::march(&window, vec![start], |_| true, |_, _| 1.0, 1e9);
    for [x, y] in [[30, 0], [0, 30], [21, 21], [-18, 24]] {
        let cell = (40 + y) as usize * 81 + (40 + x) as usize;
        let distance = libm::hypot(f64::from(x), f64::from(y)) * CELL;
        let got = f64::from(front.time[cell]);
        assert!((got / distance - 1.0).abs() < 0.07, "{got} for {distance}");
        assert_eq!(front.carried[cell], [3.0, 1.0]);
    }
}

#[test]
fn the_shore_retreats_to_a_cliff_behind_a_platform() {
    let before = ground(200, 60, west_coast);
    let law = Coast::default().with_sand_share(0.0);
    let after = run(&law, &before);
    let row = after.height.row(30);
    let retreat = shore_of(row) - 2003.0;
    assert!((60.0..400.0).contains(&retreat), "{retreat} m");
    let shore = (shore_of(row) / CELL) as usize;
    // The platform falls seaward by its slope.
    let slope = f64::from(row[shore - 2] - row[shore - 6]) / (4.0 * CELL);
    assert!((0.5..2.0).contains(&(slope / law.platform_slope)), "a platform with a slope of {slope}");
    // The cliff: steeper than the land was, not steeper than the angle.
    let steepest = row.windows(2).map(|pair| f64::from(pair[1] - pair[0]) / CELL).fold(0.0, f64::max);
    assert!(steepest > 0.4 && steepest <= libm::tan(law.cliff_angle.to_radians()) + 1e-6, "a cliff of {steepest}");
    // Hard rock retreats less, years without waves not at all.
    let hard = Grid::filled(*before.window(), 0.1);
    let less = law.run(&before, Some(&hard), &Progress::none()).unwrap();
    assert!(shore_of(less.height.row(30)) - 2003.0 < 0.4 * retreat);
    let still = run(&law.with_years(0.0), &before);
    assert_eq!(still.height.data(), before.data());
    assert_eq!(still.volumes.worn, 0.0);
}

#[test]
fn headlands_retreat_more_than_bays() {
    // A coast with bays 600 m deep every 1200 m.
    let law = Coast::default().with_sand_share(0.0);
    let bays = |x: f64, y: f64| (0.1 * (x - 2000.0 - 300.0 * libm::sin(y / 1200.0 * std::f64::consts::TAU))).max(-25.0);
    let after = run(&law, &ground(220, 180, bays));
    let moved = |y: usize| {
        let old = 2000.0 + 300.0 * libm::sin(y as f64 * CELL / 1200.0 * std::f64::consts::TAU);
        shore_of(after.height.row(y)) - old
    };
    let (bay, headland) = (moved(75), moved(105));
    assert!(headland > 1.15 * bay, "headland {headland} m, bay {bay} m");
}

#[test]
fn beaches_have_the_profile_of_dean() {
    // A flat sea floor before a straight coast, sand of rivers alone.
    let before = ground(220, 80, |x, _| if x < 2003.0 { -7.5 } else { 0.05 * (x - 2003.0) });
    let law = Coast::default().with_retreat(0.0).with_denudation(2.0).with_sand_share(1.0);
    let after = run(&law, &before);
    let row = after.height.row(40);
    let shore = shore_of(row);
    assert!(shore < 1990.0, "no beach: {shore}");
    let points: Vec<[f64; 2]> = (1..=8)
        .map(|k| {
            let i = (shore / CELL) as usize - k;
            [shore - i as f64 * CELL, -f64::from(row[i])]
        })
        .filter(|[_, depth]| *depth < 4.5)
        .collect();
    assert!(points.len() >= 4, "{points:?}");
    let logs: Vec<[f64; 2]> = points.iter().map(|[y, depth]| [libm::log(*y), libm::log(*depth)]).collect();
    let mean = |k: usize| logs.iter().map(|point| point[k]).sum::<f64>() / logs.len() as f64;
    let (mx, my) = (mean(0), mean(1));
    let exponent = logs.iter().map(|[x, y]| (x - mx) * (y - my)).sum::<f64>()
        / logs.iter().map(|[x, _]| (x - mx) * (x - mx)).sum::<f64>();
    assert!((exponent - 2.0 / 3.0).abs() < 0.1, "an exponent of {exponent}: {points:?}");
    let highest = row[..(2003.0 / CELL) as usize].iter().copied().fold(f32::NEG_INFINITY, f32::max);
    assert!((0.5..=2.0).contains(&highest), "a berm of {highest} m");
}

#[test]
fn sand_gathers_in_bays_and_its_volume_is_kept() {
    let bays = |x: f64, y: f64| (0.1 * (x - 2000.0 - 200.0 * libm::sin(y / 1500.0 * std::f64::consts::TAU))).max(-6.0);
    let before = ground(220, 240, bays);
    let after = run(&Coast::default(), &before);
    let sums = |rows: std::ops::Range<usize>| -> f32 { rows.map(|j| after.beach.row(j).iter().sum::<f32>()).sum() };
    // Bays are where the sine is 1: 375 m and 1875 m south; headlands at 1125 m and 2625 m.
    let (bays, headlands) = (sums(85..103), sums(48..66));
    assert!(bays > 2.0 * headlands, "sand in bays {bays}, at headlands {headlands}");
    let volumes = after.volumes;
    assert!(volumes.beach > 0.0 && volumes.beach <= 1.03 * volumes.sand, "{volumes:?}");
    assert!((volumes.sand - volumes.beach - volumes.lost).abs() < 1.0, "{volumes:?}");
    let gained: f64 = after.change.data().iter().map(|change| f64::from(*change) * CELL * CELL).sum();
    assert!((gained - (volumes.beach - volumes.worn)).abs() < 1e-3 * volumes.worn, "{gained} {volumes:?}");
    let laid: f64 = after.beach.data().iter().map(|beach| f64::from(*beach) * CELL * CELL).sum();
    assert!((laid / volumes.beach - 1.0).abs() < 1e-9);
}

#[test]
fn transport_keeps_the_volume() {
    let window = Window::new(120, 120, CELL);
    let shore: Vec<f32> = (0..window.len())
        .map(|cell| {
            let (x, y) = ((cell % 120) as f64 - 60.0, (cell / 120) as f64 - 60.0);
            ((40.0 + 6.0 * libm::sin(5.0 * libm::atan2(y, x)) - libm::hypot(x, y)) * CELL) as f32
        })
        .collect();
    let nodes = Nodes::new(&window, &shore, 50).unwrap();
    assert!(nodes.nodes.len() > 60);
    let sections = vec![Section::of_depth(5.0); nodes.nodes.len()];
    let climate = Climate::new(&Coast::default());
    let drift = Drift::new(&window, &nodes, &shore, &climate, &Progress::none()).unwrap();
    let mut sand = vec![0.0; nodes.nodes.len()];
    sand.iter_mut().step_by(7).for_each(|sand| *sand = 20_000.0);
    let before: f64 = sand.iter().sum();
    drift::run(&Coast::default(), &nodes.nodes, &drift, &sections, &mut sand);
    let after: f64 = sand.iter().sum();
    assert!((after / before - 1.0).abs() < 1e-9, "{before} m^3 became {after}");
    assert!(sand.iter().all(|sand| *sand >= 0.0));
}

#[test]
fn no_depressions_are_made_on_land() {
    use crate::hydrology::fill::fill;
    let before = ground(150, 130, hills);
    let outlets = Outlets::new(&before, Some(0.0));
    // Ground that drains.
    let before = fill(&before, &outlets);
    let after = run(&Coast::default().with_sand_share(0.5), &before);
    assert!(after.volumes.beach > 1e5, "{:?}", after.volumes);
    let filled = fill(&after.height, &Outlets::new(&after.height, Some(0.0)));
    let deepest = filled.data().iter().zip(after.height.data()).map(|(f, h)| f - h).fold(0.0, f32::max);
    assert!(deepest < 1e-3, "a depression of {deepest} m");
}

#[test]
fn the_sea_level_shifts_everything() {
    let before = ground(90, 80, hills);
    let mut high = before.clone();
    high.data_mut().iter_mut().for_each(|height| *height += 512.0);
    let (low, high) = (run(&Coast::default(), &before), run(&Coast::default().with_sea_level(512.0), &high));
    let apart = low.height.data().iter().zip(high.height.data()).map(|(a, b)| (a + 512.0 - b).abs());
    // Heights have fewer digits above 512 m.
    let far = apart.filter(|apart| *apart > 0.05).count();
    assert!(far < 20, "{far} samples differ");
}

#[test]
fn ground_without_heights_and_other_windows() {
    let mut before = ground(60, 50, hills);
    before.row_mut(20)[10..40].fill(f32::NAN);
    let after = run(&Coast::default(), &before);
    assert_eq!(after.height.data().iter().filter(|height| height.is_nan()).count(), 30);
    for height in [-30.0f32, 50.0] {
        let level = Grid::filled(Window::new(30, 20, CELL), height);
        assert_eq!(run(&Coast::default(), &level).height.data(), level.data());
    }
    for (width, height) in [(0, 0), (1, 1), (1, 7), (2, 2)] {
        let small = Grid::filled(Window::new(width, height, CELL), 1.0);
        assert_eq!(run(&Coast::default(), &small).height.data(), small.data());
    }
    let factor = Grid::filled(Window::new(61, 50, CELL), 1.0);
    let refused = Coast::default().run(&before, Some(&factor), &Progress::none()).unwrap_err();
    assert_eq!(refused.kind(), ErrorKind::Request);
}

#[test]
fn the_result_does_not_depend_on_threads_and_can_be_cancelled() {
    let before = ground(80, 70, hills);
    let with = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| run(&Coast::default(), &before))
    };
    assert_eq!(with(1), with(3));
    let progress = Progress::none();
    progress.cancel();
    assert_eq!(Coast::default().run(&before, None, &progress).unwrap_err().kind(), ErrorKind::Cancelled);
}

/// A coast that faces west and ends at a corner, 2000 m south; a shallow sea floor.
fn corner(x: f64, y: f64) -> f64 {
    if x > 2003.0 && y < 2003.0 { 20.0 + 0.02 * (x - 2003.0) } else { -5.0 }
}

/// Volume of the sand above the water within a rectangle in metres: west, east, north, south.
fn dry_sand(after: &CoastLayers, [west, east, north, south]: [f64; 4]) -> f64 {
    let cells = after.beach.data().iter().zip(after.height.data()).enumerate();
    let inside = cells.filter(|(k, (sand, height))| {
        let (x, y) = ((k % after.beach.width()) as f64 * CELL, (k / after.beach.width()) as f64 * CELL);
        **sand > 0.0 && **height > 0.0 && x >= west && x <= east && y >= north && y <= south
    });
    inside.map(|(_, (sand, _))| f64::from(*sand) * CELL * CELL).sum()
}

/// Waves from one side of a coast that faces west.
fn oblique(from: f64) -> Coast {
    Coast::default().with_wind_direction(from).with_wind_share(1.0).with_sand_share(0.5)
}

#[test]
fn a_corner_gets_a_spit_in_the_direction_of_the_drift() {
    let before = ground(180, 200, corner);
    let beyond = [1400.0, 2600.0, 2150.0, 3800.0];
    // From the north-west sand moves south.
    let after = run(&oblique(310.0), &before);
    let spit = dry_sand(&after, beyond);
    assert!(spit > 1e5, "{spit} m^3 beyond the corner, {:?}", after.volumes);
    assert!(after.volumes.spits > spit && after.volumes.spits <= 0.5 * after.volumes.sand, "{:?}", after.volumes);
    assert!(after.volumes.beach <= 1.03 * after.volumes.sand, "{:?}", after.volumes);
    let highest = after.beach.data().iter().zip(after.height.data()).filter(|(sand, _)| **sand > 0.0);
    assert!(highest.map(|(_, height)| *height).fold(0.0, f32::max) <= 20.0);
    for law in [oblique(230.0), oblique(310.0).with_spits(0.0), oblique(310.0).with_sand_share(0.0)] {
        let other = run(&law, &before);
        assert!(dry_sand(&other, beyond) < 0.02 * spit, "{law:?}");
    }
    // The mirror image.
    let mirrored = ground(180, 200, |x, y| corner(x, 199.0 * CELL - y));
    let other = run(&oblique(230.0), &mirrored);
    let turned = dry_sand(&other, [beyond[0], beyond[1], 199.0 * CELL - beyond[3], 199.0 * CELL - beyond[2]]);
    assert!((turned / spit - 1.0).abs() < 0.1, "{turned} m^3 for {spit}");
    assert!((other.volumes.spits / after.volumes.spits - 1.0).abs() < 0.1, "{:?} {:?}", other.volumes, after.volumes);
}

/// Whether water at a place is joined to the sea at the border.
fn is_open(after: &CoastLayers, x: f64, y: f64) -> bool {
    let window = *after.height.window();
    let wet = |cell: usize| after.height.data()[cell] < 0.0;
    let start = (y / CELL) as usize * window.width + (x / CELL) as usize;
    assert!(wet(start), "no water: {}", after.height.data()[start]);
    let (mut seen, mut queue) = (vec![false; window.len()], vec![start]);
    while let Some(cell) = queue.pop() {
        for next in march::neighbors(&window, cell) {
            match next {
                None => return true,
                Some(next) if wet(next) && !seen[next] => {
                    seen[next] = true;
                    queue.push(next);
                }
                Some(_) => {}
            }
        }
    }
    false
}

#[test]
fn a_bay_gets_a_bar_and_a_lagoon_and_a_river_keeps_an_inlet() {
    let land = |x: f64, y: f64, valley: f64| {
        let bay = (1500.0..2100.0).contains(&y) && x < 2700.0;
        if x > 2003.0 && !bay { 15.0 + 0.04 * (x - 2003.0) + valley * (y - 1800.0).abs() } else { -4.0 }
    };
    let plain = run(&oblique(310.0), &ground(200, 180, |x, y| land(x, y, 0.0)));
    assert!(plain.volumes.spits > 0.0);
    assert!(!is_open(&plain, 2500.0, 1800.0), "no lagoon");
    let none = run(&oblique(310.0).with_spits(0.0), &ground(200, 180, |x, y| land(x, y, 0.0)));
    assert!(is_open(&none, 2500.0, 1800.0));
    let river = run(&oblique(310.0), &ground(200, 180, |x, y| land(x, y, 0.05)));
    assert!(river.volumes.spits > 0.0);
    assert!(is_open(&river, 2500.0, 1800.0), "the river has no inlet");
}

#[test]
fn an_islet_close_to_a_shore_is_joined_to_it() {
    let land = |x: f64, y: f64| {
        let islet = 15.0 - 0.1 * (libm::hypot(x - 1500.0, 0.6 * (y - 1500.0)));
        if x > 2003.0 { 15.0 + 0.04 * (x - 2003.0) } else { islet.max(-4.0) }
    };
    let law = oblique(270.0).with_retreat(0.02);
    let joined = |law: &Coast| {
        let after = run(law, &ground(160, 150, land));
        let row = after.height.row(75);
        row[(1560.0 / CELL) as usize..(2100.0 / CELL) as usize].iter().copied().fold(f32::INFINITY, f32::min)
    };
    assert!(joined(&law) > 0.0, "{} m", joined(&law));
    assert!(joined(&law.with_spits(0.0)) < 0.0 && joined(&law.with_sand_share(0.0)) < 0.0);
}

#[test]
fn ridges_take_their_sand_from_the_shore() {
    let before = ground(180, 200, corner);
    let (law, window) = (oblique(310.0).with_retreat(0.0), *before.window());
    let climate = Climate::new(&law);
    let shore = retreat::retreat(&law, &window, before.data(), |_| 1.0, &climate, &Progress::none()).unwrap();
    let nodes = Nodes::new(&window, &shore.beside, 150).unwrap();
    let drift = Drift::new(&window, &nodes, &shore.beside, &climate, &Progress::none()).unwrap();
    let mut sand = vec![40_000.0; nodes.nodes.len()];
    let mut ridges = Ridges::new(&law, &window, &shore, before.data());
    Drifting { nodes: &nodes, drift: &drift, mouths: &[] }.build(&law, &mut ridges, &mut sand);
    assert!(sand.iter().all(|sand| *sand >= 0.0));
    let taken = 40_000.0 * sand.len() as f64 - sand.iter().sum::<f64>();
    let laid: f64 = ridges.thickness.iter().map(|thickness| f64::from(*thickness) * CELL * CELL).sum();
    assert!(laid > 1e5 && (taken / laid - 1.0).abs() < 1e-9, "{taken} m^3 taken, {laid} m^3 laid");
    // What is taken back leaves no trace.
    let kept = ridges.thickness.clone();
    ridges.add(ridges::Part { at: [60.0, 120.0], lee: [1.0, 0.0], half: 60.0 });
    assert!(ridges.volume() > 0.0 && ridges.thickness != kept);
    ridges.undo();
    assert!(ridges.volume() == 0.0 && ridges.thickness == kept);
}
