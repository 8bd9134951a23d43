//! Ridges and summits drawn on the map: they have their heights on every level.

use super::{around, bits, window};
use crate::grid::{Grid, Window};
use crate::hydrology::direction::NONE;
use crate::multiscale::continents::Continents;
use crate::multiscale::drawn_ridges::DrawnRidges;
use crate::multiscale::given::Given;
use crate::multiscale::level::Level;
use crate::multiscale::refinement::Refinement;
use crate::progress::Progress;

/// An island of 28 km radius around the origin.
const RADIUS: f64 = 28e3;

fn island(seed: u64) -> Continents {
    let refinement = Refinement::new(seed).with_levels(6).with_details(3).with_ridges(true);
    Continents::new(seed).with_refinement(refinement)
}

/// A main ridge, one that leaves it, a low one beside the sea, and two summits, one of them on the main ridge.
fn ridges() -> DrawnRidges {
    DrawnRidges::new(&[
        vec![[-14e3, -9e3, 700.0], [-7e3, -4e3, 1500.0], [1e3, -5e3, 2100.0], [8e3, -1e3, 1600.0], [15e3, 2e3, 600.0]],
        vec![[1e3, -5e3, 2100.0], [3e3, -11e3, 1400.0], [2.5e3, -17e3, 500.0]],
        vec![[-16e3, 11e3, 150.0], [-9e3, 15e3, 220.0], [-2e3, 18e3, 120.0]],
        vec![[5.2e3, 13.1e3, 900.0]],
        vec![[-7e3, -4e3, 1700.0]],
    ])
}

/// Positions beside ridges.
const PLACES: [(f64, f64); 6] = [(0.0, -4e3), (7e3, -1e3), (-8e3, -5e3), (2.8e3, -12e3), (-9e3, 15e3), (5e3, 13e3)];

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
fn made(land: &Continents, ridges: &DrawnRidges, depth: usize, window: &Window) -> Level {
    let refinement = &land.refinement;
    let reach = if depth == 0 { land.coarsest_reach() } else { refinement.given_reach(depth) };
    let sampled = shore(&window.grown(reach));
    let given = Given { shore: Some(&sampled), ridges: Some(ridges), ..Given::default() };
    if depth == 0 {
        return land.coarsest(&given, window, &Progress::none()).unwrap();
    }
    let parent = made(land, ridges, depth - 1, &refinement.parent_window(depth, window));
    land.refine(&parent, &given, window, &Progress::none()).unwrap()
}

#[test]
fn windows_made_separately_are_crops_of_a_larger_one() {
    let (land, ridges) = (island(5), ridges());
    for depth in [0, 1, 3, 6, 7, 9] {
        for at in [(1e3, -5e3), (5e3, 13e3)] {
            let whole = around(&land, depth, at, 40);
            let level = made(&land, &ridges, depth, &whole);
            for (x, y, width, height) in [(3, 9, 20, 11), (17, 21, 23, 19), (20, 20, 1, 1)] {
                let part = window(&land, depth, (whole.x + x, whole.y + y), (width, height));
                let crop = level.crop(&part).unwrap();
                assert!(bits(&crop) == bits(&made(&land, &ridges, depth, &part)), "level {depth}, {at:?}, {part:?}");
            }
        }
    }
}

#[test]
fn ridges_have_their_heights_on_every_level() {
    let ridges = ridges();
    for seed in [5, 6, 7] {
        let land = island(seed);
        for depth in 0..=9 {
            let (mut errors, mut beside) = (Vec::new(), Vec::new());
            for at in PLACES {
                let size = if depth < 3 { 24 } else { 80 };
                let level = made(&land, &ridges, depth, &around(&land, depth, at, size));
                for (q, &receiver) in level.receiver.iter().enumerate() {
                    assert!(level.height[q].is_finite() && level.height[q] < 1e4, "level {depth}, {at:?}");
                    let Some(to) = level.downstream(q).filter(|_| receiver < NONE) else { continue };
                    assert!(level.height[to] <= level.height[q], "level {depth}, {at:?}, {:?}", level.place(q));
                }
                for crest in ridges.crests(&land.refinement, depth, &level.window) {
                    let q = crest.q;
                    if level.receiver[q] >= NONE {
                        continue;
                    }
                    errors.push((level.height[q] / crest.height - 1.0).abs());
                    // Nothing drains over a ridge.
                    assert!(level.area[q] < 1.5, "level {depth}, {at:?}, {:?}", level.place(q));
                    let (i, j, width) = (q % size, q / size, size);
                    if i > 0 && j > 0 && i + 1 < width && j + 1 < width {
                        beside.extend([q - 1, q + 1, q - width, q + width].map(|o| level.height[o] / crest.height));
                    }
                }
            }
            errors.sort_by(f32::total_cmp);
            beside.sort_by(f32::total_cmp);
            // On the level whose nodes are on the lattice, ridges are between nodes.
            let median = if depth == 6 { 0.008 } else { 0.0 };
            let beyond = errors.iter().filter(|error| **error > 0.01).count();
            println!(
                "seed {seed}, level {depth}: {beyond} of {} crests by more than 1 %, {:?}",
                errors.len(),
                errors.last()
            );
            assert!(errors.len() > 50 && errors[errors.len() / 2] <= median && beyond * 20 <= errors.len());
            // The land beside them is not higher, except beside low ridges on coarse levels.
            let most = if depth < 3 { 1.4 } else { 1.05 };
            assert!(beside[beside.len() * 9 / 10] < most, "level {depth}: {}", beside[beside.len() * 9 / 10]);
        }
    }
}

#[test]
fn a_ridge_without_height_is_refused() {
    let (land, flat) = (island(5), DrawnRidges::new(&[vec![[0.0, 0.0, 9.0]], vec![[0.0, 0.0, 0.0], [9.0, 9.0, 0.0]]]));
    let given = Given { ridges: Some(&flat), ..Given::default() };
    let error = land.coarsest(&given, &around(&land, 0, (0.0, 0.0), 4), &Progress::none()).unwrap_err();
    assert!(error.to_string().contains("ridge 2 has no height"), "{error}");
}
