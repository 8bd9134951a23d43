//! The pictures of a request, from coarse to fine.

use orogen::{Result, World};

use super::frame::Quality;
use super::request::Request;

/// A picture that is to be made.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Stage {
    /// How much coarser its solvers are than the recipe's; 1 for the recipe itself.
    pub coarser: u32,
    /// Samples along its longer side.
    pub samples: usize,
    /// How good it is.
    pub quality: Quality,
}

/// Samples of the first picture.
pub const FIRST: usize = 256;

/// Samples of the pictures after it, up to the finest.
const NEXT: [usize; 3] = [1024, 2048, 4096];

/// The time on one core, in nanoseconds, that solvers may take before the first picture: with more, a draft comes first.
const PATIENCE: f64 = 1.2e8;

/// How much coarser drafts can be.
const COARSER: [u32; 3] = [2, 4, 8];

/// The pictures of a request over its opened world.
///
/// # Errors
/// If the world has no such layer or region.
pub fn of(world: &World, request: &Request) -> Result<Vec<Stage>> {
    let window = request.region.window(world, FIRST)?;
    // Layers that are computed from rows of heights need no more than these.
    let plan = match world.plan(&[&request.surface, &request.layer], &window) {
        Ok(plan) => plan,
        Err(_) => world.plan(&[&request.surface], &window)?,
    };
    let [solving, _] = world.work_of(&plan)?;
    let mut stages = Vec::new();
    if solving > PATIENCE {
        // A solver's work grows with its samples and its steps.
        let is_quick = |coarser: &u32| solving / f64::from(coarser.pow(3)) < PATIENCE;
        let coarser = COARSER.into_iter().find(is_quick).unwrap_or(COARSER[COARSER.len() - 1]);
        stages.push(Stage { coarser, samples: FIRST, quality: Quality::Draft });
    }
    let finest = request.finest.max(FIRST);
    stages.push(Stage { coarser: 1, samples: FIRST, quality: Quality::Coarse });
    stages.extend(
        NEXT.into_iter()
            .take_while(|samples| *samples < finest)
            .chain((finest > FIRST).then_some(finest))
            .map(|samples| Stage { coarser: 1, samples, quality: Quality::Coarse }),
    );
    if let Some(last) = stages.last_mut() {
        last.quality = Quality::Fine;
    }
    Ok(stages)
}

#[cfg(test)]
mod tests {
    use super::*;
    use orogen::{Options, Session, presets};

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
}
