use super::*;

const CELL: f64 = 20.0;

/// Ground with a height for each position in metres.
fn ground(width: usize, rows: usize, height: impl Fn(f64, f64) -> f64) -> Grid {
    let mut grid = Grid::filled(Window::new(width, rows, CELL), 0.0);
    for j in 0..rows {
        for (i, sample) in grid.row_mut(j).iter_mut().enumerate() {
            *sample = height(i as f64 * CELL, j as f64 * CELL) as f32;
        }
    }
    grid
}

/// A vent at one sample.
fn vent(ground: &Grid, i: usize, j: usize) -> Grid {
    let mut vents = Grid::filled(*ground.window(), 0.0);
    vents.row_mut(j)[i] = 1.0;
    vents
}

/// One eruption of lava alone.
fn flow(volume: f64) -> Lava {
    Lava::default().with_eruptions(1).with_volume([volume; 2]).with_yield_strength(2e4).with_ash(0.0)
}

fn run(law: &Lava, ground: &Grid, vents: &Grid) -> Erupted {
    law.run(ground, Some(vents), &Progress::none()).unwrap()
}

/// The gain of all heights, in m^3.
fn gain(after: &Grid, before: &Grid) -> f64 {
    let gains = after.data().iter().zip(before.data()).map(|(after, before)| f64::from(*after) - f64::from(*before));
    gains.sum::<f64>() * CELL * CELL
}

fn rough(x: f64, y: f64) -> f64 {
    800.0 - 0.1 * x + 30.0 * libm::sin(x / 170.0) * libm::cos(y / 110.0)
}

#[test]
fn volume_is_kept() {
    let before = ground(120, 90, rough);
    for law in [
        Lava::default().with_eruptions(12).with_volume([1e5, 1e7]),
        Lava::default().with_eruptions(10).with_volume([1e6, 5e6]).with_caldera(500.0).with_ash(0.4),
        // Much of it leaves over the border.
        Lava::default().with_eruptions(4).with_volume([5e7, 6e7]).with_yield_strength(500.0),
    ] {
        let after = law.run(&before, None, &Progress::none()).unwrap();
        let volumes = after.volumes;
        let expected = volumes.lava + volumes.ash - volumes.collapsed - volumes.left;
        // The heights are rounded to f32: 6e-5 m for each sample at most.
        let most = 1e-9 * volumes.lava + 6e-5 * (120.0 * 90.0) * CELL * CELL;
        let gained = gain(&after.height, &before);
        assert!((gained - expected).abs() < most, "{gained} m^3, expected {expected}: {volumes:?}");
        assert!(after.lava.data().iter().chain(after.ash.data()).all(|thickness| *thickness >= 0.0));
        assert_eq!(volumes.collapsed > 0.0, law.caldera > 0.0);
        if law.ash == 0.2 && law.caldera == 0.0 && volumes.left == 0.0 {
            let laid: f64 = after.lava.data().iter().map(|thickness| f64::from(*thickness)).sum();
            assert!((laid * CELL * CELL / volumes.lava - 1.0).abs() < 0.02, "{laid}");
        }
    }
}

#[test]
fn the_volumes_of_a_flow_are_exact() {
    let before = ground(120, 90, rough);
    let law = flow(3e6);
    let window = *before.window();
    let mut state = Ground {
        window,
        height: before.data().iter().map(|height| f64::from(*height)).collect(),
        lava: vec![0.0; window.len()],
        ash: vec![0.0; window.len()],
        age: vec![1.0; window.len()],
    };
    let sum = |state: &Ground| state.height.iter().sum::<f64>() * CELL * CELL;
    let start = sum(&state);
    let left = Flow::new(&window, &law).run(&mut state, [20, 45], 3e6, 0.0, &Progress::none()).unwrap();
    let error = (sum(&state) - start + left) / 3e6 - 1.0;
    assert!(error.abs() < 1e-8, "{error:e}");
}

#[test]
fn a_flow_on_a_plane_has_the_critical_thickness_within_its_levees() {
    let slope = 0.15;
    let before = ground(420, 121, |x, _| 2000.0 - slope * x);
    let after = run(&flow(2e7), &before, &vent(&before, 40, 60));
    let critical = 2e4 / WEIGHT / slope;
    let length = libm::pow(10.0, 3.11) * libm::pow(20.0, 0.47);
    // 1 km below the vent.
    let column = 90;
    let thickness: Vec<f64> = (0..121).map(|j| f64::from(after.lava.row(j)[column])).collect();
    let covered: Vec<usize> = (0..121).filter(|j| thickness[*j] > 0.5).collect();
    let (first, last) = (covered[0], covered[covered.len() - 1]);
    assert_eq!(last - first + 1, covered.len(), "one flow");
    assert!((8..60).contains(&covered.len()), "{} cells wide", covered.len());
    let here = critical * libm::exp(2.0 * 1000.0 / length);
    let levee = thickness[first..first + 4].iter().chain(&thickness[last - 3..=last]).fold(0.0f64, |a, b| a.max(*b));
    let middle = thickness[first + 6..last - 5].iter().sum::<f64>() / (last - first - 11) as f64;
    assert!((0.6..1.4).contains(&(levee / here)), "levees of {levee} m, critical are {here} m");
    // The channel has drained.
    assert!((0.25..0.9).contains(&(middle / here)), "{middle} m in the channel, critical are {here} m");
    assert!(levee > 1.2 * middle, "levees of {levee} m, {middle} m between them");
    // The front is thicker than the flow behind it.
    let end = (0..420).rev().find(|i| after.lava.row(60)[*i] > 0.5).unwrap();
    let front = (end - 12..=end).map(|i| f64::from(after.lava.row(60)[i])).fold(0.0, f64::max);
    assert!(front > 2.0 * middle, "a front of {front} m");
}

#[test]
fn a_flow_stays_in_its_valley_and_ends_lower() {
    // A valley that bends, 60 m deep.
    let axis = |x: f64| 1200.0 + 300.0 * libm::sin(x / 500.0);
    let before = ground(300, 121, |x, y| {
        let across = (y - axis(x)) / 250.0;
        1500.0 - 0.12 * x + 60.0 * (across * across).min(1.0)
    });
    let [i, j] = [30, (axis(600.0) / CELL) as usize];
    let after = run(&flow(8e6), &before, &vent(&before, i, j));
    let (mut lowest, mut inside, mut outside) = (f32::INFINITY, 0, 0);
    for y in 0..121 {
        for x in 0..300 {
            if after.lava.row(y)[x] > 0.5 {
                lowest = lowest.min(before.row(y)[x]);
                let is_inside = (y as f64 * CELL - axis(x as f64 * CELL)).abs() < 250.0;
                *if is_inside { &mut inside } else { &mut outside } += 1;
            }
        }
    }
    assert!(inside > 500 && outside == 0, "{inside} cells in the valley, {outside} outside");
    assert!(lowest < before.row(j)[i] - 200.0, "it ends at {lowest} m");
}

#[test]
fn stiffer_lava_makes_shorter_and_thicker_flows() {
    let before = ground(420, 121, |x, _| 2000.0 - 0.15 * x);
    let of = |strength: f64| {
        let after = run(&flow(5e6).with_yield_strength(strength), &before, &vent(&before, 40, 60));
        let is_there = |i: &usize| (0..121).any(|j| after.lava.row(j)[*i] > 0.5);
        let thickest = after.lava.data().iter().copied().fold(0.0, f32::max);
        ((0..420).rev().find(is_there).unwrap(), thickest)
    };
    let (soft, stiff) = (of(3e3), of(1e5));
    assert!(soft.0 > stiff.0 + 20 && stiff.1 > 2.0 * soft.1, "{soft:?} and {stiff:?}");
}

#[test]
fn later_flows_lie_on_and_beside_earlier_ones() {
    let before = ground(300, 121, |x, _| 2000.0 - 0.15 * x);
    let vents = vent(&before, 40, 60);
    let covered = |count: u32| {
        let after = run(&flow(3e6).with_eruptions(count), &before, &vents);
        let cells = after.lava.data().iter().filter(|thickness| **thickness > 0.5).count();
        let ages: std::collections::BTreeSet<u32> = after.age.data().iter().map(|age| age.to_bits()).collect();
        (cells, ages.len())
    };
    let ((one, _), (four, ages)) = (covered(1), covered(4));
    assert!(four as f64 > 1.1 * one as f64, "{one} and {four} cells");
    assert!(ages >= 3, "{ages} ages with that of the ground");
}

#[test]
fn cinder_cones_have_the_form_of_real_ones() {
    let before = ground(101, 101, |_, _| 100.0);
    let law = Lava::default().with_eruptions(1).with_volume([2e7; 2]).with_ash(1.0);
    // The share of ash is random; a seed with much of it.
    let after = run(&law.with_seed(3), &before, &vent(&before, 50, 50));
    let row: Vec<f64> = (50..101).map(|i| f64::from(after.height.row(50)[i]) - 100.0).collect();
    let rim = (0..row.len()).max_by(|a, b| row[*a].total_cmp(&row[*b])).unwrap();
    let flank = (row[rim + 1] - row[rim + 3]) / (2.0 * CELL);
    let degrees = libm::atan(flank).to_degrees();
    assert!((29.0..34.0).contains(&degrees), "{degrees} degrees");
    // The base is where the flank would end without the ash around it.
    let base = rim as f64 * CELL + row[rim] / flank;
    assert!((0.14..0.21).contains(&(row[rim] / (2.0 * base))), "{} m high, {} m wide", row[rim], 2.0 * base);
    assert!((0.3..0.5).contains(&(rim as f64 * CELL / base)), "a crater of {} of {base} m", rim as f64 * CELL);
    assert!(row[0] < 0.7 * row[rim], "a crater");
}

#[test]
fn a_caldera_has_a_flat_floor_and_steep_walls() {
    let before = ground(151, 151, |x, y| 2000.0 - 0.35 * libm::hypot(x - 1500.0, y - 1500.0));
    let law = Lava::default().with_eruptions(10).with_volume([4e7, 6e7]).with_caldera(900.0).with_ash(0.0);
    // The vents are in a ring, so that the floor is not covered.
    let mut vents = Grid::filled(*before.window(), 0.0);
    for [i, j] in [[30, 75], [120, 75], [75, 30], [75, 120]] {
        vents.row_mut(j)[i] = 1.0;
    }
    let after = run(&law, &before, &vents);
    assert!(after.volumes.collapsed > 1e7, "{:?}", after.volumes);
    let row = after.height.row(75);
    let floor = &row[65..=85];
    let spread = floor.iter().copied().fold(0.0, f32::max) - floor.iter().copied().fold(f32::INFINITY, f32::min);
    assert!(spread < 1.0, "the floor varies by {spread} m");
    let steepest = row.windows(2).map(|pair| (pair[1] - pair[0]).abs() / CELL as f32).fold(0.0, f32::max);
    assert!((0.7..1.3).contains(&steepest), "walls of {steepest}");
}

#[test]
fn ground_without_heights_and_without_vents_is_left_alone() {
    let mut before = ground(60, 50, rough);
    before.row_mut(20)[10..40].fill(f32::NAN);
    let after =
        Lava::default().with_eruptions(5).with_volume([1e5, 1e6]).run(&before, None, &Progress::none()).unwrap();
    let lost = after.height.data().iter().filter(|height| height.is_nan()).count();
    assert_eq!(lost, 30);
    let none = Grid::filled(*before.window(), 0.0);
    let bare = run(&Lava::default(), &ground(60, 50, rough), &none);
    assert_eq!(bare.height.data(), ground(60, 50, rough).data());
    assert_eq!(bare.volumes, Volumes::default());
    let empty = Grid::filled(Window::new(0, 0, CELL), 0.0);
    assert!(Lava::default().run(&empty, None, &Progress::none()).is_ok());
}

#[test]
fn the_result_does_not_depend_on_threads_and_can_be_cancelled() {
    let before = ground(80, 70, rough);
    let law = Lava::default().with_eruptions(6).with_volume([1e5, 1e6]).with_caldera(200.0);
    let with = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| law.run(&before, None, &Progress::none()).unwrap())
    };
    assert_eq!(with(1), with(3));
    let progress = Progress::none();
    progress.cancel();
    let error = law.run(&before, None, &progress).unwrap_err();
    assert_eq!(error.kind(), ErrorKind::Cancelled);
}

#[test]
fn grids_of_other_windows_are_refused() {
    let before = ground(20, 20, rough);
    let vents = Grid::filled(Window::new(21, 20, CELL), 1.0);
    assert_eq!(Lava::default().run(&before, Some(&vents), &Progress::none()).unwrap_err().kind(), ErrorKind::Request);
}
