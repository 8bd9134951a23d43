//! File formats, one a file. Writers stream into any [`Write`](std::io::Write) and hold a few rows at a time.

pub mod geotiff;
pub mod levels;
pub mod npy;
pub mod png;
pub mod zarr;
