//! The targets there are.

use super::target::Target;
use super::{hterrain, terrain3d, unity, unreal};

static ALL: [&Target; 4] = [&unreal::TARGET, &unity::TARGET, &terrain3d::TARGET, &hterrain::TARGET];

/// All targets.
pub fn all() -> &'static [&'static Target] {
    &ALL
}

/// The target of that name.
pub fn named(name: &str) -> Option<&'static Target> {
    ALL.into_iter().find(|target| target.name == name)
}
