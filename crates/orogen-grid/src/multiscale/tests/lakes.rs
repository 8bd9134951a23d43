//! Lakes with an outlet.

use super::{bits, coast, level, window};
use crate::hydrology::direction::{NONE, STEPS};
use crate::multiscale::continents::Continents;
use crate::multiscale::level::{LAKE, Level, direction};

fn land() -> Continents {
    let land = Continents::new(1);
    land.with_refinement(land.refinement.with_lakes(1.0).with_details(1))
}

/// A position with lakes, in samples of a level.
fn district(depth: usize) -> (i64, i64) {
    let at = |middle: i64| (middle << 4) >> (12 - depth);
    (at(68) - 80, at(307) - 60)
}

/// The receiver of a node that is not at the edge.
fn receiver(level: &Level, q: usize) -> Option<usize> {
    let (width, height) = (level.window.width, level.window.height);
    let is_inner = (1..width - 1).contains(&(q % width)) && (1..height - 1).contains(&(q / width));
    let (east, south) = STEPS.get(usize::from(direction(level.receiver[q])).min(usize::from(NONE)))?;
    is_inner.then(|| q.wrapping_add_signed(south * width as isize + east))
}

#[test]
fn every_lake_drains_to_its_outlet_and_holds_the_water_of_its_rivers() {
    let land = land();
    for depth in [7, 8, 10, 11, 12] {
        let side = if depth < 10 { 200 } else { 300 };
        let level = level(&land, depth, &window(&land, depth, district(depth), (side, side)));
        let (mut lakes, mut outlets, mut inlets, mut short) = (0, 0, 0, 0);
        for q in 0..level.window.len() {
            let is_lake = level.receiver[q] >= LAKE;
            lakes += usize::from(is_lake);
            let Some(to) = receiver(&level, q) else { continue };
            let (here, there) = (level.height[q], level.height[to]);
            let is_level = is_lake && level.receiver[to] >= LAKE && here == there;
            assert!(here > there || is_level, "level {depth}: {here} m to {there} m");
            inlets += usize::from(!is_lake && level.receiver[to] >= LAKE && level.area[q] > 50.0);
            if is_lake && level.receiver[to] < NONE {
                outlets += 1;
                short += usize::from(level.area[to] < 0.98 * level.area[q]);
            }
            // The path along receivers leaves the lake.
            let (mut at, mut links) = (q, 0);
            while let Some(next) = receiver(&level, at).filter(|_| level.receiver[at] >= LAKE) {
                (at, links) = (next, links + 1);
                assert!(links <= level.window.len(), "level {depth}: a circle");
            }
        }
        assert!(
            lakes > 30 && (outlets > 0 || depth > 11) && inlets > 2,
            "level {depth}: {lakes} nodes, {outlets} outlets"
        );
        // As elsewhere, a few areas decrease downstream.
        assert!(short * 10 <= outlets, "level {depth}: {short} of {outlets} outlets drain less than their lake");
        assert!(outlets * 8 < lakes, "level {depth}: {outlets} outlets of {lakes} nodes");
    }
}

#[test]
fn water_leaves_lakes_only_along_rivers() {
    let land = land();
    for depth in [8, 10, 11, 12] {
        let level = level(&land, depth, &window(&land, depth, district(depth), (200, 200)));
        let (mut shores, mut lower) = (0, 0);
        for q in (0..level.window.len()).filter(|q| level.receiver[*q] >= LAKE) {
            let around = STEPS.into_iter().filter_map(|step| level.neighbor(q, step));
            for near in around.filter(|near| level.receiver[*near] < NONE) {
                shores += 1;
                let is_river = level.area[near] >= 64.0;
                assert!(is_river || level.height[near] > level.height[q], "level {depth}: the shore is lower");
                lower += usize::from(level.height[near] < level.height[q] - 1.0);
            }
        }
        assert!(shores > 40, "level {depth}: {shores}");
        // The remaining ones are outlets and other rivers that come near.
        assert!(lower * 50 < shores, "level {depth}: {lower} of {shores} links across the shore fall by more than 1 m");
    }
}

#[test]
fn windows_with_lakes_are_crops_of_a_larger_one() {
    let land = land();
    for depth in [6, 7, 8, 9, 11, 12] {
        let at = district(depth);
        let whole = level(&land, depth, &window(&land, depth, at, (160, 120)));
        assert!(whole.receiver.iter().any(|code| *code >= LAKE), "level {depth}: no lake");
        for (at, size) in [((at.0 + 31, at.1 + 17), (90, 60)), ((at.0 + 80, at.1 + 60), (1, 1))] {
            let part = window(&land, depth, at, size);
            assert!(bits(&whole.crop(&part).unwrap()) == bits(&level(&land, depth, &part)), "level {depth}, {part:?}");
        }
    }
}

#[test]
fn without_lakes_no_bit_changes() {
    let (with, without) = (land(), Continents::new(1));
    let of = |land: &Continents| bits(&level(land, 5, &window(land, 5, coast(5), (60, 60))));
    assert!(of(&with) == of(&without), "lakes begin at level 5");
}

#[test]
fn links_that_cross_at_a_corner_do_not_share_a_node() {
    // On the finest level of valleys hillsides may drain across rivers.
    let land = land();
    for (x, y) in [(46023, 89223), (41304, 11817)] {
        let level = level(&land, 12, &window(&land, 12, (x - 20, y - 20), (40, 40)));
        for q in 0..level.window.len() {
            let Some(to) = receiver(&level, q) else { continue };
            let is_level = level.receiver[to] >= LAKE && level.height[q] == level.height[to];
            assert!(is_level || level.height[q] > level.height[to], "a link rises at {:?}", level.place(q));
        }
    }
}
