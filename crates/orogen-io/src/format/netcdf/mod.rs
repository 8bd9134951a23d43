//! NetCDF-3: grids of GMT and of the conventions COARDS and CF, in the classic format, with 64-bit offsets, and as
//! CDF-5.

mod header;
#[doc(hidden)]
pub mod reader;

#[cfg(test)]
mod tests;
