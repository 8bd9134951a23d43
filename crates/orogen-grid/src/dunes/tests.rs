use super::*;

const CELL: f64 = 8.0;

fn window(side: usize) -> Window {
    Window::new(side, side, CELL)
}

fn run(law: &Dunes, side: usize, sand: impl Fn(usize, usize) -> f32) -> SandyGround {
    let window = window(side);
    let mut supply = Grid::filled(window, 0.0);
    for j in 0..side {
        for i in 0..side {
            supply.row_mut(j)[i] = sand(i, j);
        }
    }
    law.run(&Grid::filled(window, 100.0), &supply, &Progress::none()).unwrap()
}

fn steepest(grid: &Grid) -> f64 {
    let mut steepest = 0.0f32;
    for j in 1..grid.height() - 1 {
        for i in 1..grid.width() - 1 {
            let east = grid.row(j)[i + 1] - grid.row(j)[i - 1];
            let south = grid.row(j + 1)[i] - grid.row(j - 1)[i];
            steepest = steepest.max((east * east + south * south).sqrt() / (2.0 * CELL as f32));
        }
    }
    libm::atan(f64::from(steepest)).to_degrees()
}

#[test]
fn thick_sand_becomes_transverse_ridges_with_slip_faces() {
    let dunes = run(&Dunes::default(), 96, |_, _| 5.0);
    let roughness = |across: bool| {
        let mut sum = 0.0;
        for j in 0..95 {
            for i in 0..95 {
                let row = dunes.height.row(j);
                let change = if across { dunes.height.row(j + 1)[i] - row[i] } else { row[i + 1] - row[i] };
                sum += change * change;
            }
        }
        sum
    };
    let (along, across) = (roughness(false), roughness(true));
    assert!(along > 3.0 * across, "{along} along the wind, {across} across it");
    let steepest = steepest(&dunes.height);
    assert!((28.0..36.0).contains(&steepest), "{steepest} degrees");
    let highest = dunes.sand.data().iter().copied().fold(0.0, f32::max);
    assert!((8.0..40.0).contains(&highest), "{highest} m");
    // Slip faces look to the east.
    let falls = |turn: f32| {
        let rows = (0..96).map(|j| dunes.height.row(j).windows(2));
        rows.flatten().filter(|pair| (pair[0] - pair[1]) * turn > 0.5 * CELL as f32).count()
    };
    assert!(falls(1.0) > 20 * falls(-1.0).max(1), "{} to the east and {} to the west", falls(1.0), falls(-1.0));
}

#[test]
fn sand_is_kept() {
    for spread in [0.0, 100.0] {
        let law = Dunes::default().with_wind_spread(spread).with_wind_direction(200.0).with_years(20.0);
        let window = window(64);
        let torus = Torus::new(&window, law.wavelength);
        let supply = Grid::filled(window, 2.0);
        let before: f64 =
            torus.closed(&law.scattered(&supply).unwrap()).iter().map(|sand| f64::from(*sand)).sum::<f64>();
        let heading = Heading::from(law.wind_direction, &torus);
        let land = torus.along(&heading, &torus.closed(&vec![0.0; window.len()]));
        let loose = torus.along(&heading, &torus.closed(&law.scattered(&supply).unwrap()));
        let mut state = wind::State::new(&law, &heading, CELL, 0.07, land, loose);
        (0..200).for_each(|_| state.step());
        state.calm();
        let after: f64 = state.sand.iter().map(|sand| f64::from(*sand)).sum();
        assert!((after / before - 1.0).abs() < 1e-4, "{before} and {after}");
    }
}

#[test]
fn a_heap_becomes_a_barchan() {
    let law = Dunes::default().with_years(20.0);
    let heap = |i: usize, j: usize| {
        let (x, y) = ((i as f32 - 24.0) * CELL as f32, (j as f32 - 48.0) * CELL as f32);
        (16.0 - 0.16 * (x * x + y * y).sqrt()).max(0.0)
    };
    let sand = run(&law, 96, heap).sand;
    let reach = |j: usize| sand.row(j).iter().rposition(|sand| *sand > 0.3);
    let rows: Vec<usize> = (0..96).filter(|j| sand.row(*j).iter().any(|sand| *sand > 0.3)).collect();
    let (top, bottom) = (rows[0], rows[rows.len() - 1]);
    let middle = (top + bottom) / 2;
    // Both horns are further downwind than the slip face between them.
    let horns = [top..middle, middle..bottom].map(|rows| rows.filter_map(reach).max());
    assert!(horns.iter().all(|horn| *horn > reach(middle).map(|face| face + 2)), "{horns:?} {:?}", reach(middle));
    let width = (bottom - top) as f64 * CELL;
    let highest = f64::from(sand.data().iter().copied().fold(0.0, f32::max));
    assert!((0.05..0.15).contains(&(highest / width)), "{highest} m high, {width} m wide");
    let steepest = steepest(&sand);
    assert!((28.0..36.0).contains(&steepest), "{steepest} degrees");
}

#[test]
fn the_result_does_not_depend_on_threads() {
    let law = Dunes::default().with_years(5.0).with_wind_direction(230.0).with_wind_spread(40.0);
    let with = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| run(&law, 48, |i, _| i as f32 * 0.1))
    };
    assert_eq!(with(1), with(3));
}

#[test]
fn winds_turn_with_the_world() {
    // The same field, turned by a right angle: rows are columns.
    let east = run(&Dunes::default().with_years(3.0).with_wavelength(1e5), 40, |i, j| {
        2.0 + ((i * 7 + j * 3) % 11) as f32 * 0.3
    });
    let south = run(&Dunes::default().with_years(3.0).with_wavelength(1e5).with_wind_direction(0.0), 40, |i, j| {
        2.0 + ((j * 7 + i * 3) % 11) as f32 * 0.3
    });
    let near = (0..40).all(|j| (0..40).all(|i| (east.sand.row(j)[i] - south.sand.row(i)[j]).abs() < 0.3));
    assert!(near);
}

#[test]
fn no_wind_and_no_sand_change_nothing_but_slopes() {
    let still = run(&Dunes::default().with_years(0.0), 40, |_, _| 0.0);
    assert!(still.height.data().iter().all(|height| *height == 100.0));
    let bare = run(&Dunes::default().with_years(10.0), 40, |_, _| 0.0);
    assert!(bare.sand.data().iter().all(|sand| *sand == 0.0));
}

#[test]
fn too_many_steps_are_refused() {
    let window = Window::new(4, 4, 0.1);
    let error = Dunes::default().run(&Grid::filled(window, 0.0), &Grid::filled(window, 1.0), &Progress::none());
    let message = error.unwrap_err().to_string();
    assert!(message.contains("larger cell"), "{message}");
}
