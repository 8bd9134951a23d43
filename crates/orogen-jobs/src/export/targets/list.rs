//! The list of targets.

use super::target::EngineTarget;
use super::{hterrain, terrain3d, unity, unreal};

static ALL: [&EngineTarget; 4] = [&unreal::TARGET, &unity::TARGET, &terrain3d::TARGET, &hterrain::TARGET];

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
