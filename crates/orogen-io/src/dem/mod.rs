//! Real terrain prepared for the engine: read from any format, resampled to square cells in metres, with holes filled.

#[doc(hidden)]
pub mod dem_file;
#[doc(hidden)]
pub mod file_ref;
#[doc(hidden)]
pub mod latitude;
pub(crate) mod mosaic;
#[doc(hidden)]
pub mod open;
#[doc(hidden)]
pub mod part;
#[doc(hidden)]
pub mod prepared;
#[doc(hidden)]
pub mod square;

pub use file_ref::{FileKind, FileRef};
pub use open::read;
pub use prepared::PreparedDem;

pub use orogen_codec::fill;
