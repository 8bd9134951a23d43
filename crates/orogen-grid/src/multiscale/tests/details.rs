//! Properties of detail levels.

use super::{bits, coast, level, window};
use crate::grid::Window;
use crate::hydrology::direction::{NONE, STEPS};
use crate::hydrology::rivers::Channel;
use crate::multiscale::continents::Continents;
use crate::multiscale::given::Given;
use crate::multiscale::level::Level;
use crate::multiscale::refinement::Refinement;
use crate::multiscale::surface::Surface;
use crate::progress::Progress;

fn detailed(seed: u64) -> Continents {
    let land = Continents::new(seed);
    land.with_refinement(land.refinement.with_details(6))
}

/// The surface of a detail level over a window of samples, with the beds of rivers.
fn surface(land: &Continents, depth: usize, window: &Window) -> Surface {
    let refinement = &land.refinement;
    let halo = Refinement::SURFACE_REACH.max(refinement.rivers_reach(depth));
    let nodes = level(land, depth, &refinement.nodes_at(depth, window).grown(halo));
    let mut surface = refinement.surface(&nodes, window, &Progress::none()).unwrap();
    refinement.cut_rivers(&nodes, &mut surface, 1e6, &Channel::default(), &Progress::none()).unwrap();
    surface
}

#[test]
fn windows_made_separately_are_crops_of_a_larger_one() {
    let land = detailed(1);
    for (depth, far) in [(12, 0), (14, -320_000_000_001), (17, 1_000_000_000_003)] {
        let at = if far == 0 { coast(depth) } else { (far, -far) };
        let whole = level(&land, depth, &window(&land, depth, at, (37, 31)));
        for (at, size) in [((at.0, at.1), (1, 1)), ((at.0 + 3, at.1 + 7), (20, 11))] {
            let part = window(&land, depth, at, size);
            assert!(bits(&whole.crop(&part).unwrap()) == bits(&level(&land, depth, &part)), "level {depth}, {part:?}");
        }
    }
    // The finest level of valleys does not depend on details.
    let depth = 11;
    let at = window(&land, depth, coast(depth), (20, 20));
    assert!(bits(&level(&land, depth, &at)) == bits(&level(&Continents::new(1), depth, &at)));
}

#[test]
fn the_reach_covers_all_that_is_read() {
    let land = detailed(3);
    for depth in [12, 15] {
        let window = window(&land, depth, coast(depth), (9, 8));
        let needed = land.refinement.parent_window(depth, &window);
        let parent = level(&land, depth - 1, &needed.grown(1));
        let refined = |parent: &Level| land.refine(parent, &Given::default(), &window, &Progress::none());
        let exact = refined(&parent.crop(&needed).unwrap()).unwrap();
        let mut changed = parent.clone();
        let width = changed.window.width;
        for (q, (height, receiver)) in changed.height.iter_mut().zip(&mut changed.receiver).enumerate() {
            let (i, j) = (q % width, q / width);
            if i == 0 || j == 0 || i == width - 1 || j == parent.window.height - 1 {
                (*height, *receiver) = (*height + 100.0, NONE);
            }
        }
        assert!(bits(&refined(&changed).unwrap()) == bits(&exact), "level {depth}");
        assert!(refined(&parent.crop(&needed.shrunk(1)).unwrap()).is_err());
    }
}

#[test]
fn water_flows_down() {
    for (seed, depth) in [(1, 12), (1, 14), (2, 17)] {
        let land = detailed(seed);
        let level = level(&land, depth, &window(&land, depth, coast(depth), (150, 140)));
        let (width, height) = (level.window.width, level.window.height);
        for (q, &receiver) in level.receiver.iter().enumerate() {
            assert!(level.height[q].is_finite() && level.area[q] >= 1.0);
            let Some((east, south)) = STEPS.get(usize::from(receiver)) else { continue };
            let (i, j) = ((q % width).wrapping_add_signed(*east), (q / width).wrapping_add_signed(*south));
            if i < width && j < height {
                let below = level.height[j * width + i];
                // Large rivers in plains fall by less than the precision of heights.
                let falls = below < level.height[q] || (below == level.height[q] && level.area[q] > 1000.0);
                assert!(falls, "seed {seed}, level {depth}: {below} below {}", level.height[q]);
            }
        }
    }
}

#[test]
fn heights_stay_near_those_of_the_level_above() {
    let land = detailed(2);
    let mut above: Option<Surface> = None;
    for depth in 11..=14 {
        // The same samples on all levels, 60 m apart.
        let every = 1 << (depth - 11);
        let samples = window(&land, depth, (0, 0), (40 * every, 40 * every));
        let made = surface(&land, depth, &samples);
        let (mut sum, mut squares, mut range) = (0.0, 0.0, (f64::MAX, f64::MIN));
        if let Some(above) = &above {
            let half = above.height.window().width / 40;
            for (i, j) in (0..40).flat_map(|j| (0..40).map(move |i| (i, j))) {
                let (fine, coarse) = (made.height[(i * every, j * every)], above.height[(i * half, j * half)]);
                let difference = f64::from(fine) - f64::from(coarse);
                (sum, squares) = (sum + difference, squares + difference * difference);
                range = (range.0.min(f64::from(coarse)), range.1.max(f64::from(coarse)));
            }
            let (mean, rms) = (sum / 1600.0, (squares / 1600.0).sqrt());
            let relief = range.1 - range.0;
            assert!(
                relief > 300.0 && rms < 0.02 * relief && mean.abs() < 0.01 * relief,
                "{depth}: {mean} {rms} {relief}"
            );
        }
        above = Some(made);
    }
}

#[test]
fn rivers_have_beds_that_fall_and_agree_between_windows() {
    let land = detailed(1);
    let (depth, refinement) = (16, &land.refinement);
    // The largest river within 3 km of a position on land.
    let wide = level(&land, 11, &window(&land, 11, coast(11), (50, 50)));
    let river = (0..wide.area.len())
        .filter(|q| wide.receiver[*q] < NONE)
        .max_by(|a, b| wide.area[*a].total_cmp(&wide.area[*b]))
        .unwrap();
    let (x, y) = ((wide.window.x + (river % 50) as i64) << 5, (wide.window.y + (river / 50) as i64) << 5);
    let samples = window(&land, depth, (x - 60, y - 60), (120, 120));
    let cut = surface(&land, depth, &samples);
    let part = samples.at(samples.x + 31, samples.y + 40);
    let part = Window { width: 50, height: 33, ..part };
    assert_eq!(cut.height.crop(&part).unwrap(), surface(&land, depth, &part).height);
    let nodes = level(&land, depth, &refinement.nodes_at(depth, &samples).grown(Refinement::SURFACE_REACH));
    let ground = refinement.surface(&nodes, &samples, &Progress::none()).unwrap();
    let lowered = cut.height.data().iter().zip(ground.height.data()).filter(|(cut, ground)| cut < ground).count();
    assert!(lowered > 200 && lowered < 7200, "{lowered} samples of beds");
    assert!(cut.height.data().iter().zip(ground.height.data()).all(|(cut, ground)| cut <= ground));
    // Coarser levels have no beds.
    assert_eq!(refinement.rivers_reach(11), 0);
    let less = level(&land, depth, &refinement.nodes_at(depth, &samples).grown(5));
    let mut uncut = ground.clone();
    assert!(refinement.cut_rivers(&less, &mut uncut, 1e6, &Channel::default(), &Progress::none()).is_err());
}

#[test]
fn too_many_details_are_refused() {
    let land = Continents::new(1);
    let land = land.with_refinement(land.refinement.with_details(11));
    assert!(land.coarsest(&Given::default(), &window(&land, 0, (0, 0), (2, 2)), &Progress::none()).is_err());
}
