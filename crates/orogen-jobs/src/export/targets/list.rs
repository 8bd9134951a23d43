//! The list of targets.

use super::target::EngineTarget;
use super::{hterrain, terrain3d, unity, unreal};
use crate::options::Choice;

const COUNT: usize = 4;

static ALL: [&EngineTarget; COUNT] = [&unreal::TARGET, &unity::TARGET, &terrain3d::TARGET, &hterrain::TARGET];

/// All targets, as choices of an option.
pub(super) const CHOICES: [Choice; COUNT] = {
    let mut choices = [Choice::new("", ""); COUNT];
    let mut k = 0;
    while k < COUNT {
        choices[k] = Choice::new(ALL[k].name, ALL[k].about);
        k += 1;
    }
    choices
};

/// All targets.
#[must_use]
pub fn all() -> &'static [&'static EngineTarget] {
    &ALL
}

/// The target with this name.
#[must_use]
pub fn named(name: &str) -> Option<&'static EngineTarget> {
    ALL.into_iter().find(|target| target.name == name)
}
