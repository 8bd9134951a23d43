//! Rivers drawn on the map: levels lead them along their lines.

use super::{around, bits, level_of_given, window};
use crate::grid::{Grid, Window};
use crate::hydrology::direction::NONE;
use crate::multiscale::continents::Continents;
use crate::multiscale::drawn_rivers::DrawnRivers;
use crate::multiscale::level::Level;
use crate::multiscale::refinement::Refinement;

/// An island of 28 km radius around the origin, with rivers that meet, that run side by side, turn back, and end in the
/// sea.
const RADIUS: f64 = 28e3;

/// Positions beside rivers: at a confluence, bends, mouths, and a short river.
const PLACES: [(f64, f64); 6] = [(5e3, 0.0), (4e3, 8e3), (7e3, 27e3), (-8e3, 7.4e3), (-16e3, -5e3), (21e3, 3.6e3)];

fn island() -> Continents {
    let refinement = Refinement::new(5).with_levels(6).with_details(3).with_drawn(true);
    Continents::new(5).with_refinement(refinement)
}

fn rivers() -> DrawnRivers {
    let flat = |line: &[[f64; 2]]| line.iter().map(|[x, y]| [*x, *y, 0.0]).collect::<Vec<_>>();
    let lines = [
        // A tributary before its main river, which it misses by 40 m.
        flat(&[[9e3, -16e3], [6.3e3, -9e3], [5.04e3, -0.4e3]]),
        vec![
            [-2e3, -14e3, 900.0],
            [1e3, -9.5e3, 600.0],
            [4.2e3, -6.1e3, 420.0],
            [5e3, -0.4e3, 200.0],
            [3e3, 4e3, 180.0],
            [5.7e3, 6.2e3, 90.0],
            [2.2e3, 8.1e3, 95.0],
            [6e3, 17e3, 30.0],
            [7e3, 31e3, 0.0],
        ],
        // Beside the main river, at a distance of less than a coarse cell, to the sea.
        flat(&[[7.2e3, 9e3], [8.1e3, 17e3], [9.4e3, 33e3]]),
        // Along the axes, and through corners of cells.
        flat(&[[-19_170.0, -7_650.0], [-15_330.0, -7_650.0], [-15_330.0, -3_810.0], [-30e3, 10_860.0]]),
        // A bend that nearly meets itself.
        flat(&[[-6e3, 6e3], [-9e3, 8e3], [-9.3e3, 8.6e3], [-6.5e3, 7.4e3], [-12e3, 12e3], [-21e3, 21e3]]),
        // Within one coarse cell.
        flat(&[[20.3e3, 3e3], [22.1e3, 3.4e3], [21.2e3, 4.4e3]]),
    ];
    DrawnRivers::new(&lines, 60.0)
}

/// The distance to the shore of the island, at the samples of a level.
fn shore(window: &Window) -> Grid {
    let mut grid = Grid::filled(*window, 0.0f32);
    for j in 0..window.height {
        for i in 0..window.width {
            let (x, y) = (window.x + i as i64, window.y + j as i64);
            let (x, y) = (x as f64 * window.cell, y as f64 * window.cell);
            grid[(i, j)] = (RADIUS - (x * x + y * y).sqrt()) as f32;
        }
    }
    grid
}

/// The level over a window, computed independently of other windows.
fn made(land: &Continents, rivers: &DrawnRivers, depth: usize, window: &Window) -> Level {
    level_of_given(land, &|_, window| shore(window), rivers, depth, window)
}

#[test]
fn windows_made_separately_are_crops_of_a_larger_one() {
    let (land, rivers) = (island(), rivers());
    for depth in [0, 1, 3, 5, 6, 7, 9] {
        for at in [(5e3, 7e3), (7e3, 28e3), (-8e3, 7.4e3), (-15.4e3, -7.5e3)] {
            let whole = around(&land, depth, at, 40);
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
fn every_level_leads_rivers_through_the_cells_of_their_lines() {
    let (land, rivers) = (island(), rivers());
    for depth in 0..=9 {
        for at in PLACES {
            let size = if depth < 3 { 24 } else { 80 };
            let level = made(&land, &rivers, depth, &around(&land, depth, at, size));
            let passages = rivers.passages(&land.refinement, depth, &level.window);
            let (mut crossed, mut led) = (0, 0);
            for (q, passage) in passages.left() {
                if level.receiver[q] >= NONE {
                    continue;
                }
                crossed += 1;
                led += usize::from(passages.is_led(&level, q) || level.downstream(q).is_none());
                // On the finest level of valleys rivers take shortcuts across corners, and soil creeps.
                if depth != 6 {
                    assert_eq!(level.receiver[q], passage.code, "level {depth}, {at:?}");
                    let least = passage.height;
                    assert!((least..least + 0.1).contains(&level.height[q]), "level {depth}, {at:?}");
                }
            }
            assert!(crossed > 0 || depth > 6, "level {depth}, {at:?}: no river");
            assert!(led * 4 >= crossed * 3, "level {depth}, {at:?}: {led} of {crossed} cells are led");
        }
    }
}

#[test]
fn heights_fall_along_drawn_rivers_and_beside_them() {
    let (land, rivers) = (island(), rivers());
    let (mut links, mut level_links) = (0, 0);
    for depth in 0..=9 {
        for at in PLACES {
            let size = if depth < 3 { 24 } else { 100 };
            let level = made(&land, &rivers, depth, &around(&land, depth, at, size));
            for (q, &receiver) in level.receiver.iter().enumerate() {
                assert!(level.height[q].is_finite() && level.height[q] < 5000.0 && level.area[q] >= 1.0);
                let Some(to) = level.downstream(q).filter(|_| receiver < NONE) else { continue };
                assert!(level.height[to] <= level.height[q], "level {depth}, {at:?}, {:?}", level.place(q));
                links += 1;
                level_links += usize::from(level.height[to] == level.height[q]);
            }
        }
    }
    // A drawn bed with hardly any slope is level to the precision of heights.
    assert!(level_links * 100_000 < links, "{level_links} of {links}");
}

#[test]
fn areas_of_drawn_rivers_grow_to_their_mouths() {
    let (land, rivers) = (island(), rivers());
    for depth in [0, 2, 4, 6, 8] {
        for at in [(4e3, 8e3), (6e3, 22e3)] {
            let level = made(&land, &rivers, depth, &around(&land, depth, at, if depth < 3 { 24 } else { 100 }));
            let passages = rivers.passages(&land.refinement, depth, &level.window);
            let cells = 1e6 / (level.window.cell * level.window.cell);
            let (mut seen, mut shrunk, mut least) = (0, 0, 1.0f32);
            for (q, passage) in passages.left().filter(|(q, _)| level.receiver[*q] < NONE) {
                let Some(to) = level.downstream(q) else { continue };
                seen += 1;
                // On coarse levels a tributary reaches the cells of its main river above their confluence.
                let is_same = passages.at(to).is_some_and(|next| next.river == passage.river && next.code < NONE);
                let kept = if is_same { level.area[to] / level.area[q] } else { 1.0 };
                shrunk += usize::from(kept < 0.99);
                least = least.min(kept);
                let (given, own) = (passage.area * cells, f64::from(level.area[q]));
                if depth != 6 && given > 4.0 {
                    assert!((0.99..4.0).contains(&(own / given)), "level {depth}, {at:?}: {own} instead of {given}");
                }
            }
            assert!(seen > 5, "level {depth}, {at:?}");
            // Natural tributaries on coarse levels can reach a river above their node.
            assert!(shrunk * 30 <= seen && least > 0.6, "level {depth}, {at:?}: {shrunk} of {seen} cells, {least}");
        }
    }
}

#[test]
fn the_cells_of_a_level_are_those_that_lines_cross() {
    let rivers = rivers();
    let land = island().refinement;
    for depth in [0, 1, 4, 6, 8] {
        let cell = land.cell_of(depth);
        let side = (64e3 / cell) as usize;
        let window = Window::new(side, side, cell).at(-(side as i64) / 2, -(side as i64) / 2);
        let passages = rivers.passages(&land, depth, &window);
        let mut touched = vec![false; window.len()];
        rivers.points(cell / 50.0, |[x, y]| {
            let at = |metres: f64| ((metres + 0.5 * land.cell) / cell).floor() as i64;
            let (i, j) = (at(x) - window.x, at(y) - window.y);
            if (0..side as i64).contains(&i) && (0..side as i64).contains(&j) {
                touched[j as usize * side + i as usize] = true;
            }
        });
        assert!((0..window.len()).all(|q| !touched[q] || passages.at(q).is_some()), "level {depth}");
        // The points miss cells of which a line cuts off a corner.
        let mut long = passages.left().filter(|(_, passage)| passage.length() > 0.05 * cell);
        assert!(long.all(|(q, _)| touched[q]), "level {depth}");
    }
}
