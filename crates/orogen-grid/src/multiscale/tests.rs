//! Properties of all levels: windows agree, and water flows down.

mod binding;
mod details;
mod drawn;
mod floors;
mod lakes;
mod rain;
mod reach;
mod ridges;

use super::continents::Continents;
use super::drawn_rivers::DrawnRivers;
use super::given::Given;
use super::level::Level;
use super::refinement::Refinement;
use crate::error::ErrorKind;
use crate::grid::{Grid, Window};
use crate::hydrology::direction::{NONE, STEPS};
use crate::progress::Progress;
use crate::random::mix64;

/// The level over a window, computed independently of other windows.
fn level(land: &Continents, depth: usize, window: &Window) -> Level {
    let windows: Vec<Window> = (0..depth)
        .rev()
        .scan(*window, |below, above| {
            *below = land.refinement.parent_window(above + 1, below);
            Some(*below)
        })
        .collect();
    let coarsest = windows.last().unwrap_or(window);
    let mut level = land.coarsest(&Given::default(), coarsest, &Progress::none()).unwrap();
    for window in windows.iter().rev().skip(1).chain((depth > 0).then_some(window)) {
        level = land.refine(&level, &Given::default(), window, &Progress::none()).unwrap();
    }
    level
}

fn window(land: &Continents, depth: usize, at: (i64, i64), size: (usize, usize)) -> Window {
    Window::new(size.0, size.1, land.refinement.cell_of(depth)).at(at.0, at.1)
}

/// The level over a window of nodes of land with a given shore and drawn rivers, computed independently of other
/// windows. `shore` samples the distance to the shore over a window of a level.
fn level_of_given(
    land: &Continents,
    shore: &dyn Fn(usize, &Window) -> Grid,
    rivers: &DrawnRivers,
    depth: usize,
    window: &Window,
) -> Level {
    let refinement = &land.refinement;
    let reach = if depth == 0 { Continents::COARSEST_REACH } else { refinement.given_reach(depth) };
    let sampled = shore(depth, &window.grown(reach));
    let given = Given { shore: Some(&sampled), rivers: Some(rivers), ..Given::default() };
    if depth == 0 {
        return land.coarsest(&given, window, &Progress::none()).unwrap();
    }
    let above = refinement.parent_window(depth, window);
    let parent = level_of_given(land, shore, rivers, depth - 1, &above);
    land.refine(&parent, &given, window, &Progress::none()).unwrap()
}

/// A window of `size` samples of a level with its middle near a position in metres.
fn around(land: &Continents, depth: usize, at: (f64, f64), size: usize) -> Window {
    let cell = land.refinement.cell_of(depth);
    let corner = |at: f64| (at / cell) as i64 - size as i64 / 2;
    window(land, depth, (corner(at.0), corner(at.1)), (size, size))
}

/// The bits of all planes.
fn bits(level: &Level) -> Vec<Vec<u32>> {
    level.clone().into_planes().iter().map(|plane| plane.data().iter().map(|value| value.to_bits()).collect()).collect()
}

/// A position on land, in samples of a level, with relief, rivers and a shore nearby.
fn coast(depth: usize) -> (i64, i64) {
    let at = |finest: i64| (finest << depth) >> 11;
    (at(-6_272), at(-10_752))
}

#[test]
fn windows_made_separately_are_crops_of_a_larger_one() {
    let land = Continents::new(1);
    for (depth, is_far) in [(0, true), (1, false), (6, true), (10, false), (11, true)] {
        let far = 160_000_000_000_i64 >> (11 - depth);
        let positions = [coast(depth), (-far, far + 1)];
        for at in positions.into_iter().take(1 + usize::from(is_far)) {
            let whole = level(&land, depth, &window(&land, depth, at, (41, 35)));
            let parts = [((at.0, at.1), (1, 1)), ((at.0 + 3, at.1 + 7), (20, 11))];
            for (at, size) in parts {
                let part = window(&land, depth, at, size);
                assert!(
                    bits(&whole.crop(&part).unwrap()) == bits(&level(&land, depth, &part)),
                    "level {depth}, {part:?}"
                );
            }
        }
    }
}

#[test]
fn the_bits_are_the_same_on_every_machine() {
    let land = Continents::new(1);
    let level = level(&land, 11, &window(&land, 11, coast(11), (24, 24)));
    let fold = |state: u64, bits: &u32| mix64(state ^ u64::from(*bits));
    let hash = bits(&level).iter().flatten().fold(0, fold);
    assert_eq!(hash, 11_489_162_219_910_014_173);
}

#[test]
fn a_parent_that_covers_too_little_is_refused_and_more_changes_nothing() {
    let land = Continents::new(3);
    for depth in [5, 11] {
        let window = window(&land, depth, coast(depth), (9, 8));
        let needed = land.refinement.parent_window(depth, &window);
        let parent = level(&land, depth - 1, &needed.grown(2));
        let exact = land.refine(&parent.crop(&needed).unwrap(), &Given::default(), &window, &Progress::none()).unwrap();
        assert!(bits(&land.refine(&parent, &Given::default(), &window, &Progress::none()).unwrap()) == bits(&exact));
        let less = parent.crop(&needed.shrunk(1)).unwrap();
        assert_eq!(
            land.refine(&less, &Given::default(), &window, &Progress::none()).unwrap_err().kind(),
            ErrorKind::Request
        );
        // Nodes beyond the reach have no effect.
        let mut changed = parent.clone();
        changed.height[0] += 100.0;
        changed.receiver[3] = NONE;
        assert!(bits(&land.refine(&changed, &Given::default(), &window, &Progress::none()).unwrap()) == bits(&exact));
    }
}

#[test]
fn heights_fall_along_receivers_to_water_or_out_of_the_window() {
    for (seed, depth) in [(1, 2), (1, 9), (1, 10), (1, 11), (2, 3)] {
        let land = Continents::new(seed);
        let level = level(&land, depth, &window(&land, depth, coast(depth), (150, 140)));
        let (width, height) = (level.window.width, level.window.height);
        for (q, &receiver) in level.receiver.iter().enumerate() {
            assert!(level.height[q].is_finite() && level.height[q] < 12_000.0 && level.area[q] >= 1.0);
            let Some((east, south)) = STEPS.get(usize::from(receiver)) else {
                // Water is level, so it has no receiver.
                assert!(receiver == NONE && level.shore[q] < 0.0);
                continue;
            };
            let (i, j) = ((q % width).wrapping_add_signed(*east), (q / width).wrapping_add_signed(*south));
            if i < width && j < height {
                // Strictly falling heights exclude cycles, and every path ends in water or outside.
                let below = level.height[j * width + i];
                assert!(below < level.height[q], "level {depth}: {below} below {}", level.height[q]);
            }
        }
    }
}

#[test]
fn planes_are_the_whole_level() {
    let land = Continents::new(7);
    let level = level(&land, 3, &window(&land, 3, coast(3), (8, 5)));
    let planes = level.clone().into_planes();
    assert_eq!(planes.len(), Level::PLANES);
    let planes: Vec<_> = planes.iter().collect();
    assert_eq!(Level::from_planes(3, &planes).unwrap(), level);
    assert!(Level::from_planes(3, &planes[1..]).is_err());
    let mut wrong = level.clone().into_planes();
    wrong[4].data_mut()[2] = 8.5;
    assert!(Level::from_planes(3, &wrong.iter().collect::<Vec<_>>()).is_err());
}

#[test]
fn worlds_differ_by_seed() {
    let [one, two] = [1, 2].map(|seed| {
        let land = Continents::new(seed);
        level(&land, 2, &window(&land, 2, (0, 0), (40, 40)))
    });
    assert_ne!(one.receiver, two.receiver);
    assert_ne!(one.shore, two.shore);
}

#[test]
fn parameters_out_of_range_and_wrong_windows_are_errors() {
    let land = Continents::new(1);
    let good = window(&land, 0, (0, 0), (2, 2));
    let none = Progress::none();
    assert!(land.coarsest(&Given::default(), &good, &none).is_ok());
    let empty = window(&land, 0, (0, 0), (0, 2));
    let far = window(&land, 0, (i64::MAX, 0), (2, 2));
    for wrong in [empty, far, Window { cell: 1.0, ..good }] {
        assert_eq!(land.coarsest(&Given::default(), &wrong, &none).unwrap_err().kind(), ErrorKind::Request);
    }
    let (cell, wide) = (good.cell, window(&land, 0, (0, 0), (1 << 25, 2)));
    for (wrong, expect) in [
        (empty, "a window of 0 x 2 samples is empty".to_string()),
        (
            wide,
            format!(
                "the level with a cell of {cell} m is needed over 33554432 x 2 samples; a level is made over at most 16777216 samples a side"
            ),
        ),
        (window(&land, 0, (0, -(1 << 51)), (2, 2)), "levels end".to_string()),
        (far, "after 2^50 samples".to_string()),
    ] {
        let said = land.coarsest(&Given::default(), &wrong, &none).unwrap_err().to_string();
        assert!(said.contains(&expect), "{said}");
    }
    let wrong = [
        land.with_land(1.5),
        land.with_refinement(land.refinement.with_cell(f64::NAN)),
        land.with_refinement(land.refinement.with_relief(0.0)),
        land.with_size(-1.0),
        land.with_refinement(land.refinement.with_levels(99)),
        land.with_refinement(land.refinement.with_creep(-1.0)),
        land.with_refinement(land.refinement.with_variation(f64::NAN)),
    ];
    for land in wrong {
        assert!(land.coarsest(&Given::default(), &good, &none).is_err());
    }
    let cancelled = Progress::none();
    cancelled.cancel();
    assert_eq!(land.coarsest(&Given::default(), &good, &cancelled).unwrap_err().kind(), ErrorKind::Cancelled);
}

#[test]
fn surfaces_are_finite_and_agree_between_windows() {
    let land = Continents::new(1);
    for depth in [2, 9, 11] {
        let whole = window(&land, depth, coast(depth), (60, 50));
        let nodes = level(&land, depth, &whole.grown(Refinement::SURFACE_REACH));
        let surface = land.refinement.surface(&nodes, &whole, &Progress::none()).unwrap();
        let finite = [&surface.height, &surface.flow, &surface.lake_depth];
        assert!(finite.iter().all(|grid| grid.data().iter().all(|value| value.is_finite())));
        let part = window(&land, depth, (whole.x + 5, whole.y + 9), (17, 3));
        let alone = land
            .refinement
            .surface(&level(&land, depth, &part.grown(Refinement::SURFACE_REACH)), &part, &Progress::none())
            .unwrap();
        assert_eq!(surface.height.crop(&part).unwrap(), alone.height);
        assert_eq!(surface.flow.crop(&part).unwrap(), alone.flow);
        for (q, &level) in surface.water_level.data().iter().enumerate() {
            assert!(level.is_nan() || level > surface.height.data()[q]);
        }
        assert!(land.refinement.surface(&nodes, &whole.grown(1), &Progress::none()).is_err());
    }
}

#[test]
fn more_relief_is_higher_and_more_land_is_land() {
    let count = |land: Continents| {
        let level = level(&land, 1, &window(&land, 1, (-60, -60), (120, 120)));
        let dry = level.receiver.iter().filter(|&&receiver| receiver < NONE).count();
        let sum: f64 = level.height.iter().map(|&height| f64::from(height)).sum();
        (dry, sum)
    };
    let land = Continents::new(5);
    let (dry, sum) = count(land);
    assert!(count(land.with_refinement(land.refinement.with_relief(2.0))).1 > 1.5 * sum);
    assert!(count(land.with_land(0.6)).0 > dry && count(land.with_land(0.2)).0 < dry);
}

/// The number of links from nodes with more than `least` cells of drainage area, and the shares of the area that are
/// lost where it decreases downstream.
fn lost_areas(level: &Level, least: f32) -> (usize, Vec<f32>) {
    let (width, height) = (level.window.width, level.window.height);
    let (mut links, mut lost) = (0, Vec::new());
    for (q, &receiver) in level.receiver.iter().enumerate() {
        let Some((east, south)) = STEPS.get(usize::from(receiver)) else { continue };
        let (i, j) = ((q % width).wrapping_add_signed(*east), (q / width).wrapping_add_signed(*south));
        if i < width && j < height && level.area[q] > least && level.receiver[j * width + i] < NONE {
            links += 1;
            let share = 1.0 - level.area[j * width + i] / level.area[q];
            lost.extend((share > 0.0).then_some(share));
        }
    }
    (links, lost)
}

#[test]
fn drainage_areas_grow_downstream() {
    for (seed, depth) in [(1, 3), (1, 6), (1, 9), (1, 10), (1, 11), (2, 3), (2, 6)] {
        let land = Continents::new(seed);
        let level = level(&land, depth, &window(&land, depth, coast(depth), (300, 300)));
        for least in [30.0, 300.0, 3000.0] {
            let (links, lost) = lost_areas(&level, least);
            assert!(links > 500 || least > 30.0, "level {depth}: too few rivers to tell");
            // Where rivers of the level above have moved, areas are carried down with a small error.
            let much = lost.iter().filter(|share| **share > 0.02).count();
            let most = lost.iter().filter(|share| **share > 0.2).count();
            assert!(
                lost.len() * 5 <= links && much * 40 <= links.max(40) && most * 500 <= links,
                "level {depth}, more than {least} cells: {} of {links} fall, {much} by more than 2 %, {most} by a fifth",
                lost.len()
            );
        }
    }
}
