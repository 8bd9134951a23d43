//! Real terrain prepared for the engine: read from any format, resampled to square cells in metres, with holes filled.

pub mod file_ref;
pub mod latitude;
pub(crate) mod mosaic;
pub mod open;
pub mod part;
pub mod prepared;
pub mod square;

pub use orogen_codec::fill;
