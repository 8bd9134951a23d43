//! Real terrain as the engine takes it: read from any format, in square metres, without holes.

pub mod file_ref;
pub mod fill;
pub mod latitude;
pub(crate) mod mosaic;
pub mod open;
pub mod prepared;
pub mod square;
