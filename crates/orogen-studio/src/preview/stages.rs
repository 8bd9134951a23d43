//! The pictures of a request, from coarse to fine.

use orogen::{Result, World};

use super::frame::Quality;
use super::request::Request;

/// A picture to be made.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Stage {
    /// How much coarser the solvers are than the recipe's; 1 for the recipe itself.
    pub coarser: u32,
    /// Whether the graphics card solves chaotic processes, so that the land differs from the recipe's.
    pub on_card: bool,
    /// Number of samples along the longer side.
    pub samples: usize,
    /// The quality.
    pub quality: Quality,
}

/// Number of samples of the first picture along its longer side.
pub const FIRST: usize = 256;

/// Numbers of samples of the following pictures, up to the finest.
const NEXT: [usize; 3] = [1024, 2048, 4096];

/// The time on one core, in nanoseconds, that solvers may take before the first picture. If they take longer, a draft
/// is made first.
const PATIENCE: f64 = 1.2e8;

/// By how much drafts can be coarser.
const COARSER: [u32; 3] = [2, 4, 8];

/// The pictures of a request, from coarse to fine, for its opened world.
///
/// # Errors
/// If the world has no such layer or region.
pub fn of(world: &World, request: &Request) -> Result<Vec<Stage>> {
    let window = request.region.window(world, FIRST)?;
    // Layers that are computed from rows of heights need only the heights.
    let plan = match world.plan(&[&request.surface, &request.layer], &window) {
        Ok(plan) => plan,
        Err(_) => world.plan(&[&request.surface], &window)?,
    };
    let [solving, _] = world.work_of(&plan)?;
    let finest = request.finest.max(FIRST);
    let mut stages = Vec::new();
    if solving > PATIENCE {
        // A solver's work grows with its samples and its steps.
        let is_quick = |coarser: &u32| solving / f64::from(coarser.pow(3)) < PATIENCE;
        let coarser = COARSER.into_iter().find(is_quick).unwrap_or(COARSER[COARSER.len() - 1]);
        // A graphics card makes the draft with all details; a software driver would be slower than the solvers.
        let on_card = world.device().is_some_and(|device| !device.is_software()) && world.may_draft(&plan)?;
        let (coarser, samples) = if on_card { (1, NEXT[0].min(finest)) } else { (coarser, FIRST) };
        stages.push(Stage { coarser, on_card, samples, quality: Quality::Draft });
    }
    let exact = |samples: usize| Stage { coarser: 1, on_card: false, samples, quality: Quality::Coarse };
    stages.push(exact(FIRST));
    stages.extend(
        NEXT.into_iter().take_while(|samples| *samples < finest).chain((finest > FIRST).then_some(finest)).map(exact),
    );
    if let Some(last) = stages.last_mut() {
        last.quality = Quality::Fine;
    }
    Ok(stages)
}

#[cfg(test)]
mod tests {
    use super::*;
    use orogen::device::Device;
    use orogen::{Options, Session, presets};
    use std::sync::Arc;

    fn stages(preset: &str, finest: usize) -> Vec<Stage> {
        let session = Session::new(Options::default()).unwrap();
        let recipe = presets::find(preset).unwrap().recipe().unwrap();
        let mut request = Request::new(recipe.clone());
        request.finest = finest;
        of(&session.open(recipe).unwrap(), &request).unwrap()
    }

    #[test]
    fn fields_need_no_draft_and_solvers_do() {
        let sizes = |stages: &[Stage]| stages.iter().map(|stage| stage.samples).collect::<Vec<_>>();
        let classic = stages("classic", 2048);
        assert_eq!(sizes(&classic), [256, 1024, 2048]);
        assert_eq!(classic[2].quality, Quality::Fine);
        let alpine = stages("alpine", 1024);
        assert_eq!(sizes(&alpine), [256, 256, 1024]);
        assert!(alpine[0].quality == Quality::Draft && alpine[0].coarser > 1);
        assert_eq!(sizes(&stages("classic", 100)), [256]);
    }

    /// A graphics card that refuses everything.
    struct Card {
        is_software: bool,
    }

    impl Device for Card {
        fn is_software(&self) -> bool {
            self.is_software
        }
    }

    #[test]
    fn a_card_makes_drafts_with_all_details() {
        let draft = |preset: &str, is_software: bool| {
            let session = Session::new(Options::default()).unwrap().with_device(Arc::new(Card { is_software }));
            let recipe = presets::find(preset).unwrap().recipe().unwrap();
            let request = Request::new(recipe.clone());
            of(&session.open(recipe).unwrap(), &request).unwrap()[0]
        };
        let alpine = draft("alpine", false);
        assert!(alpine.on_card && alpine.quality == Quality::Draft && alpine.samples == 1024 && alpine.coarser == 1);
        let software = draft("alpine", true);
        assert!(!software.on_card && software.coarser > 1, "{software:?}");
        assert!(!draft("classic", false).on_card);
    }
}
