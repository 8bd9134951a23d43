//! Solvers: ops whose result depends on the whole bounded world.

// The list below is written by `cargo xtask codegen`.
mod bake;
mod breach;
mod coast;
mod dla;
mod drainage;
mod dunes;
mod fill;
mod height_above_drainage;
mod insolation;
mod lakes;
mod lava;
mod normalise;
mod orographic_rain;
mod rivers;
mod roads;
pub(crate) mod routing;
mod select_share;
mod stream_power;
pub(crate) mod terrain;
mod viewshed;

pub use bake::Bake;
pub use breach::{Breach, BreachRoute};
pub use coast::Coast;
pub use dla::Dla;
pub use drainage::{DepressionRouting, Drainage};
pub use dunes::Dunes;
pub use fill::Fill;
pub use height_above_drainage::HeightAboveDrainage;
pub use insolation::Insolation;
pub use lakes::Lakes;
pub use lava::Lava;
pub use normalise::Normalise;
pub use orographic_rain::OrographicRain;
pub use rivers::Rivers;
pub use roads::Roads;
pub use select_share::SelectShare;
pub use stream_power::StreamPower;
pub use viewshed::Viewshed;
