//! Real terrain as the engine takes it: read from any format, in square metres, without holes.

pub mod fill;
pub mod ground;
pub mod held;
pub mod latitude;
pub mod mosaic;
pub mod open;
pub mod square;
