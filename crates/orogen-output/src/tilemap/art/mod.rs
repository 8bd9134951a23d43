//! The built-in tilesets: water, sand, grass, forest, rock and snow.

pub mod edge;
pub mod ground;
pub mod set;
