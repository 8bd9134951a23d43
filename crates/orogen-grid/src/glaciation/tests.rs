use super::{Glaciated, Glaciation, Glaciers};
use crate::grid::{Grid, Window};
use crate::progress::Progress;

const CELL: f64 = 60.0;

/// A straight valley with V-shaped sides that falls to the east, with a river in its middle, and the ice that passes.
struct Valley {
    height: Grid,
    receiver: Grid,
    ice: Grid,
    line: Grid,
}

fn grid(window: Window, of: impl Fn(i64, i64) -> f32) -> Grid {
    let mut grid = Grid::filled(window, 0.0f32);
    for j in 0..window.height {
        let row = grid.row_mut(j).iter_mut().enumerate();
        row.for_each(|(i, sample)| *sample = of(window.x + i as i64, window.y + j as i64));
    }
    grid
}

impl Valley {
    /// `ice` is that of the river in km^2, by its column.
    fn new(window: Window, ice: impl Fn(i64) -> f32) -> Valley {
        let metres = |steps: i64| steps as f32 * CELL as f32;
        Valley {
            height: grid(window, |x, y| 3000.0 - 0.02 * metres(x) + 0.7 * metres(y.abs())),
            receiver: grid(window, |_, y| match y.signum() {
                0 => 0.0,
                1 => 6.0,
                _ => 2.0,
            }),
            ice: grid(window, |x, y| if y == 0 { ice(x) * 1e6 } else { 0.1e6 }),
            line: grid(window, |_, _| 1000.0),
        }
    }

    fn land(&self) -> Glaciated<'_> {
        Glaciated { height: &self.height, receiver: &self.receiver, ice: &self.ice, equilibrium_line: &self.line }
    }

    fn shaped(&self, glaciation: &Glaciation) -> Grid {
        glaciation.run(&self.land(), &Progress::none()).unwrap()
    }
}

/// A window around sample (0, 0) whose result has this size.
fn around(columns: usize, rows: usize, halo: usize) -> Window {
    Window::new(columns, rows, CELL).at(-(columns as i64) / 2, -(rows as i64) / 2).grown(halo)
}

#[test]
fn a_glacier_makes_a_trough() {
    let glaciation = Glaciation::default();
    let window = around(21, 61, glaciation.halo(CELL));
    let valley = Valley::new(window, |_| 20.0);
    let ground = valley.shaped(&glaciation);
    let before = |j: usize| valley.height.crop(ground.window()).unwrap().row(j)[10];
    let after = |j: usize| ground.row(j)[10];
    // The river is the row 30; the trough is 80 * 20^0.35 = 228 m deep, before its variation and the smoothing.
    let lowered = before(30) - after(30);
    assert!((60.0..400.0).contains(&lowered), "{lowered}");
    // The floor is flatter than the sides were, and the walls are steeper.
    assert!(after(32) - after(30) < 0.2 * (before(32) - before(30)));
    assert!(after(40) - after(38) > before(40) - before(38));
    // Far from the glacier nothing changes.
    assert_eq!([after(0), after(60)], [before(0), before(60)]);
}

#[test]
fn land_without_ice_stays() {
    let glaciation = Glaciation::default();
    let valley = Valley::new(around(9, 9, glaciation.halo(CELL)), |_| 0.5);
    let ground = valley.shaped(&glaciation);
    assert_eq!(ground, valley.height.crop(ground.window()).unwrap());
}

#[test]
fn moraines_cross_the_valley_where_a_glacier_ends() {
    let glaciation = Glaciation::default().with_depth(0.0);
    let ice = |x: i64| (20.0 - 0.5 * x as f32).max(-5.0);
    let window = around(121, 21, glaciation.halo(CELL));
    let valley = Valley::new(window, ice);
    let with = valley.shaped(&glaciation);
    let without = valley.shaped(&glaciation.with_moraines(0.0));
    let raised = |i: usize| (0..with.height()).map(|j| with.row(j)[i] - without.row(j)[i]).fold(0.0, f32::max);
    // The glacier ends at column 38, which is 98 in the window.
    assert_eq!(raised(5), 0.0);
    assert!(raised(97) > 10.0, "{}", raised(97));
    let lowered = with.data().iter().zip(without.data()).any(|(with, without)| with < without);
    assert!(!lowered, "moraines and outwash only raise the ground");
}

#[test]
fn a_part_equals_the_crop() {
    let glaciation = Glaciation::default().with_seed(3);
    let halo = glaciation.halo(CELL);
    let ice = |x: i64| 30.0 - 0.3 * x as f32;
    let whole = Valley::new(around(150, 60, halo), ice).shaped(&glaciation);
    let window = Window::new(17, 23, CELL).at(21, -12);
    let part = Valley::new(window.grown(halo), ice).shaped(&glaciation);
    assert_eq!(part, whole.crop(&window).unwrap());
}

#[test]
fn ice_fills_its_valley_to_one_level() {
    let glaciers = Glaciers::default().with_firn(0.0);
    let valley = Valley::new(around(9, 41, glaciers.halo(CELL)), |_| 10.0);
    let ice = glaciers.run(&valley.land(), &Progress::none()).unwrap();
    let thick = ice.row(20)[4];
    // 100 kPa / (0.917 * 9.81 kPa/m * 0.8 * 0.04), as the valley falls by less than the least slope.
    assert!((thick - 347.0).abs() < 10.0, "{thick}");
    // The sides rise by 42 m a sample.
    let side = ice.row(24)[4];
    assert!((thick - side - 4.0 * 42.0).abs() < 10.0, "{side}");
    assert_eq!(ice.row(40)[4], 0.0);
}

#[test]
fn grids_must_fit_each_other() {
    let valley = Valley::new(around(3, 3, 200), |_| 5.0);
    let other = Grid::filled(Window::new(3, 3, CELL), 0.0);
    let land = Glaciated { ice: &other, ..valley.land() };
    assert!(Glaciation::default().run(&land, &Progress::none()).is_err());
    assert!(Glaciers::default().run(&land, &Progress::none()).is_err());
}
