//! Outputs of recipes with a special meaning.

/// The output from which maps and meshes are made.
pub const HEIGHT: &str = "height";

/// The output with the depth of lakes, in metres, where a recipe has one.
pub const LAKES: &str = "lakes";

/// The output with the number of each sample's class, from 0.
pub const CLASS: &str = "class";
