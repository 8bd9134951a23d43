//! The declared reach of levels is sufficient, and not much larger than necessary. A separate test with an op that
//! reads exactly as far as it declares shows that a reach that is one sample too small breaks the laws
//! (`registered_ops` in the crate `orogen`).

use super::{Continents, Given, Level, NONE, Progress, STEPS, Window, bits, coast, level, window};

/// The samples of a window outside the same window without `border` samples on each side.
fn outside(window: &Window, border: usize) -> impl Iterator<Item = usize> + use<> {
    let (window, inner) = (*window, window.shrunk(border));
    (0..window.len()).filter(move |sample| {
        let at = (window.x + (sample % window.width) as i64, window.y + (sample / window.width) as i64);
        !(inner.x..inner.right()).contains(&at.0) || !(inner.y..inner.bottom()).contains(&at.1)
    })
}

/// The direction from a sample outside the inner part of a window towards it.
fn inwards(window: &Window, border: usize, sample: usize) -> u8 {
    let (i, j) = (sample % window.width, sample / window.width);
    let toward = |at: usize, side: usize| isize::from(at < border) - isize::from(at + border >= side);
    let step = (toward(i, window.width), toward(j, window.height));
    STEPS.iter().position(|other| *other == step).map_or(NONE, |code| code as u8)
}

/// The level with different nodes in its outermost `border` samples.
fn poisoned(level: &Level, border: usize, kind: usize) -> Level {
    let mut poisoned = level.clone();
    for sample in outside(&level.window, border) {
        match kind {
            0 => {
                poisoned.height[sample] += 700.0;
                poisoned.area[sample] *= 9.0;
                poisoned.uplift[sample] += 1.0;
                poisoned.variation[sample] += 0.5;
            }
            1 => {
                poisoned.shore[sample] = -poisoned.shore[sample];
                poisoned.receiver[sample] = NONE;
                poisoned.east[sample] = 1.0 - poisoned.east[sample];
                poisoned.south[sample] = 1.0 - poisoned.south[sample];
            }
            // Large rivers towards the middle.
            2 => {
                poisoned.height[sample] += 4000.0;
                poisoned.area[sample] = 1e7;
                poisoned.receiver[sample] = inwards(&level.window, border, sample);
            }
            // Deep valleys that lead away.
            3 => {
                poisoned.height[sample] = -500.0;
                poisoned.area[sample] = 1e7;
                poisoned.receiver[sample] = (inwards(&level.window, border, sample) + 4) % NONE;
            }
            // High plains without valleys.
            _ => {
                poisoned.height[sample] = 9000.0;
                poisoned.area[sample] = 1.0;
                poisoned.uplift[sample] = 3.0;
            }
        }
    }
    poisoned
}

/// The number of rings of samples, from the outermost, on which no refinement of these parents depends.
fn slack(land: &Continents, depth: usize, places: &[(i64, i64)]) -> usize {
    let refine = |parent: &Level, window: &Window| {
        bits(&land.refine(parent, &Given::default(), window, &Progress::none()).unwrap())
    };
    let mut least = land.refinement.reach(depth);
    for at in places {
        let window = window(land, depth, *at, (20, 20));
        let parent = level(land, depth - 1, &land.refinement.parent_window(depth, &window));
        let exact = refine(&parent, &window);
        for kind in 0..5 {
            while least > 0 && refine(&poisoned(&parent, least, kind), &window) != exact {
                least -= 1;
            }
        }
    }
    least
}

/// The reach follows from the longest chain of passes, each of which reads one sample further, so it is an upper bound:
/// no tested parent changes a node at the whole reach. If it were much larger than the distance over which nodes
/// change, windows would cost more than necessary.
#[test]
fn nodes_depend_on_more_than_a_third_of_their_reach() {
    let land = Continents::new(1);
    for depth in [6, 10, 11] {
        let (x, y) = coast(depth);
        let places: Vec<(i64, i64)> = (0..3).map(|k| (x + 91 * k, y - 57 * k)).collect();
        let (reach, slack) = (land.refinement.reach(depth), slack(&land, depth, &places));
        println!("level {depth}: of {reach} samples the outer {slack} change nothing");
        assert!(
            3 * slack < 2 * reach && slack > 0,
            "level {depth}: of {reach} samples the outer {slack} change nothing"
        );
    }
}
