//! Rain as a weight of drainage areas.

use super::{bits, coast, level, window};
use crate::grid::Grid;
use crate::hydrology::direction::{NONE, STEPS};
use crate::multiscale::continents::Continents;
use crate::multiscale::given::Given;
use crate::multiscale::level::Level;
use crate::progress::Progress;

/// The finest level with this rain.
fn with_rain(land: &Continents, rain: Option<f32>) -> Level {
    let depth = land.refinement.levels;
    let window = window(land, depth, coast(depth), (120, 90));
    let parent = level(land, depth - 1, &land.refinement.parent_window(depth, &window));
    let rain = rain.map(|rain| Grid::filled(window.grown(land.refinement.given_reach(depth)), rain));
    let given = Given { rain: rain.as_ref(), ..Given::default() };
    land.refine(&parent, &given, &window, &Progress::none()).unwrap()
}

#[test]
fn areas_are_weighted_by_rain() {
    let land = Continents::new(1);
    let dry = with_rain(&land, None);
    assert!(bits(&dry) == bits(&with_rain(&land, Some(1.0))));
    assert!(bits(&dry) == bits(&with_rain(&land, Some(f32::NAN))), "no rain is known");
    let wet = with_rain(&land, Some(3.0));
    let width = wet.window.width;
    let mut sources = 0;
    for q in (1..wet.window.height - 1).flat_map(|j| j * width + 1..(j + 1) * width - 1) {
        let is_donor = |code: usize, (east, south): (isize, isize)| {
            usize::from(wet.receiver[q.wrapping_add_signed(south * width as isize + east)]) == (code + 4) & 7
        };
        let drains = STEPS.into_iter().enumerate().any(|(code, step)| is_donor(code, step));
        if wet.receiver[q] < NONE && !drains {
            sources += 1;
            assert_eq!(wet.area[q], 3.0);
        }
    }
    assert!(sources > 1000, "{sources} sources");
    // Streams with more water are less steep, so the land between rivers is lower.
    let mean = |level: &Level| level.height.iter().map(|height| f64::from(*height)).sum::<f64>();
    assert!(mean(&wet) < 0.98 * mean(&dry), "{} {}", mean(&wet), mean(&dry));
}
