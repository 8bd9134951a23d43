//! Floods and sediment of a river in a valley with plane sides.

use crate::grid::{Grid, Window};
use crate::hydrology::direction::NONE;
use crate::hydrology::rivers::Channel;
use crate::multiscale::level::Level;
use crate::multiscale::refinement::Refinement;
use crate::multiscale::surface::Surface;
use crate::progress::Progress;

const SIDE: usize = 300;
const CELL: f64 = 60.0;

/// Drainage area of the river, in cells.
const AREA: f32 = 1e6;

/// A river along the middle column, which falls to the south by a metre per cell. `side` is the height of the ground
/// above it at a distance in cells. All ground drains straight to the river. In the south there is a lake.
fn valley(side: impl Fn(i64) -> f32) -> (Refinement, Level) {
    let land = Refinement::default().with_levels(0).with_cell(CELL);
    let window = Window::new(SIDE, SIDE, CELL).at(-150, -150);
    let plane = |value: f32| vec![value; window.len()];
    let mut level = Level {
        depth: 0,
        window,
        east: plane(0.5),
        south: plane(0.5),
        height: plane(0.0),
        area: plane(1.0),
        receiver: vec![NONE; window.len()],
        variation: plane(0.0),
        uplift: plane(0.0),
        shore: plane(1.0),
    };
    for q in 0..window.len() {
        let (x, y) = ((q % SIDE) as i64 - 150, (q / SIDE) as i64 - 150);
        level.height[q] = 500.0 - y as f32 + side(x.abs());
        level.receiver[q] = if x > 0 { 4 } else { 0 };
        if x == 0 {
            (level.area[q], level.receiver[q]) = (AREA, 2);
        }
        if y > 10 {
            (level.height[q], level.receiver[q], level.shore[q]) = (485.0, NONE, -2.0);
        }
    }
    (land, level)
}

fn surface(land: &Refinement, level: &Level) -> Surface {
    land.surface(level, &Window::new(40, 20, CELL).at(-20, -6), &Progress::none()).unwrap()
}

fn floods(land: &Refinement, level: &Level) -> Grid {
    land.floodplain(0.0, level, &surface(land, level), 1e8, &Channel::default(), &Progress::none()).unwrap()
}

#[test]
fn floods_are_as_wide_as_the_slopes_of_the_valley_let_them() {
    let area = f64::from(AREA) * CELL * CELL;
    let depth = Channel::default().depth_of(Channel::default().discharge(area)) as f32;
    for slope in [0.3f32, 1.0, 100.0] {
        let (land, level) = valley(|cells| slope * cells as f32);
        let made = floods(&land, &level);
        for j in 0..20 {
            for i in 0..40 {
                let (x, y) = (i as i64 - 20, j as i64 - 6);
                // The flood rises above the banks by three times the depth of the river.
                let wanted = if x == 0 { 4.0 * depth } else { (3.0 * depth - slope * x.abs() as f32).max(0.0) };
                let wanted = if y > 10 { 0.0 } else { wanted };
                assert!((made[(i, j)] - wanted).abs() < 1e-3, "({x}, {y}): {} m, not {wanted}", made[(i, j)]);
            }
        }
    }
}

#[test]
fn a_river_that_joins_a_larger_one_rises_by_its_flood_and_ways_without_a_river_are_dry() {
    let (land, mut level) = valley(|cells| 0.05 * cells as f32);
    let at = |x: i64, y: i64| ((y + 150) * 300 + x + 150) as usize;
    // A brook that joins the river from the east, along y = 0, and a circle of receivers in the north-west.
    (1..=60).for_each(|x| level.area[at(x, 0)] = 3e5);
    (level.receiver[at(-5, -3)], level.receiver[at(-6, -3)]) = (4, 0);
    let made = floods(&land, &level);
    let depth = |x: i64, y: i64| made[((x + 20) as usize, (y + 6) as usize)];
    let own = made.data().iter().fold(0.0f32, |most, depth| most.max(*depth)) * libm::powf(0.3, 0.4);
    assert!(depth(1, 0) > 1.1 * own, "{} m, {own} m by itself", depth(1, 0));
    for x in 2..19 {
        assert!(depth(x, 0) <= depth(x - 1, 0) && depth(x, 0) > 0.99 * own, "{x}: {}", depth(x, 0));
    }
    assert_eq!([depth(-5, -3), depth(-6, -3), depth(-12, -3)], [0.0; 3]);
    assert!(depth(-4, -3) > 0.0);
}

#[test]
fn sediment_lies_on_floors_and_ends_without_a_step() {
    // Floors of 4 and 10 cells on each side, between hillsides.
    for floor in [4, 10] {
        let (land, level) = valley(|cells| 0.3 * cells.min(floor) as f32 + 30.0 * (cells - floor).max(0) as f32);
        let made = land.sediment(0.0, &level, &surface(&land, &level), &Progress::none()).unwrap();
        let thickness = |x: i64, y: i64| made[((x + 20) as usize, (y + 6) as usize)];
        for y in -6..=8 {
            for x in 0..19 {
                let (here, next) = (thickness(x, y), thickness(x + 1, y));
                assert!((here - next).abs() <= 0.25 * CELL as f32 + 0.01, "({x}, {y}): {here} m beside {next} m");
                assert!(if x > floor { here == 0.0 } else { x == floor || here > 1.0 }, "({x}, {y}): {here} m");
                assert_eq!(here, thickness(-x, y));
            }
        }
        assert!(thickness(0, 0) > thickness(floor - 1, 0));
        assert!((11..14).all(|y| (-20..20).all(|x| thickness(x, y) == 0.0)), "sediment in the lake");
    }
    let (land, level) = valley(|cells| 30.0 * cells as f32);
    let made = land.sediment(0.0, &level, &surface(&land, &level), &Progress::none()).unwrap();
    assert!(made.data().iter().all(|thickness| *thickness == 0.0), "sediment without a floor");
}
