//! Solvers: ops that read the whole bounded world.

// The list below is written by `cargo xtask codegen`.
pub mod bake;
pub mod breach;
pub mod dla;
pub mod drainage;
pub mod fill;
pub mod height_above_drainage;
pub mod insolation;
pub mod lakes;
pub mod normalise;
pub mod orographic_rain;
pub mod rivers;
pub mod routing;
pub mod select_share;
pub mod stream_power;
pub mod terrain;
pub mod viewshed;
