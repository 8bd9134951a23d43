//! A given shore that is binding on all levels, down to the finest.

use super::{around, bits, level_of_given, window};
use crate::grid::{Grid, Window};
use crate::hydrology::direction::NONE;
use crate::multiscale::continents::Continents;
use crate::multiscale::drawn_rivers::DrawnRivers;
use crate::multiscale::level::Level;
use crate::multiscale::refinement::Refinement;
use crate::progress::Progress;

/// An island around the origin with four straight sides, a round bay in one of them, and a small inland sea.
const SIDE: f64 = 26e3;
const BAY: ([f64; 2], f64) = ([16e3, 20e3], 5e3);
const INLAND: ([f64; 2], f64) = ([7e3, -5e3], 800.0);

/// Positions at the shore: on a side, at a corner, in the bay, at a cape of it, at the mouth of a drawn river, and at
/// the inland sea.
const PLACES: [(f64, f64); 6] =
    [(18.4e3, -18.4e3), (36.7e3, 0.0), (12.5e3, 16.5e3), (20.9e3, 16e3), (-18.4e3, 18.4e3), (7e3, -5.8e3)];

fn island() -> Continents {
    let refinement = Refinement::new(5).with_levels(6).with_details(4).with_shore_details(4).with_drawn(true);
    Continents::new(5).with_refinement(refinement)
}

fn rivers() -> DrawnRivers {
    let line = vec![[-3e3, 2e3, 300.0], [-11e3, 12.5e3, 120.0], [-18e3, 18.1e3, 2.0], [-20e3, 20e3, 0.0]];
    DrawnRivers::new(&[line], 60.0)
}

/// The distance to the shore of the island, in metres.
fn distance(x: f64, y: f64) -> f64 {
    let side = SIDE - (x.abs() + y.abs()) * std::f64::consts::FRAC_1_SQRT_2;
    let beyond = |([east, south], radius): ([f64; 2], f64)| libm::hypot(x - east, y - south) - radius;
    side.min(beyond(BAY)).min(beyond(INLAND))
}

fn sampled(land: &Continents, depth: usize, window: &Window) -> Grid {
    let samples = land.refinement.samples_at(depth, window);
    let metres = |index: i64| index as f64 * window.cell;
    let rows = (samples.y..samples.bottom()).flat_map(|y| (samples.x..samples.right()).map(move |x| (x, y)));
    Grid::from_data(*window, rows.map(|(x, y)| distance(metres(x), metres(y)) as f32).collect()).unwrap()
}

/// The level over a window, computed independently of other windows.
fn made(land: &Continents, rivers: &DrawnRivers, depth: usize, window: &Window) -> Level {
    level_of_given(land, &|depth, window| sampled(land, depth, window), rivers, depth, window)
}

#[test]
fn windows_made_separately_are_crops_of_a_larger_one() {
    let (land, rivers) = (island(), rivers());
    for depth in [1, 3, 4, 6, 7, 8, 10] {
        for at in PLACES {
            let whole = land.refinement.nodes_at(depth, &around(&land, depth, at, 40));
            let level = made(&land, &rivers, depth, &whole);
            for (x, y, width, height) in [(0, 0, 1, 1), (3, 9, 20, 11), (17, 21, 23, 19)] {
                let part = window(&land, depth, (whole.x + x, whole.y + y), (width, height));
                let crop = level.crop(&part).unwrap();
                assert!(bits(&crop) == bits(&made(&land, &rivers, depth, &part)), "level {depth}, {at:?}, {part:?}");
            }
        }
    }
}

#[test]
fn the_shore_is_within_a_cell_of_the_given_one_on_every_level() {
    let (land, rivers) = (island(), rivers());
    for depth in 3..=10 {
        let cell = land.refinement.cell_of(depth);
        for at in PLACES {
            let samples = around(&land, depth, at, 100);
            let nodes = land.refinement.nodes_at(depth, &samples).grown(Refinement::SURFACE_REACH);
            let level = made(&land, &rivers, depth, &nodes);
            let surface = land.refinement.surface(&level, &samples, &Progress::none()).unwrap();
            let (mut wrong, mut land_near, mut sea) = (0, 0, 0);
            for (j, y) in (samples.y..samples.bottom()).enumerate() {
                for (i, x) in (samples.x..samples.right()).enumerate() {
                    let distance = distance(x as f64 * cell, y as f64 * cell);
                    let is_sea = surface.water_level[(i, j)] == 0.0;
                    sea += usize::from(is_sea);
                    wrong += usize::from(is_sea != (distance < 0.0) && distance.abs() > cell);
                    // There is no cliff: next to the shore land is not steeper than hillsides are.
                    if !is_sea && distance < 2.0 * cell {
                        land_near += 1;
                        assert!(surface.height[(i, j)] < (4.0 * cell) as f32, "level {depth}, {at:?}");
                    }
                }
            }
            assert!(sea > 0 && land_near > 0, "level {depth}, {at:?}: {sea}, {land_near}");
            assert!(wrong * 1000 <= samples.len(), "level {depth}, {at:?}: {wrong} samples are wrong");
        }
    }
}

#[test]
fn rivers_fall_to_the_sea() {
    let (land, rivers) = (island(), rivers());
    for depth in 1..=10 {
        for at in PLACES {
            let nodes = land.refinement.nodes_at(depth, &around(&land, depth, at, 80));
            let level = made(&land, &rivers, depth, &nodes);
            let mut lakes = 0;
            for (q, &receiver) in level.receiver.iter().enumerate() {
                assert!(level.height[q].is_finite() && level.height[q] >= 0.0 && level.area[q] >= 1.0);
                lakes += usize::from(level.is_inland(q));
                let Some(to) = level.downstream(q).filter(|_| receiver < NONE) else { continue };
                assert!(level.height[to] <= level.height[q], "level {depth}, {at:?}, {:?}", level.place(q));
            }
            assert!(lakes * 100 <= level.window.len(), "level {depth}, {at:?}: {lakes} nodes of lakes");
        }
    }
}

#[test]
fn only_the_levels_that_are_asked_for_read_the_shore() {
    let land = Refinement::new(1).with_levels(6).with_details(4).with_shore_details(2);
    let reads: Vec<bool> = (5..=10).map(|depth| land.reads_shore(depth)).collect();
    assert_eq!(reads, [true, true, true, true, false, false]);
    assert!(land.is_shore_binding() && !land.with_shore_details(0).is_shore_binding());
}
